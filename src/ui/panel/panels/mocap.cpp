// Motion capture: each source with its state, a player for those from files, and the joints with their age, confidence
// and place. The settings of the selected source are in the parameters.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

constexpr const char* kMocap = "/physics/mocap";

// A line's state: its color and a short text.
struct LineState {
  ThemeColor color = ThemeColor::secondary;
  std::string text;
};

class MocapPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    if (context.value_snapshot == nullptr) return {};
    std::size_t count = 0, lost = 0;
    for_each(context, kMocap, [&](std::uint32_t, const std::string& path) {
      count++;
      if (is_lost(context, path)) lost++;
    });
    if (lost > 0) return fmt::format("{} lost", lost);
    return count == 0 ? "" : fmt::format("{}", count);
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    if (!ImGui::BeginChild("##mocap", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    bool any = false;
    for_each(context, kMocap, [&](std::uint32_t node, const std::string& path) {
      any = true;
      ImGui::PushID(path.c_str());
      draw_source(context, name_of(context, node), path);
      ImGui::PopID();
    });
    if (!any) ImGui::TextDisabled("No sources: sim:add_mocap adds one");
    ImGui::EndChild();
  }

 private:
  // Calls f(node, path) for each child of a node.
  template <class F>
  static void for_each(const GuiContext& context, const std::string& path, F f) {
    const TreeSnapshot& tree = *context.value_snapshot->tree;
    const Result<TreePropertyRef> parent = tree.find(path);
    if (!parent) return;
    tree.each_child(parent->node, [&](std::uint32_t node) {
      f(node, tree.path(node));
      return true;
    });
  }

  static std::string name_of(const GuiContext& context, std::uint32_t node) {
    return std::string(context.value_snapshot->tree->name(node));
  }

  // A source that had frames, or a file, and has none now.
  static bool is_lost(const GuiContext& context, const std::string& path) {
    return context.number(path + "/active") != 0 && context.number(path + "/tracked") == 0 &&
           context.number(path + "/age", -1) >= 0 && context.number(path + "/duration") == 0;
  }

  static LineState state_of(const GuiContext& context, const std::string& path) {
    if (context.number(path + "/active") == 0) return {ThemeColor::secondary, "off"};
    if (is_lost(context, path))
      return {ThemeColor::red, fmt::format("lost for {:.1f} s", context.number(path + "/age"))};
    if (context.number(path + "/tracked") == 0 && context.number(path + "/duration") == 0)
      return {ThemeColor::secondary, "waits for frames"};
    const double missing = context.number(path + "/missing");
    if (missing > 0) return {ThemeColor::accent, fmt::format("{:.0f} missing", missing)};
    return {ThemeColor::green, context.number(path + "/duration") > 0 ? "file" : "live"};
  }

  static void draw_source(GuiContext& context, const std::string& name, const std::string& path) {
    if (const auto active = context.find(path + "/active")) {
      property_widget(context, *active, ImGui::GetFrameHeight());
      property_menu(context, *active);
      ImGui::SameLine();
    }
    ImGui::AlignTextToFramePadding();
    draw_line(context, path, "mocap:" + path, name, state_of(context, path),
              fmt::format("{}: {:.0f} messages, mean speed {:.2f} m/s, {:.0f} joints on the floor\nClick for its place "
                          "on stage and its limits",
                          name, context.number(path + "/frames"), context.number(path + "/mean_speed"),
                          context.number(path + "/contacts")));
    if (context.number(path + "/duration") > 0) draw_player(context, path);
    for_each(context, path + "/joint",
             [&](std::uint32_t node, const std::string& joint) { draw_joint(context, name_of(context, node), joint); });
  }

  // A switch with its name, at the left of the next item.
  static void draw_switch(GuiContext& context, const char* label, const std::string& property) {
    bool on = context.number(property) != 0;
    if (ImGui::Checkbox(label, &on)) context.toggle(property.c_str());
    context.names.add(property);
    if (const auto handle = context.find(property)) property_hint(*handle);
    ImGui::SameLine();
  }

  // Play, loop, speed, and the place in the file.
  static void draw_player(GuiContext& context, const std::string& path) {
    const float side = ImGui::GetFrameHeight();
    draw_switch(context, "Play", path + "/playing");
    draw_switch(context, "Loop", path + "/loop");
    if (const auto speed = context.find(path + "/speed")) {
      property_widget(context, *speed, 3 * side);
      property_menu(context, *speed);
      ImGui::SameLine();
    }
    const double duration = context.number(path + "/duration");
    auto time = static_cast<float>(context.number(path + "/time"));
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x, side));
    if (ImGui::SliderFloat("##time", &time, 0, static_cast<float>(duration),
                           fmt::format("%.1f of {:.1f} s", duration).c_str(), ImGuiSliderFlags_AlwaysClamp))
      context.send(path + "/time", {Arg::of(static_cast<double>(time))});
    context.names.add("time:" + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Place in the file; drag to scrub");
  }

  static void draw_joint(GuiContext& context, const std::string& name, const std::string& path) {
    if (!ImGui::IsRectVisible({1, ImGui::GetTextLineHeight()})) return ImGui::Dummy({1, ImGui::GetTextLineHeight()});
    const double age = context.number(path + "/age", -1);
    const double confidence = context.number(path + "/confidence");
    LineState state{ThemeColor::secondary, "not seen"};
    PendingValues::Values place{};
    const auto position = context.find(path + "/position");
    if (age >= 0 && position && context.values(*position, place)) {
      state = {confidence < 0.5 ? ThemeColor::red : ThemeColor::text,
               fmt::format("{:7.2f} {:6.2f} {:6.2f} {:4.0f} %", place[0], place[1], place[2], 100 * confidence)};
    }
    draw_line(context, path, "mocap.joint:" + path, "    " + name, state,
              age < 0
                  ? fmt::format("{}: no sample has arrived", name)
                  : fmt::format("{}: x, y and z in meters, and its confidence\nLast sample {:.2f} s ago, {:.2f} m/s",
                                name, age, context.number(path + "/speed")));
  }

  // A line that selects `path`: the label at the left, the state at the right.
  static void draw_line(GuiContext& context, const std::string& path, const std::string& widget,
                        const std::string& label, const LineState& state, const std::string& hint) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PushID(path.c_str());
    if (ImGui::Selectable("##line", context.selected == path, 0, {0, ImGui::GetTextLineHeight()})) context.select(path);
    context.names.add(widget);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint.c_str());
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::PushFont(context.fonts.code);
    const float right = at.x + width - ImGui::CalcTextSize(state.text.c_str()).x;
    list.AddText({right, at.y}, packed_color(state.color), state.text.c_str());
    ImGui::PopFont();
    list.AddText(at, packed_color(ThemeColor::text),
                 elided(label, right - at.x - ImGui::GetStyle().ItemSpacing.x, text_width).c_str());
  }
};

[[maybe_unused]] const bool kMocapPanel = register_panel_type<MocapPanel>({.name = "mocap",
                                                                           .title = "Mocap",
                                                                           .wide_slot = PanelSlot::bottom_right,
                                                                           .compact_slot = PanelSlot::right,
                                                                           .order = 11});

}  // namespace
}  // namespace limber::panel
