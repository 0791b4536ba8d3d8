// Motion capture: the sources with their state, the joints that are missing, and the player of files.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "base/plural.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

constexpr const char* kMocap = "/physics/mocap";

class MocapPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    int count = 0;
    each_source(context, [&](const std::string&, const std::string&) { count++; });
    return count == 0 ? "" : fmt::format("{}", count);
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    if (!ImGui::BeginChild("##mocap", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    bool any = false;
    each_source(context, [&](const std::string& name, const std::string& path) {
      any = true;
      ImGui::PushID(path.c_str());
      draw_source(context, name, path);
      if (context.number(path + "/duration") > 0) draw_player(context, name, path);
      ImGui::PopID();
    });
    if (!any) ImGui::TextDisabled("The scene has no motion capture: sim:add_mocap adds a source");
    ImGui::EndChild();
  }

 private:
  template <class F>
  static void each_source(const GuiContext& context, F&& call) {
    if (context.value_snapshot == nullptr) return;
    const TreeSnapshot& tree = *context.value_snapshot->tree;
    const Result<TreePropertyRef> group = tree.find(kMocap);
    if (!group) return;
    tree.each_child(group->node, [&](std::uint32_t node) {
      call(std::string(tree.name(node)), tree.path(node));
      return true;
    });
  }

  // One line: whether it is tracked, its name, and how many frames and joints have arrived.
  static void draw_source(GuiContext& context, const std::string& name, const std::string& path) {
    const float size = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##source", context.selected == path, 0, {0, size})) context.select(path);
    context.names.add("mocap.source:" + name);
    const bool tracked = context.number(path + "/tracked") != 0;
    const double age = context.number(path + "/age");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s: %s. Click to see and adjust its place, scale and limits", name.c_str(),
                        tracked   ? "frames arrive"
                        : age < 0 ? "no frame has arrived yet"
                                  : "lost; it stays where it is");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled({at.x + size / 2, at.y + size / 2}, size / 4,
                         packed_color(tracked   ? ThemeColor::green
                                      : age < 0 ? ThemeColor::secondary
                                                : ThemeColor::red));
    const auto missing = static_cast<std::uint64_t>(std::max(0.0, context.number(path + "/missing")));
    std::string state = fmt::format("{:.0f} frames", context.number(path + "/frames"));
    if (age >= 0) state += fmt::format("  {:.2f} s ago", age);
    if (missing > 0) state += fmt::format("  {} missing", counted(missing, "joint"));
    ImGui::PushFont(context.fonts.code);
    const float right = at.x + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(state.c_str()).x;
    list.AddText({right, at.y}, packed_color(missing > 0 ? ThemeColor::red : ThemeColor::text), state.c_str());
    ImGui::PopFont();
    const std::string shown = elided(name, right - at.x - 2 * size, text_width);
    list.AddText({at.x + 1.5F * size, at.y}, packed_color(ThemeColor::text), shown.c_str());
  }

  // Play and pause, the time in the file, and the speed.
  static void draw_player(GuiContext& context, const std::string& name, const std::string& path) {
    const bool playing = context.number(path + "/playing") != 0;
    if (ImGui::Button(playing ? "Pause###play" : "Play###play")) context.toggle((path + "/playing").c_str());
    context.names.add("mocap.play:" + name);
    ImGui::SameLine();
    const double duration = context.number(path + "/duration");
    auto time = static_cast<float>(context.number(path + "/time"));
    const float speed_width = 90 * static_cast<float>(context.scale);
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - speed_width - 8, 40.0F));
    if (ImGui::SliderFloat("##time", &time, 0, static_cast<float>(duration), "%.2f s"))
      context.send(path + "/time", {Arg::of(static_cast<double>(time))});
    context.names.add("mocap.time:" + name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Time in the file, of %.1f s", duration);
    if (const auto speed = context.find(path + "/speed")) {
      ImGui::SameLine();
      property_widget(context, *speed, speed_width);
      context.names.add("mocap.speed:" + name);
      property_menu(context, *speed);
    }
  }
};

[[maybe_unused]] const bool kMocapPanel = register_panel_type<MocapPanel>({.name = "mocap",
                                                                           .title = "Mocap",
                                                                           .wide_slot = PanelSlot::bottom_right,
                                                                           .compact_slot = PanelSlot::right,
                                                                           .order = 11});

}  // namespace
}  // namespace limber::panel
