// Behaviours: switched on and off by name, for all bodies or the chosen one; the time they take, why one rests; add and
// remove.
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "gui/behavior_entries.h"
#include "gui/evaluator.h"
#include "gui/gui.h"
#include "gui/icons.h"
#include "gui/lua_path.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

class BehaviorsPanel : public Panel {
 public:
  void hear(Desk& desk) override {
    for (const Evaluator::Answer& answer : evaluator_.answers()) {
      if (answer.said.kind == Evaluation::Kind::error)
        desk.say(answer.said.text.substr(0, answer.said.text.find('\n')));
    }
    moves_ += std::exchange(desk.move_behavior, 0);
    if (desk.image == nullptr || (desk.settings.hidden && moves_ == 0)) return;
    renew(desk);
    // one after the other: each starts from what the one before has made of the list
    if (moves_ == 0 || desk.image->asks < moved_) return;
    move(desk, moves_ > 0 ? 1 : -1);
    moves_ -= moves_ > 0 ? 1 : -1;
  }

  void draw(Desk& desk) override {
    const float side = ImGui::GetFrameHeight();
    ImGui::TextDisabled("%s", body_ == 0 ? "of all bodies" : std::string(desk.image->tree->name(body_)).c_str());
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::SameLine(ImGui::GetWindowWidth() - 3 * side - 2 * gap - ImGui::GetStyle().WindowPadding.x);
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y * 0.5F);
    if (icon_button(desk.names, "behaviors.earlier", Icon::up, "the chosen one acts earlier (Ctrl+Up)", false, side))
      moves_--;
    ImGui::SameLine(0, gap);
    if (icon_button(desk.names, "behaviors.later", Icon::down, "the chosen one acts later (Ctrl+Down)", false, side))
      moves_++;
    ImGui::SameLine(0, gap);
    if (icon_button(desk.names, "behaviors.add", Icon::plus, "add a behaviour", false, side)) ImGui::OpenPopup("add");
    add_popup(desk);
    if (!ImGui::BeginChild("##list", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(entries_.size()), ImGui::GetFrameHeightWithSpacing());
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) line(desk, entries_[static_cast<std::size_t>(i)]);
    }
    if (entries_.empty()) ImGui::TextDisabled("there are none");
    ImGui::EndChild();
  }

 private:
  // who is there only when the tree or the chosen body has become another; what they do with each image
  void renew(const Desk& desk) {
    const std::shared_ptr<const Tree>& tree = desk.image->tree;
    const std::uint32_t body = chosen_body(desk);
    if (tree != tree_ || body != body_) {
      entries_ = behavior_entries(*tree, body);
      tree_ = tree;
      body_ = body;
      image_ = nullptr;
    }
    if (image_ == desk.image) return;
    image_ = desk.image;
    for (BehaviorEntry& entry : entries_) renew_entry(*image_, entry);
    order_entries(entries_);
  }

  // the chosen one past the line before it or behind it
  void move(Desk& desk, int by) {
    const auto chosen =
        std::ranges::find_if(entries_, [&](const BehaviorEntry& e) { return e.pattern == desk.selected; });
    if (chosen == entries_.end()) return desk.say("choose a behaviour first");
    const auto to = (chosen - entries_.begin()) + by;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(entries_.size())) return;
    for (Message& message : put_past(*image_, *chosen, entries_[static_cast<std::size_t>(to)]))
      moved_ = desk.send(std::move(message));
  }

  static std::uint32_t chosen_body(const Desk& desk) {
    constexpr std::string_view kBodies = "/physics/body/";
    const std::string& path = desk.selected;
    if (!path.starts_with(kBodies) || path.find('*') != std::string::npos) return 0;
    const Result<TreePlace> place = desk.image->tree->find(path.substr(0, path.find('/', kBodies.size())));
    return place && place->row == nullptr ? place->node : 0;
  }

  void line(Desk& desk, const BehaviorEntry& entry) {
    ImGui::PushID(entry.pattern.c_str());
    const std::string address = entry.pattern + "/active";
    const auto all = static_cast<int>(entry.nodes.size());
    const std::optional<double> hand = desk.shown(address);
    const int active = hand ? (*hand != 0 ? all : 0) : entry.active;
    bool on = active == all;
    const bool mixed = active > 0 && active < all;
    if (mixed) ImGui::PushStyleColor(ImGuiCol_CheckMark, packed(Tone::accent, 0));
    if (ImGui::Checkbox("##active", &on)) desk.set_all(address, on ? 1 : 0);
    if (mixed) ImGui::PopStyleColor();
    desk.names.note(address);
    const ImVec2 low = ImGui::GetItemRectMin();
    const float side = ImGui::GetFrameHeight();
    if (mixed)  // some of them: a bar instead of the tick
      ImGui::GetWindowDrawList()->AddRectFilled({low.x + side * 0.25F, low.y + side * 0.44F},
                                                {low.x + side * 0.75F, low.y + side * 0.58F}, packed(Tone::accent));
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    name(desk, entry, active, all);
    ImGui::PopID();
  }

  void name(Desk& desk, const BehaviorEntry& entry, int active, int all) {
    const std::string time = entry.time >= 0.5 ? fmt::format("{:.0f} µs", entry.time) : "";
    const float right = ImGui::CalcTextSize(time.c_str()).x;
    const float close = ImGui::GetFrameHeight() * 0.9F;
    const float width = ImGui::GetContentRegionAvail().x - close - right - ImGui::GetStyle().ItemInnerSpacing.x;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const bool chosen = desk.selected == entry.pattern;
    if (ImGui::Selectable("##name", chosen, 0, {std::max(width, 8.0F), ImGui::GetFrameHeight()}))
      desk.selected = entry.pattern;
    desk.names.note("behavior:" + entry.pattern);
    hint(entry, active, all);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = from.y + ImGui::GetStyle().FramePadding.y;
    const Tone tone = !entry.error.empty() ? Tone::red : active > 0 ? Tone::text : Tone::dim;
    float x = from.x + 3;
    if (!entry.error.empty()) {
      draw_icon(Icon::warning, x + ImGui::GetFontSize() * 0.4F, y + ImGui::GetFontSize() * 0.5F,
                ImGui::GetFontSize() * 0.4F, packed(Tone::red));
      x += ImGui::GetFontSize() * 1.05F;
    }
    list.PushClipRect(from, {from.x + width, from.y + ImGui::GetFrameHeight()}, true);
    list.AddText({x, y}, packed(tone), entry.name.c_str());
    const std::string of = entry.group ? "group" : all > 1 ? fmt::format("\u00d7{}", all) : "";
    const float end = x + ImGui::CalcTextSize(entry.name.c_str()).x;
    list.AddText({end + ImGui::GetFontSize() * 0.5F, y}, packed(Tone::dim), of.c_str());
    list.PopClipRect();
    list.AddText({from.x + width + ImGui::GetStyle().ItemInnerSpacing.x, y}, packed(Tone::dim), time.c_str());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - close);
    if (ImGui::InvisibleButton("##remove", {close, ImGui::GetFrameHeight()})) remove(desk, entry);
    desk.names.note("remove:" + entry.pattern);
    const ImVec2 at = ImGui::GetItemRectMin();
    const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    draw_icon(Icon::close, at.x + close / 2, at.y + ImGui::GetFrameHeight() / 2, ImGui::GetFontSize() * 0.3F,
              packed(hovered ? Tone::red : Tone::dim));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove; a reset or reload brings the scene's own back");
  }

  static void hint(const BehaviorEntry& entry, int active, int all) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::Text("%s: %d of %d act", entry.type.c_str(), active, all);
    if (!entry.error.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, packed(Tone::red));
      ImGui::TextUnformatted(entry.error.c_str());
      ImGui::PopStyleColor();
      ImGui::TextDisabled("switching it tries again");
    }
    ImGui::TextDisabled("%s", entry.pattern.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }

  static void remove(Desk& desk, const BehaviorEntry& entry) {
    if (desk.selected == entry.pattern) desk.selected.clear();
    desk.send(entry.pattern + "/remove");
  }

  // what may be added is a script's word, so it goes the way of a script
  void add_popup(Desk& desk) {
    if (!ImGui::BeginPopup("add")) return;
    const std::vector<std::string>& types = desk.options->behavior_types;
    const float width = ImGui::GetFontSize() * 14;
    ImGui::TextDisabled("a behaviour for %s",
                        body_ == 0 ? "all bodies" : std::string(desk.image->tree->name(body_)).c_str());
    ImGui::SetNextItemWidth(width);
    if (ImGui::BeginCombo("type", type_.c_str(), ImGuiComboFlags_HeightLarge)) {
      for (const std::string& type : types) {
        if (ImGui::Selectable(type.c_str(), type == type_)) {
          if (name_.empty() || name_ == type_) name_ = type;
          type_ = type;
        }
        desk.names.note("behaviors.type=" + type);
      }
      ImGui::EndCombo();
    } else {
      desk.names.note("behaviors.type");
    }
    ImGui::SetNextItemWidth(width);
    ImGui::InputText("name", &name_);
    desk.names.note("behaviors.name");
    ImGui::BeginDisabled(type_.empty() || name_.empty());
    if (ImGui::Button("add it")) {
      evaluator_.ask(desk.link, add_text(desk));
      ImGui::CloseCurrentPopup();
    }
    desk.names.note("behaviors.add_it");
    ImGui::EndDisabled();
    ImGui::EndPopup();
  }

  std::string add_text(const Desk& desk) const {
    const std::string add = fmt::format(":add_behavior({}, {})", lua_text(type_), lua_text(name_));
    if (body_ != 0) return lua_path(*desk.image->tree, {body_, nullptr}) + add;
    return fmt::format("for _, body in ipairs(sim.bodies) do body{} end", add);
  }

  Evaluator evaluator_;
  int moves_ = 0;            // that wait: earlier, or later
  std::uint64_t moved_ = 0;  // the image that has the last one
  std::shared_ptr<const Tree> tree_;
  std::shared_ptr<const Image> image_;
  std::uint32_t body_ = 0;
  std::vector<BehaviorEntry> entries_;
  std::string type_;
  std::string name_;
};

[[maybe_unused]] const bool kBehaviorsPanel = panel<BehaviorsPanel>(
    {.name = "behaviors", .title = "Behaviours", .wide = Slot::left_below, .compact = Slot::right, .order = 2});

}  // namespace
}  // namespace limber
