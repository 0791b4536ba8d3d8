// Lighting: the switches of the output to lights, the fixtures, and a monitor of the values of each universe.
#include <algorithm>
#include <array>
#include <cmath>
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

using LightState = engine::LightingStatus::State;

struct LightStateText {
  const char* text;
  const char* hint;
  ThemeColor color;
};

LightStateText light_state_text(LightState state) {
  switch (state) {
    case LightState::no_output:
      return {"No output", "The program was started without lighting output; see --lights-out", ThemeColor::secondary};
    case LightState::off:
      return {"Off", "Nothing is sent to the lights until you arm the output", ThemeColor::secondary};
    case LightState::blocked:
      return {"Blocked",
              "A take, a rewind or a file has armed the output. To send, switch Armed off and on again, or "
              "start with --lights",
              ThemeColor::red};
    case LightState::sending:
      break;
  }
  return {"Sending", "The values are sent to the lights", ThemeColor::green};
}

class LightingPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    return context.link.lighting.state() == LightState::sending ? "on" : "";
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr || context.snapshot == nullptr) return;
    draw_switches(context);
    if (!ImGui::BeginChild("##lighting", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    draw_fixtures(context);
    for (const sim::DmxUniverse& universe : context.snapshot->dmx.universes) draw_universe(context, universe);
    ImGui::EndChild();
  }

 private:
  static void draw_switch(GuiContext& context, const char* label, const char* property, const char* name,
                          const char* hint) {
    const std::string path = fmt::format("/lighting/{}", property);
    bool on = context.number(path) != 0;
    if (ImGui::Checkbox(label, &on)) context.toggle(path.c_str());
    context.names.add(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint);
    ImGui::SameLine();
  }

  static void draw_switches(GuiContext& context) {
    draw_switch(context, "Armed", "armed", "lighting.armed", "Send the values to the lights (Ctrl+L)");
    draw_switch(context, "Blackout", "blackout", "lighting.blackout",
                "All fixtures are dark; their heads keep moving (Ctrl+B)");
    if (const auto master = context.find("/lighting/grand_master")) {
      ImGui::AlignTextToFramePadding();
      ImGui::TextDisabled("Master");
      ImGui::SameLine();
      property_widget(context, *master, 90 * static_cast<float>(context.scale));
      context.names.add("lighting.master");
      property_menu(context, *master);
      ImGui::SameLine();
    }
    const engine::LightingStatus& status = context.link.lighting;
    const LightStateText state = light_state_text(status.state());
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(state.color));
    ImGui::TextUnformatted(state.text);
    ImGui::PopStyleColor();
    context.names.add("lighting.state");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s\n%s\n%llu packets sent", state.hint, status.text().c_str(),
                        static_cast<unsigned long long>(status.packets.load()));
  }

  static void draw_fixtures(GuiContext& context) {
    const TreeSnapshot& tree = *context.value_snapshot->tree;
    const Result<TreePropertyRef> group = tree.find("/lighting/fixture");
    bool any = false;
    if (group) {
      tree.each_child(group->node, [&](std::uint32_t node) {
        any = true;
        draw_fixture(context, std::string(tree.name(node)), tree.path(node));
        return true;
      });
    }
    if (!any) ImGui::TextDisabled("The scene has no fixtures: sim:add_fixture adds one");
  }

  // One line: color, name, address, pan and tilt.
  static void draw_fixture(GuiContext& context, const std::string& name, const std::string& path) {
    const float size = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(path.c_str());
    if (ImGui::Selectable("##fixture", context.selected == path, 0, {0, size})) context.select(path);
    context.names.add("lighting.fixture:" + name);
    const auto read = [&](const char* property) { return context.number(path + property); };
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s: universe %.0f, address %.0f. Click to see all its values", name.c_str(), read("/universe"),
                        read("/address"));
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const Vec3 light = light_of(context, path);
    const auto channel = [&](int i) { return static_cast<int>(std::lround(std::clamp(light[i], 0.0, 1.0) * 255)); };
    list.AddRectFilled({at.x + 2, at.y + 2}, {at.x + size - 2, at.y + size - 2},
                       IM_COL32(channel(0), channel(1), channel(2), 255), 2);
    list.AddRect({at.x + 2, at.y + 2}, {at.x + size - 2, at.y + size - 2}, packed_color(ThemeColor::secondary), 2);
    const std::string numbers = fmt::format("{:.0f}.{:03.0f}  pan {:7.1f}\u00b0  tilt {:7.1f}\u00b0", read("/universe"),
                                            read("/address"), read("/pan"), read("/tilt"));
    ImGui::PushFont(context.fonts.code);
    const float width = ImGui::CalcTextSize(numbers.c_str()).x;
    const float right = at.x + ImGui::GetContentRegionAvail().x - width;
    list.AddText({right, at.y}, packed_color(ThemeColor::text), numbers.c_str());
    ImGui::PopFont();
    const std::string shown = elided(name, right - at.x - 2 * size, text_width);
    list.AddText({at.x + 1.5F * size, at.y}, packed_color(ThemeColor::text), shown.c_str());
  }

  static Vec3 light_of(const GuiContext& context, const std::string& path) {
    const auto handle = context.find(path + "/light");
    PendingValues::Values values{};
    if (!handle || !context.values(*handle, values)) return Vec3(0);
    return {values[0], values[1], values[2]};
  }

  // A grid of the values, up to the last channel in use; each row begins with the number of its first channel.
  static void draw_universe(GuiContext& context, const sim::DmxUniverse& universe) {
    ImGui::TextDisabled("Universe %d", universe.number);
    context.names.add(fmt::format("lighting.universe:{}", universe.number));
    ImGui::PushFont(context.fonts.code);
    const float cell = ImGui::CalcTextSize("0000").x;
    const float row = ImGui::GetTextLineHeightWithSpacing();
    const auto columns =
        static_cast<std::size_t>(std::clamp(std::floor(ImGui::GetContentRegionAvail().x / cell - 2), 4.0F, 32.0F));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t first = 0; first < universe.length; first += columns) {
      const ImVec2 at = ImGui::GetCursorScreenPos();
      ImGui::Dummy({cell * static_cast<float>(columns + 1), row - ImGui::GetStyle().ItemSpacing.y});
      if (!ImGui::IsItemVisible()) continue;
      list.AddText(at, packed_color(ThemeColor::secondary), fmt::format("{:3}", first + 1).c_str());
      for (std::size_t i = first; i < std::min<std::size_t>(first + columns, universe.length); i++) {
        const int value = universe.values[i];
        list.AddText({at.x + cell * (1.5F + static_cast<float>(i - first)), at.y},
                     packed_color(value == 0 ? ThemeColor::secondary : ThemeColor::accent),
                     fmt::format("{:3}", value).c_str());
      }
      if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Channels %d and following of universe %d", static_cast<int>(first + 1), universe.number);
    }
    ImGui::PopFont();
  }
};

[[maybe_unused]] const bool kLightingPanel = register_panel_type<LightingPanel>({.name = "lighting",
                                                                                 .title = "Lighting",
                                                                                 .wide_slot = PanelSlot::bottom_middle,
                                                                                 .compact_slot = PanelSlot::bottom,
                                                                                 .order = 8});

}  // namespace
}  // namespace limber::panel
