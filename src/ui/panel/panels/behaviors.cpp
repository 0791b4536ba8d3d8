// Behaviors: activates them by name on all bodies or the selected one, shows their time and errors, reorders, adds and
// removes them.
#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "ui/panel/evaluator.h"
#include "ui/panel/gui.h"
#include "ui/panel/lua_path.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/behavior_entries.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

class BehaviorsPanel : public Panel {
 public:
  void update(GuiContext& context) override {
    for (const Evaluator::Response& response : evaluator_.consume_responses()) {
      if (response.result.kind == Evaluation::Kind::error)
        context.show_notice(response.result.text.substr(0, response.result.text.find('\n')));
    }
    queued_moves_ += std::exchange(context.requests.move_behavior, 0);
    if (context.value_snapshot == nullptr || (context.settings.hidden && queued_moves_ == 0)) return;
    update_entries(context);
    // one move at a time, because each depends on the result of the previous one
    if (queued_moves_ == 0 || context.value_snapshot->request < last_move_request_) return;
    move(context, queued_moves_ > 0 ? 1 : -1);
    queued_moves_ -= queued_moves_ > 0 ? 1 : -1;
  }

  void draw(GuiContext& context) override {
    const float side = ImGui::GetFrameHeight();
    const std::string title = body_ == 0 ? "All bodies" : std::string(context.value_snapshot->tree->name(body_));
    const float buttons = 3 * side + 3 * ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::TextDisabled("%s", elided(title, ImGui::GetContentRegionAvail().x - buttons, text_width).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The list shows the behaviors of: %s", title.c_str());
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::SameLine(ImGui::GetWindowWidth() - 3 * side - 2 * gap - ImGui::GetStyle().WindowPadding.x);
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y * 0.5F);
    if (icon_button(context.names, "behaviors.earlier", Icon::up, "Run the selected behavior earlier (Ctrl+Up)", false,
                    side))
      queued_moves_--;
    ImGui::SameLine(0, gap);
    if (icon_button(context.names, "behaviors.later", Icon::down, "Run the selected behavior later (Ctrl+Down)", false,
                    side))
      queued_moves_++;
    ImGui::SameLine(0, gap);
    if (icon_button(context.names, "behaviors.add", Icon::plus, "Add a behavior", false, side)) ImGui::OpenPopup("add");
    draw_add_popup(context);
    if (!ImGui::BeginChild("##list", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(entries_.size()), ImGui::GetFrameHeightWithSpacing());
    while (clipper.Step()) {
      const auto shown =
          std::span(entries_).subspan(static_cast<std::size_t>(clipper.DisplayStart),
                                      static_cast<std::size_t>(clipper.DisplayEnd - clipper.DisplayStart));
      const std::vector<std::string> names = names_of(shown);
      for (std::size_t i = 0; i < shown.size(); i++) draw_line(context, shown[i], names[i]);
    }
    if (entries_.empty()) ImGui::TextDisabled("No behaviors");
    ImGui::EndChild();
  }

 private:
  // Rebuilds the list if the tree or the selected body has changed, and updates the entries from each value snapshot.
  void update_entries(const GuiContext& context) {
    const std::shared_ptr<const TreeSnapshot>& tree = context.value_snapshot->tree;
    const std::uint32_t body = selected_body(context);
    if (tree != tree_ || body != body_) {
      entries_ = behavior_entries(*tree, body);
      tree_ = tree;
      body_ = body;
      snapshot_ = nullptr;
    }
    if (snapshot_ == context.value_snapshot) return;
    snapshot_ = context.value_snapshot;
    for (BehaviorEntry& entry : entries_) update_entry(*snapshot_, entry);
    sort_entries(entries_);
  }

  // Moves the selected entry past the previous or the next line.
  void move(GuiContext& context, int direction) {
    const auto entry =
        std::ranges::find_if(entries_, [&](const BehaviorEntry& e) { return e.pattern == context.selected; });
    if (entry == entries_.end()) return context.show_notice("Select a behavior first");
    const auto to = (entry - entries_.begin()) + direction;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(entries_.size())) return;
    for (Message& message : move_past(*snapshot_, *entry, entries_[static_cast<std::size_t>(to)]))
      last_move_request_ = context.send(std::move(message));
  }

  static std::uint32_t selected_body(const GuiContext& context) {
    constexpr std::string_view kBodies = "/physics/body/";
    const std::string& path = context.selected;
    if (!path.starts_with(kBodies) || path.find('*') != std::string::npos) return 0;
    const Result<TreePropertyRef> ref =
        context.value_snapshot->tree->find(path.substr(0, path.find('/', kBodies.size())));
    return ref && ref->property == nullptr ? ref->node : 0;
  }

  static std::string suffix_of(const BehaviorEntry& entry) {
    return entry.group ? "group" : entry.nodes.size() > 1 ? fmt::format("\u00d7{}", entry.nodes.size()) : "";
  }
  static std::string time_of(const BehaviorEntry& entry) {
    return entry.time >= 0.5 ? number_label(entry.time, {.decimals = 0}) + " µs" : "";
  }
  static float close_width() { return ImGui::GetFrameHeight() * 0.9F; }
  // Width of an entry's name and suffix, beside the checkbox.
  static float name_width(const BehaviorEntry& entry) {
    return ImGui::GetContentRegionAvail().x - close_width() - text_width(time_of(entry)) -
           ImGui::GetStyle().ItemInnerSpacing.x;
  }

  // Returns the names, shortened to the narrowest room of all entries, different for different names.
  static std::vector<std::string> names_of(std::span<const BehaviorEntry> entries) {
    std::vector<std::string> names;
    const float used = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + 3;  // by the checkbox
    float width = ImGui::GetContentRegionAvail().x;
    for (const BehaviorEntry& entry : entries) {
      names.push_back(entry.name);
      const float sign = entry.error.empty() ? 0 : ImGui::GetFontSize() * 1.05F;
      const std::string suffix = suffix_of(entry);
      const float gap = suffix.empty() ? 0 : ImGui::GetFontSize() * 0.5F;
      width = std::min(width, name_width(entry) - used - sign - gap - text_width(suffix));
    }
    return elided_apart(names, width, text_width);
  }

  void draw_line(GuiContext& context, const BehaviorEntry& entry, const std::string& name) {
    ImGui::PushID(entry.pattern.c_str());
    const std::string address = entry.pattern + "/active";
    const auto count = static_cast<int>(entry.nodes.size());
    const std::optional<double> pending = context.pending_value(address);
    const int active = pending ? (*pending != 0 ? count : 0) : entry.active;
    bool on = active == count;
    const bool mixed = active > 0 && active < count;
    if (mixed) ImGui::PushStyleColor(ImGuiCol_CheckMark, packed_color(ThemeColor::accent, 0));
    if (ImGui::Checkbox("##active", &on)) context.set_all(address, on ? 1 : 0);
    if (mixed) ImGui::PopStyleColor();
    context.names.add(address);
    const ImVec2 low = ImGui::GetItemRectMin();
    const float side = ImGui::GetFrameHeight();
    if (mixed)  // active on some bodies: a bar instead of the check mark
      ImGui::GetWindowDrawList()->AddRectFilled({low.x + side * 0.25F, low.y + side * 0.44F},
                                                {low.x + side * 0.75F, low.y + side * 0.58F},
                                                packed_color(ThemeColor::accent));
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    draw_name(context, entry, name, active, count);
    ImGui::PopID();
  }

  void draw_name(GuiContext& context, const BehaviorEntry& entry, const std::string& name, int active, int count) {
    const std::string time = time_of(entry);
    const float close = close_width();
    const float width = name_width(entry);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const bool selected = context.selected == entry.pattern;
    if (ImGui::Selectable("##name", selected, 0, {std::max(width, 8.0F), ImGui::GetFrameHeight()}))
      context.selected = entry.pattern;
    context.names.add("behavior:" + entry.pattern);
    draw_tooltip(entry, active, count);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = from.y + ImGui::GetStyle().FramePadding.y;
    const ThemeColor color = !entry.error.empty() ? ThemeColor::red
                             : active > 0         ? ThemeColor::text
                                                  : ThemeColor::secondary;
    float x = from.x + 3;
    if (!entry.error.empty()) {
      draw_icon(Icon::warning, x + ImGui::GetFontSize() * 0.4F, y + ImGui::GetFontSize() * 0.5F,
                ImGui::GetFontSize() * 0.4F, packed_color(ThemeColor::red));
      x += ImGui::GetFontSize() * 1.05F;
    }
    list.AddText({x, y}, packed_color(color), name.c_str());
    list.AddText({x + text_width(name) + ImGui::GetFontSize() * 0.5F, y}, packed_color(ThemeColor::secondary),
                 suffix_of(entry).c_str());
    list.AddText({from.x + width + ImGui::GetStyle().ItemInnerSpacing.x, y}, packed_color(ThemeColor::secondary),
                 time.c_str());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - close);
    if (ImGui::InvisibleButton("##remove", {close, ImGui::GetFrameHeight()})) remove(context, entry);
    context.names.add("remove:" + entry.pattern);
    const ImVec2 at = ImGui::GetItemRectMin();
    const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    draw_icon(Icon::close, at.x + close / 2, at.y + ImGui::GetFrameHeight() / 2, ImGui::GetFontSize() * 0.3F,
              packed_color(hovered ? ThemeColor::red : ThemeColor::secondary));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove; a reset or reload restores the scene's own behaviors");
  }

  static void draw_tooltip(const BehaviorEntry& entry, int active, int count) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::Text("%s (%s): %d of %d active", entry.name.c_str(), entry.type.c_str(), active, count);
    if (entry.time >= 0.5) ImGui::TextDisabled("The time is that of the last tick, summed over all bodies");
    if (!entry.error.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, packed_color(ThemeColor::red));
      ImGui::TextUnformatted(entry.error.c_str());
      ImGui::PopStyleColor();
      ImGui::TextDisabled("Activate it again to retry");
    }
    ImGui::TextDisabled("%s", entry.pattern.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }

  static void remove(GuiContext& context, const BehaviorEntry& entry) {
    if (context.selected == entry.pattern) context.selected.clear();
    context.send(entry.pattern + "/remove");
  }

  // Adding a behavior is done in Lua, because no OSC address does it.
  void draw_add_popup(GuiContext& context) {
    if (!ImGui::BeginPopup("add")) return;
    const std::vector<std::string>& types = context.options->behavior_types;
    const float width = ImGui::GetFontSize() * 14;
    ImGui::TextDisabled("Add a behavior to %s",
                        body_ == 0 ? "all bodies" : std::string(context.value_snapshot->tree->name(body_)).c_str());
    ImGui::SetNextItemWidth(width);
    if (ImGui::BeginCombo("Type", type_.c_str(), ImGuiComboFlags_HeightLarge)) {
      for (const std::string& type : types) {
        if (ImGui::Selectable(type.c_str(), type == type_)) {
          if (name_.empty() || name_ == type_) name_ = type;
          type_ = type;
        }
        context.names.add("behaviors.type=" + type);
      }
      ImGui::EndCombo();
    } else {
      context.names.add("behaviors.type");
    }
    ImGui::SetNextItemWidth(width);
    ImGui::InputText("Name", &name_);
    context.names.add("behaviors.name");
    ImGui::BeginDisabled(type_.empty() || name_.empty());
    if (ImGui::Button("Add")) {
      evaluator_.request(context.link, add_behavior_script(context));
      ImGui::CloseCurrentPopup();
    }
    context.names.add("behaviors.add_it");
    ImGui::EndDisabled();
    ImGui::EndPopup();
  }

  std::string add_behavior_script(const GuiContext& context) const {
    const std::string add = fmt::format(":add_behavior({}, {})", lua_text(type_), lua_text(name_));
    if (body_ != 0) return lua_path(*context.value_snapshot->tree, {body_, nullptr}) + add;
    return fmt::format("for _, body in ipairs(sim.bodies) do body{} end", add);
  }

  Evaluator evaluator_;
  int queued_moves_ = 0;                 // queued moves: negative earlier, positive later
  std::uint64_t last_move_request_ = 0;  // snapshot request that follows the last move
  std::shared_ptr<const TreeSnapshot> tree_;
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;
  std::uint32_t body_ = 0;
  std::vector<BehaviorEntry> entries_;
  std::string type_;
  std::string name_;
};

[[maybe_unused]] const bool kBehaviorsPanel = register_panel_type<BehaviorsPanel>({.name = "behaviors",
                                                                                   .title = "Behaviors",
                                                                                   .wide_slot = PanelSlot::left_bottom,
                                                                                   .compact_slot = PanelSlot::right,
                                                                                   .order = 2});

}  // namespace
}  // namespace limber::panel
