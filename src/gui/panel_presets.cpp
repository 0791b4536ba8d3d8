// Presets: slots to store and recall, how long and how a morph goes, an index that blends from one to the next.
#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "gui/number_bar.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kPresetSlots = 8;
constexpr double kLongestMorph = 60;  // s

class PresetsPanel : public Panel {
 public:
  void draw(Desk& desk) override {
    const std::vector<std::string> names = names_of(desk);
    const auto s = static_cast<float>(desk.scale);
    // a row of its own in a compact window
    if (ImGui::GetWindowWidth() > static_cast<float>(kCompactBelow) * s * 0.95F) ImGui::SameLine(0, 16 * s);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("preset");
    for (std::size_t i = 0; i < kPresetSlots; i++) {
      ImGui::SameLine(0, 4 * s);
      slot(desk, names, i);
    }
    ImGui::SameLine(0, 10 * s);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("morph s");
    ImGui::SameLine(0, 5 * s);
    ImGui::PushFont(desk.fonts.code);
    const BarRange seconds{0, kLongestMorph, 1.5, 0, false};
    double morph = desk.settings.morph_seconds;
    if (time_bar(desk, seconds, morph, 72 * s)) desk.settings.morph_seconds = morph;
    ImGui::PopFont();
    ImGui::SameLine(0, 4 * s);
    easing(desk, 84 * s);
    ImGui::SameLine(0, 10 * s);
    index(desk, names, 110 * s);
  }

 private:
  static std::vector<std::string> names_of(const Desk& desk) {
    std::vector<std::string> names;
    const auto at = desk.find("/preset/names");
    if (!at) return names;
    for (const std::string_view name : split(desk.text(at->place), '\n')) {
      if (!name.empty()) names.emplace_back(name);
    }
    return names;
  }

  // a name that no preset has
  static std::string fresh_name(const std::vector<std::string>& names, std::size_t number) {
    std::string name = fmt::format("preset {}", number);
    while (std::find(names.begin(), names.end(), name) != names.end()) name = fmt::format("preset {}", ++number);
    return name;
  }

  void slot(Desk& desk, const std::vector<std::string>& names, std::size_t i) {
    const bool there = i < names.size();
    const bool lit = there && recalled_ == names[i];
    const float side = ImGui::GetFrameHeight();
    ImGui::PushID(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_Button, packed(lit ? Tone::lit : there ? Tone::field : Tone::head));
    ImGui::PushStyleColor(ImGuiCol_Text, packed(lit ? Tone::ink : there ? Tone::text : Tone::dim));
    if (ImGui::Button(fmt::format("{}###slot", i + 1).c_str(), {side * 1.05F, side})) press(desk, names, i);
    ImGui::PopStyleColor(2);
    desk.names.note(fmt::format("preset.{}", i + 1));
    if (ImGui::IsItemHovered()) {
      if (there)
        ImGui::SetTooltip("%s: click recalls, Ctrl and click stores over it, right click: more", names[i].c_str());
      if (!there) ImGui::SetTooltip("empty: click stores what is now");
    }
    if (there && ImGui::BeginPopupContextItem("more")) {
      if (ImGui::Selectable("store what is now here")) store(desk, names[i]);
      desk.names.note("preset.store");
      if (ImGui::Selectable("delete")) desk.send("/preset/delete", {Arg::of(std::string_view(names[i]))});
      desk.names.note("preset.delete");
      ImGui::EndPopup();
    }
    ImGui::PopID();
  }

  void press(Desk& desk, const std::vector<std::string>& names, std::size_t i) {
    if (i >= names.size()) return store(desk, fresh_name(names, names.size() + 1));
    if (ImGui::GetIO().KeyCtrl) return store(desk, names[i]);
    recalled_ = names[i];
    desk.recall(static_cast<double>(i + 1));
  }

  void store(Desk& desk, const std::string& name) {
    desk.send("/preset/store", {Arg::of(std::string_view(name))});
    desk.say(fmt::format("stored: {}", name));
    recalled_ = name;
  }

  static bool time_bar(Desk& desk, const BarRange& range, double& seconds, float width) {
    const bool changed = number_bar("##morph", range, width, seconds);
    desk.names.note("preset.seconds");
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) {
      ImGui::PushFont(desk.fonts.words);
      ImGui::SetTooltip("a recall takes so many simulated seconds; 0: at once");
      ImGui::PopFont();
    }
    return changed;
  }

  static void easing(Desk& desk, float width) {
    const std::vector<std::string> ways = easings();
    const auto chosen = std::min(static_cast<std::size_t>(std::max(desk.settings.easing, 0)), ways.size() - 1);
    ImGui::SetNextItemWidth(width);
    const bool open = ImGui::BeginCombo("##easing", ways[chosen].c_str());
    if (!open) {
      desk.names.note("preset.easing");
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("how a morph goes");
      return;
    }
    for (std::size_t i = 0; i < ways.size(); i++) {
      if (ImGui::Selectable(ways[i].c_str(), i == chosen)) desk.settings.easing = static_cast<int>(i);
      desk.names.note(fmt::format("preset.easing={}", ways[i]));
    }
    ImGui::EndCombo();
  }

  // between the whole numbers lies a blend of two presets
  void index(Desk& desk, const std::vector<std::string>& names, float width) {
    const double last = std::max(static_cast<double>(names.size()), 2.0);
    ImGui::BeginDisabled(names.size() < 2);
    ImGui::PushFont(desk.fonts.code);
    index_ = std::clamp(index_, 1.0, last);
    if (number_bar("##index", {1, last, 1, 0, false}, width, index_)) {
      recalled_.clear();
      desk.send("/preset/recall", {Arg::of(index_)});
    }
    ImGui::PopFont();
    desk.names.note("preset.index");
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
      ImGui::SetTooltip("through the presets: 2.5 is half-way from the second to the third");
    ImGui::EndDisabled();
    const double progress = desk.number("/preset/progress", 1);
    if (progress < 1) {
      const ImVec2 low = ImGui::GetItemRectMin();
      const ImVec2 high = ImGui::GetItemRectMax();
      const float x = low.x + (high.x - low.x) * static_cast<float>(progress);
      ImGui::GetWindowDrawList()->AddRectFilled({low.x, high.y}, {x, high.y + 3}, packed(Tone::accent));
    }
  }

  std::string recalled_;
  double index_ = 1;
};

[[maybe_unused]] const bool kPresetsPanel =
    panel<PresetsPanel>({.name = "presets", .title = "", .wide = Slot::top, .compact = Slot::top, .order = 1});

}  // namespace
}  // namespace limber
