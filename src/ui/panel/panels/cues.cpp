// Cues: the list of cues, the one that has run last, the buttons that start and pause them, and the clock.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

class CuesPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    const double current = context.number("/cue/current");
    return current > 0 ? fmt::format("{:.0f}", current) : "";
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    const auto handle = context.find("/cue/names");
    const std::string_view names = handle ? context.text(handle->ref) : std::string_view();
    draw_buttons(context, names.empty());
    draw_clock(context);
    if (!ImGui::BeginChild("##cues", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    if (names.empty()) ImGui::TextDisabled("No cues: write them to a file beside the scene, SCENE.cues.json");
    const auto current = static_cast<int>(context.number("/cue/current"));
    int number = 0;
    for (const std::string_view name : split(names, '\n')) {
      if (!name.empty()) draw_cue(context, ++number, std::string(name), current);
    }
    shown_ = current;
    ImGui::EndChild();
  }

 private:
  static void draw_button(GuiContext& context, const char* label, const char* address, const char* name,
                          const char* hint) {
    if (ImGui::Button(label)) context.send(address);
    context.names.add(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint);
    ImGui::SameLine();
  }

  static void draw_buttons(GuiContext& context, bool empty) {
    const bool paused = context.number("/cue/paused") != 0;
    ImGui::BeginDisabled(empty);
    draw_button(context, "Go", "/cue/go", "cues.go", "Start the next cue (F5)");
    draw_button(context, "Back", "/cue/back", "cues.back", "Start the cue before the last one again (Shift+F5)");
    draw_button(context, paused ? "Resume###pause" : "Pause###pause", "/cue/pause", "cues.pause",
                "Pause or resume the time until the next cue starts by itself (F6)");
    ImGui::EndDisabled();
    const double follow = context.number("/cue/follow");
    const double waiting = context.number("/cue/waiting");
    ImGui::AlignTextToFramePadding();
    if (waiting > 0) {
      ImGui::Text("%.0f waits for its beat", waiting);
    } else if (follow > 0) {
      ImGui::Text("%s in %.1f s", paused ? "Paused: next" : "Next", follow);
    } else {
      ImGui::TextDisabled(paused ? "Paused" : "Waits for Go");
    }
    context.names.add("cues.state");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Simulated time until the next cue starts by itself");
  }

  // The beat as a lamp that is bright at its start, the tempo, and its buttons.
  static void draw_clock(GuiContext& context) {
    const auto tempo = context.find("/clock/tempo");
    if (!tempo) return;
    const double beat = context.number("/clock/beat");
    const double beats_per_bar = std::max(context.number("/clock/beats_per_bar"), 1.0);
    const double beat_in_bar = std::floor(beat) - std::floor(beat / beats_per_bar) * beats_per_bar;  // from 0
    const bool playing = context.number("/clock/playing") != 0;
    if (ImGui::Button(playing ? "Stop###clock" : "Play###clock")) context.toggle("/clock/playing");
    context.names.add("clock.playing");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Stop the beat, or continue");
    ImGui::SameLine();
    draw_button(context, "Start", "/clock/start", "clock.start", "Start again at beat 0");
    draw_button(context, "Tap", "/clock/tap", "clock.tap", "Tap the tempo: click it on each beat (F7)");
    property_widget(context, *tempo, 90 * static_cast<float>(context.scale));
    context.names.add("clock.tempo");
    property_menu(context, *tempo);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = ImGui::GetFrameHeight();
    const auto fading = static_cast<float>(1 - (beat - std::floor(beat)));
    const ImU32 color = packed_color(beat_in_bar == 0 ? ThemeColor::accent : ThemeColor::text, playing ? fading : 0.1F);
    ImGui::GetWindowDrawList()->AddCircleFilled({at.x + size / 2, at.y + size / 2}, size / 4, color);
    ImGui::Dummy({size, size});
    ImGui::SameLine();
    ImGui::Text("%.0f.%.0f  %.1f", context.number("/clock/bar") + 1, beat_in_bar + 1,
                context.number("/clock/current_tempo"));
    context.names.add("clock.state");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Bar and beat, and the tempo now%s",
                        context.number("/clock/synced") != 0 ? ": another program leads the clock" : "");
  }

  // One line: number and name. The current cue is scrolled to when it has changed.
  void draw_cue(GuiContext& context, int number, const std::string& name, int current) const {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool selected = number == current;
    ImGui::PushID(number);
    if (ImGui::Selectable("##cue", selected, 0, {0, ImGui::GetTextLineHeight()}))
      context.send("/cue/jump", {Arg::of(static_cast<double>(number))});
    context.names.add(fmt::format("cues.cue:{}", name));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%d %s: click to start this cue", number, name.c_str());
    if (selected && shown_ != current) ImGui::SetScrollHereY();
    ImGui::PopID();
    // drawn here, because a name may contain "##", which ends a label of Dear ImGui
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const std::string digits = fmt::format("{}", number);
    const float column = ImGui::CalcTextSize("0000").x;
    list.AddText({at.x + column * 0.8F - ImGui::CalcTextSize(digits.c_str()).x, at.y},
                 packed_color(ThemeColor::secondary), digits.c_str());
    const std::string text = elided(name, ImGui::GetContentRegionAvail().x - column, text_width);
    list.AddText({at.x + column, at.y}, packed_color(selected ? ThemeColor::accent : ThemeColor::text), text.c_str());
  }

  int shown_ = 0;  // number of the current cue in the last frame
};

[[maybe_unused]] const bool kCuesPanel = register_panel_type<CuesPanel>({.name = "cues",
                                                                         .title = "Cues",
                                                                         .wide_slot = PanelSlot::bottom_middle,
                                                                         .compact_slot = PanelSlot::bottom,
                                                                         .order = 9});

}  // namespace
}  // namespace limber::panel
