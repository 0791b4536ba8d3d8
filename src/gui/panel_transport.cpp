// Transport: back to the start, a tick back, play or pause, a tick on; record; panic; simulated time.
#include <imgui.h>

#include "gui/clock_text.h"
#include "gui/icons.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

class TransportPanel : public Panel {
 public:
  void hear(Desk& desk) override {
    if (desk.image == nullptr) return;
    const bool panicked = desk.panicked();
    if (panicked != panicked_) desk.say(panicked ? "panic: everything comes to rest" : "the panic is over");
    panicked_ = panicked;
  }

  void draw(Desk& desk) override {
    const bool paused = desk.now->paused;
    if (icon_button(desk.names, "transport.reset", Icon::back, "the scene from its start (Ctrl+Backspace)"))
      desk.send("/transport/reset");
    ImGui::SameLine();
    if (icon_button(desk.names, "transport.step_back", Icon::step_back, "one tick back (,)")) desk.step_time(-1);
    ImGui::SameLine();
    if (icon_button(desk.names, "transport.play", paused ? Icon::play : Icon::pause, "play, pause (Space)", paused))
      desk.send(paused ? "/transport/play" : "/transport/pause");
    ImGui::SameLine();
    if (icon_button(desk.names, "transport.step", Icon::step, "one tick (.)")) desk.step_time(1);
    ImGui::SameLine();
    record(desk);
    ImGui::SameLine();
    panic(desk);
    ImGui::SameLine();
    ImGui::PushFont(desk.fonts.code);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock_text(desk.now->time).c_str());
    desk.names.note("transport.time");
    ImGui::PopFont();
  }

 private:
  // a circle, and a square while it records: colour is not all that tells
  static void record(Desk& desk) {
    const bool on = desk.take().recorded();
    const Icon icon = on ? Icon::stop : Icon::record;
    if (icon_button(desk.names, "transport.record", icon,
                    on ? "the take ends (Ctrl+R)" : "record a take, from the scene's start (Ctrl+R)"))
      desk.record();
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    draw_icon(icon, (low.x + high.x) / 2, (low.y + high.y) / 2, (high.y - low.y) * 0.27F, packed(Tone::red));
  }

  // as wide on as off, so that nothing moves
  static void panic(Desk& desk) {
    const bool on = desk.panicked();
    const float width = ImGui::CalcTextSize("PANIC ON").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::PushStyleColor(ImGuiCol_Button, packed(on ? Tone::lit : Tone::field));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, packed(on ? Tone::lit : Tone::hover));
    ImGui::PushStyleColor(ImGuiCol_Text, packed(on ? Tone::ink : Tone::text));
    if (ImGui::Button(on ? "PANIC ON###panic" : "PANIC###panic", {width, 0})) desk.panic();
    ImGui::PopStyleColor(3);
    desk.names.note("transport.panic");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(on ? "the show goes on from the newest good moment before (Ctrl+.)"
                           : "everything comes to rest; once more: the show goes on (Ctrl+.)");
  }

  bool panicked_ = false;
};

[[maybe_unused]] const bool kTransportPanel =
    panel<TransportPanel>({.name = "transport", .title = "", .wide = Slot::top, .compact = Slot::top, .order = 0});

}  // namespace
}  // namespace limber
