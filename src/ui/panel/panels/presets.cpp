// Presets: a strip and a list of presets by name, to recall, store, rename and delete them; the duration and easing of
// morphs, and an index that interpolates between presets.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "engine/presets/morph.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr double kMaxSlotWidth = 130;      // units
constexpr double kStatusWidth = 230;       // units of the first row that the status uses
constexpr double kWideStatusWidth = 350;   // with the numbers of bodies and parts
constexpr double kWideStatusAbove = 1500;  // units

class PresetsPanel : public Panel {
 public:
  void draw(GuiContext& context) override {
    const std::vector<std::string> names = names_of(context);
    const auto s = static_cast<float>(context.scale);
    const float window = ImGui::GetWindowWidth();
    const bool compact = window < static_cast<float>(kCompactBelow) * s * 0.95F;
    if (!compact) ImGui::SameLine(0, 16 * s);  // else in its own row
    const ImVec2 strip = ImGui::GetCursorPos();
    if (!compact) ImGui::NewLine();  // else items of the other row return to this one, from Dear ImGui 1.90 on
    const float morph = window - static_cast<float>(kMorphWidth) * s;
    ImGui::SetCursorPos({morph, top_row_y(context, 1)});
    draw_morph(context, names, s);
    ImGui::SetCursorPos(strip);
    const double status = window > static_cast<float>(kWideStatusAbove) * s ? kWideStatusWidth : kStatusWidth;
    draw_strip(context, names, s, compact ? morph : window - static_cast<float>(status) * s);
  }

 private:
  static std::vector<std::string> names_of(const GuiContext& context) {
    std::vector<std::string> names;
    const auto handle = context.find("/preset/names");
    if (!handle) return names;
    for (const std::string_view name : split(context.text(handle->ref), '\n')) {
      if (!name.empty()) names.emplace_back(name);
    }
    return names;
  }

  // Returns a name that no preset has.
  static std::string unused_name(const std::vector<std::string>& names, std::size_t number) {
    std::string name = fmt::format("preset {}", number);
    while (std::find(names.begin(), names.end(), name) != names.end()) name = fmt::format("preset {}", ++number);
    return name;
  }

  static std::string label_of(const std::vector<std::string>& names, std::size_t i) {
    return fmt::format("{} {}", i + 1, names[i]);
  }

  static float slot_width(const std::vector<std::string>& names, std::size_t i, float s) {
    const float text = ImGui::CalcTextSize(label_of(names, i).c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
    return std::min(text, static_cast<float>(kMaxSlotWidth) * s);
  }

  // Draws the presets as buttons, as many as fit up to `right`; the arrows and the wheel scroll. The list has all.
  void draw_strip(GuiContext& context, const std::vector<std::string>& names, float s, float right) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Presets");
    ImGui::SameLine(0, 6 * s);
    const float gap = 4 * s;
    const float side = ImGui::GetFrameHeight();
    const float space = right - ImGui::GetCursorPosX() - 2 * (side + gap);  // without the list and the plus
    const bool scrolls = count_fitting(names, 0, 1, space, s) < names.size();
    const float strip = scrolls ? space - 2 * (side + gap) : space;
    // at the end of the scroll range, the last presets fill the strip
    const std::size_t last = names.size() - count_fitting(names, names.size() - 1, -1, strip, s);
    first_ = scrolls ? std::min(first_, last) : 0;
    const std::size_t count = count_fitting(names, first_, 1, strip, s);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    if (scrolls) {
      draw_arrow(context, "preset.earlier", ImGuiDir_Left, "Earlier presets", first_ == 0, -1);
      ImGui::SameLine(0, gap);
    }
    for (std::size_t i = first_; i < first_ + count; i++) {
      draw_slot(context, names, i, slot_width(names, i, s));
      ImGui::SameLine(0, gap);
    }
    if (scrolls) {
      draw_arrow(context, "preset.later", ImGuiDir_Right, "Later presets", first_ == last, 1);
      ImGui::SameLine(0, gap);
    }
    if (ImGui::IsMouseHoveringRect(from, {from.x + strip, from.y + side})) scroll(-ImGui::GetIO().MouseWheel);
    draw_list_button(context, names);
    ImGui::SameLine(0, gap);
    if (icon_button(context.names, "preset.new", Icon::plus, "Store the current state as a new preset", false, side))
      store(context, unused_name(names, names.size() + 1));
  }

  // Returns how many presets fit from `at` on, forwards or backwards (-1); at least one, if there is one.
  static std::size_t count_fitting(const std::vector<std::string>& names, std::size_t at, int direction, float width,
                                   float s) {
    std::size_t count = 0;
    for (float used = 0; at < names.size(); at += static_cast<std::size_t>(direction), count++) {
      used += slot_width(names, at, s);
      if (used > width && count > 0) break;
      used += 4 * s;
    }
    return count;
  }

  void scroll(float steps) {
    if (steps > 0) first_++;
    if (steps < 0 && first_ > 0) first_--;
  }

  void draw_arrow(GuiContext& context, const char* name, ImGuiDir direction, const char* tooltip, bool at_end,
                  float steps) {
    ImGui::BeginDisabled(at_end);
    if (ImGui::ArrowButton(name, direction)) scroll(steps);
    ImGui::EndDisabled();
    context.names.add(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
  }

  void draw_slot(GuiContext& context, const std::vector<std::string>& names, std::size_t i, float width) {
    const bool active = recalled_ == names[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_Button, packed_color(active ? ThemeColor::active : ThemeColor::field));
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(active ? ThemeColor::on_active : ThemeColor::text));
    if (ImGui::Button("###slot", {width, ImGui::GetFrameHeight()})) press(context, names, i);
    context.names.add(fmt::format("preset.{}", i + 1));
    // drawn here, because a name may contain "##", which ends a label of Dear ImGui
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 padding = ImGui::GetStyle().FramePadding;
    imgui::text_ellipsis({low.x + padding.x, low.y + padding.y},
                         {low.x + width - padding.x + 1, ImGui::GetItemRectMax().y}, label_of(names, i));
    ImGui::PopStyleColor(2);
    preset_hint(context, names, i);
    ImGui::PopID();
  }

  // Adds a tooltip and the context menu to the last item, which stands for a preset.
  void preset_hint(GuiContext& context, const std::vector<std::string>& names, std::size_t i) {
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s: click to recall, Ctrl+click to overwrite, right click to rename or delete",
                        names[i].c_str());
    if (!ImGui::BeginPopupContextItem("##menu")) return;
    if (ImGui::IsWindowAppearing()) edited_ = names[i];
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 12);
    bool renamed = ImGui::InputText("Name", &edited_, ImGuiInputTextFlags_EnterReturnsTrue);
    context.names.add("menu:preset_name");
    renamed |= ImGui::Selectable("Rename");
    context.names.add("menu:preset_rename");
    if (ImGui::Selectable("Store the current state here")) store(context, names[i]);
    context.names.add("menu:preset_store");
    if (ImGui::Selectable("Delete")) context.send("/preset/delete", {Arg::of(std::string_view(names[i]))});
    context.names.add("menu:preset_delete");
    if (renamed) {
      rename(context, names[i]);
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }

  void rename(GuiContext& context, const std::string& name) {
    if (edited_ == name) return;
    context.send("/preset/rename", {Arg::of(std::string_view(name)), Arg::of(std::string_view(edited_))});
    if (recalled_ == name) recalled_ = edited_;
  }

  // A list of all presets with their whole names.
  void draw_list_button(GuiContext& context, const std::vector<std::string>& names) {
    ImGui::BeginDisabled(names.empty());
    if (ImGui::ArrowButton("preset.list", ImGuiDir_Down)) ImGui::OpenPopup("all");
    ImGui::EndDisabled();
    context.names.add("preset.list");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("All presets");
    const float line = ImGui::GetTextLineHeightWithSpacing();
    ImGui::SetNextWindowSizeConstraints({0, 0}, {ImGui::GetIO().DisplaySize.x, 20 * line});
    if (!ImGui::BeginPopup("all")) return;
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(names.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) draw_list_line(context, names, i);
    }
    ImGui::EndPopup();
  }

  void draw_list_line(GuiContext& context, const std::vector<std::string>& names, int i) {
    const auto index = static_cast<std::size_t>(i);
    const std::string label = label_of(names, index);
    ImGui::PushID(i);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::CalcTextSize(label.c_str(), nullptr, false).x, ImGui::GetFontSize() * 10);
    if (ImGui::Selectable("##line", recalled_ == names[index], 0, {width, 0})) press(context, names, index);
    context.names.add(fmt::format("preset.list.{}", i + 1));
    ImGui::GetWindowDrawList()->AddText(from, packed_color(ThemeColor::text), label.c_str());
    preset_hint(context, names, index);
    ImGui::PopID();
  }

  void press(GuiContext& context, const std::vector<std::string>& names, std::size_t i) {
    if (ImGui::GetIO().KeyCtrl) return store(context, names[i]);
    recalled_ = names[i];
    context.recall(static_cast<double>(i + 1));
  }

  void store(GuiContext& context, const std::string& name) {
    context.send("/preset/store", {Arg::of(std::string_view(name))});
    context.show_notice(fmt::format("Stored: {}", name));
    recalled_ = name;
  }

  // The duration and easing of recalls, and the index that interpolates between presets.
  void draw_morph(GuiContext& context, const std::vector<std::string>& names, float s) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Morph s");
    ImGui::SameLine(0, 5 * s);
    ImGui::PushFont(context.fonts.code);
    const SliderRange seconds{0, GuiSettings::kMaxMorphSeconds, 1.5, 0, false};
    double morph = context.settings.morph_seconds;
    if (time_bar(context, seconds, morph, 72 * s)) context.settings.morph_seconds = morph;
    ImGui::PopFont();
    ImGui::SameLine(0, 4 * s);
    draw_easing(context, 84 * s);
    ImGui::SameLine(0, 10 * s);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Blend");
    context.names.add("preset.index.label");
    ImGui::SameLine(0, 5 * s);
    draw_index(context, names, 100 * s);
  }

  static bool time_bar(GuiContext& context, const SliderRange& range, double& seconds, float width) {
    const bool changed = number_slider("##morph", range, width, seconds);
    context.names.add("preset.seconds");
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) {
      ImGui::PushFont(context.fonts.text);
      ImGui::SetTooltip("Duration of a recall in simulated seconds; 0: immediately");
      ImGui::PopFont();
    }
    return changed;
  }

  static void draw_easing(GuiContext& context, float width) {
    const std::vector<std::string> names = engine::easings();
    const auto selected = std::min(static_cast<std::size_t>(std::max(context.settings.easing, 0)), names.size() - 1);
    ImGui::SetNextItemWidth(width);
    const bool open = ImGui::BeginCombo("##easing", names[selected].c_str());
    if (!open) {
      context.names.add("preset.easing");
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("Easing of the morph");
      return;
    }
    for (std::size_t i = 0; i < names.size(); i++) {
      if (ImGui::Selectable(names[i].c_str(), i == selected)) context.settings.easing = static_cast<int>(i);
      context.names.add(fmt::format("preset.easing={}", names[i]));
    }
    ImGui::EndCombo();
  }

  // fractional indices interpolate between two presets
  void draw_index(GuiContext& context, const std::vector<std::string>& names, float width) {
    const double last = std::max(static_cast<double>(names.size()), 2.0);
    ImGui::BeginDisabled(names.size() < 2);
    ImGui::PushFont(context.fonts.code);
    index_ = std::clamp(index_, 1.0, last);
    if (number_slider("##index", {1, last, 1, 0, false}, width, index_)) {
      recalled_.clear();
      context.send("/preset/recall", {Arg::of(index_)});
    }
    ImGui::PopFont();
    context.names.add("preset.index");
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
      ImGui::SetTooltip("Interpolates between presets: 2.5 is halfway from the second to the third");
    ImGui::EndDisabled();
    const double progress = context.number("/preset/progress", 1);
    if (progress < 1) {
      const ImVec2 low = ImGui::GetItemRectMin();
      const ImVec2 high = ImGui::GetItemRectMax();
      const float x = low.x + (high.x - low.x) * static_cast<float>(progress);
      ImGui::GetWindowDrawList()->AddRectFilled({low.x, high.y}, {x, high.y + 3}, packed_color(ThemeColor::accent));
    }
  }

  std::string recalled_;   // name of the preset that was recalled or stored last
  std::string edited_;     // text in the field for the name in the menu
  std::size_t first_ = 0;  // index of the first preset in the strip
  double index_ = 1;
};

[[maybe_unused]] const bool kPresetsPanel = register_panel_type<PresetsPanel>(
    {.name = "presets", .title = "", .wide_slot = PanelSlot::top, .compact_slot = PanelSlot::top, .order = 1});

}  // namespace
}  // namespace limber::panel
