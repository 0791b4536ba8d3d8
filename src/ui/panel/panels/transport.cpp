// Transport: reset, step back, play or pause, step; record and play a take; panic; simulated time.
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/time_widgets.h"

namespace limber::panel {

namespace {

class TransportPanel : public Panel {
 public:
  void update(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    const bool panicked = context.panicked();
    if (panicked != panicked_) context.show_notice(panicked ? "Panic: all motion is stopped" : "Panic ended");
    panicked_ = panicked;
  }

  void draw(GuiContext& context) override {
    const bool paused = context.snapshot->paused;
    if (icon_button(context.names, "transport.reset", Icon::back, "Reset the scene (Ctrl+Backspace)"))
      context.send("/transport/reset");
    ImGui::SameLine();
    if (icon_button(context.names, "transport.step_back", Icon::step_back, "Step back one tick (,)"))
      context.step_time(-1);
    ImGui::SameLine();
    if (icon_button(context.names, "transport.play", paused ? Icon::play : Icon::pause, "Play or pause (Space)",
                    paused))
      context.send(paused ? "/transport/play" : "/transport/pause");
    ImGui::SameLine();
    if (icon_button(context.names, "transport.step", Icon::step, "Step one tick (.)")) context.step_time(1);
    ImGui::SameLine();
    draw_record(context);
    ImGui::SameLine();
    draw_play_take(context);
    ImGui::SameLine();
    draw_panic(context);
    ImGui::SameLine();
    ImGui::PushFont(context.fonts.code);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock_text(context.snapshot->time).c_str());
    context.names.add("transport.time");
    ImGui::PopFont();
  }

 private:
  // A circle, or a square while recording, so that color is not the only cue.
  static void draw_record(GuiContext& context) {
    const bool on = context.take_state().recording();
    const Icon icon = on ? Icon::stop : Icon::record;
    if (icon_button(context.names, "transport.record", icon,
                    on ? "Stop the take (Ctrl+R)" : "Record a take from the start of the scene (Ctrl+R)"))
      context.toggle_recording();
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    draw_icon(icon, (low.x + high.x) / 2, (low.y + high.y) / 2, (high.y - low.y) * 0.27F,
              packed_color(ThemeColor::red));
  }

  // Disabled while a take is recorded or played: only one take is active at a time.
  static void draw_play_take(GuiContext& context) {
    ImGui::BeginDisabled(!context.take_state().name.empty());
    if (ImGui::Button("Play take…")) context.toggle_take_playback();
    ImGui::EndDisabled();
    context.names.add("take.play");
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip("Play the latest take instead of the show, after a confirmation (Ctrl+Shift+R)");
  }

  // The same width in both states, so that nothing moves.
  static void draw_panic(GuiContext& context) {
    const bool on = context.panicked();
    const float width = ImGui::CalcTextSize("PANIC ON").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::PushStyleColor(ImGuiCol_Button, packed_color(on ? ThemeColor::active : ThemeColor::field));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, packed_color(on ? ThemeColor::active : ThemeColor::hover));
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(on ? ThemeColor::on_active : ThemeColor::text));
    if (ImGui::Button(on ? "PANIC ON###panic" : "PANIC###panic", {width, 0})) context.panic();
    ImGui::PopStyleColor(3);
    context.names.add("transport.panic");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(on ? "Resume from the last good state (Ctrl+.)"
                           : "Stop all motion; press again to resume (Ctrl+.)");
  }

  bool panicked_ = false;
};

[[maybe_unused]] const bool kTransportPanel = register_panel_type<TransportPanel>(
    {.name = "transport", .title = "", .wide_slot = PanelSlot::top, .compact_slot = PanelSlot::top, .order = 0});

}  // namespace
}  // namespace limber::panel
