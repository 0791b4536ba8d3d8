// Presets: store and recall slots, the duration and easing of morphs, and an index that interpolates between presets.
#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "engine/presets/morph.h"
#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr std::size_t kPresetSlots = 8;

class PresetsPanel : public Panel {
 public:
  void draw(GuiContext& context) override {
    const std::vector<std::string> names = names_of(context);
    const auto s = static_cast<float>(context.scale);
    // its own row in a compact window
    if (ImGui::GetWindowWidth() > static_cast<float>(kCompactBelow) * s * 0.95F) ImGui::SameLine(0, 16 * s);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Preset");
    for (std::size_t i = 0; i < kPresetSlots; i++) {
      ImGui::SameLine(0, 4 * s);
      draw_slot(context, names, i);
    }
    ImGui::SameLine(0, 10 * s);
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
    draw_index(context, names, 110 * s);
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

  void draw_slot(GuiContext& context, const std::vector<std::string>& names, std::size_t i) {
    const bool exists = i < names.size();
    const bool active = exists && recalled_ == names[i];
    const float side = ImGui::GetFrameHeight();
    ImGui::PushID(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_Button, packed_color(active   ? ThemeColor::active
                                                        : exists ? ThemeColor::field
                                                                 : ThemeColor::header));
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(active   ? ThemeColor::on_active
                                                      : exists ? ThemeColor::text
                                                               : ThemeColor::secondary));
    if (ImGui::Button(fmt::format("{}###slot", i + 1).c_str(), {side * 1.05F, side})) press_slot(context, names, i);
    ImGui::PopStyleColor(2);
    context.names.add(fmt::format("preset.{}", i + 1));
    if (ImGui::IsItemHovered()) {
      if (exists)
        ImGui::SetTooltip("%s: click to recall, Ctrl+click to overwrite, right click for more", names[i].c_str());
      if (!exists) ImGui::SetTooltip("Empty: click to store the current state");
    }
    if (exists && ImGui::BeginPopupContextItem("more")) {
      if (ImGui::Selectable("Store the current state here")) store(context, names[i]);
      context.names.add("preset.store");
      if (ImGui::Selectable("Delete")) context.send("/preset/delete", {Arg::of(std::string_view(names[i]))});
      context.names.add("preset.delete");
      ImGui::EndPopup();
    }
    ImGui::PopID();
  }

  void press_slot(GuiContext& context, const std::vector<std::string>& names, std::size_t i) {
    if (i >= names.size()) return store(context, unused_name(names, names.size() + 1));
    if (ImGui::GetIO().KeyCtrl) return store(context, names[i]);
    recalled_ = names[i];
    context.recall(static_cast<double>(i + 1));
  }

  void store(GuiContext& context, const std::string& name) {
    context.send("/preset/store", {Arg::of(std::string_view(name))});
    context.show_notice(fmt::format("Stored: {}", name));
    recalled_ = name;
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

  std::string recalled_;
  double index_ = 1;
};

[[maybe_unused]] const bool kPresetsPanel = register_panel_type<PresetsPanel>(
    {.name = "presets", .title = "", .wide_slot = PanelSlot::top, .compact_slot = PanelSlot::top, .order = 1});

}  // namespace
}  // namespace limber::panel
