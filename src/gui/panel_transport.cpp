// Transport: back, play or pause, step; simulated time and tick; how fast time runs.
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "gui/icons.h"
#include "gui/panel.h"
#include "gui/property_widget.h"
#include "gui/theme.h"

namespace limber {

namespace {

std::string clock_text(double seconds) {
  seconds += 1e-6;  // ticks add up to a little less
  const auto minutes = static_cast<long>(seconds / 60);
  return fmt::format("{:02}:{:05.2f}", minutes,
                     std::floor((seconds - 60.0 * static_cast<double>(minutes)) * 100) / 100);
}

class TransportPanel : public Panel {
 public:
  void draw(Desk& desk) override {
    const bool paused = desk.now->paused;
    if (icon_button(desk.names, "transport.reset", Icon::back, "the scene from its start (Ctrl+Backspace)"))
      desk.send("/transport/reset");
    ImGui::SameLine();
    if (icon_button(desk.names, "transport.play", paused ? Icon::play : Icon::pause, "play, pause (Space)", paused))
      desk.send(paused ? "/transport/play" : "/transport/pause");
    ImGui::SameLine();
    if (icon_button(desk.names, "transport.step", Icon::step, "one tick (.)")) desk.send("/transport/step");
    ImGui::SameLine();
    ImGui::PushFont(desk.fonts.code);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock_text(desk.now->time).c_str());
    desk.names.note("transport.time");
    ImGui::SameLine();
    ImGui::TextDisabled("tick %-7llu", static_cast<unsigned long long>(desk.now->tick));
    desk.names.note("transport.tick");
    ImGui::PopFont();
    ImGui::SameLine();
    if (const auto speed = desk.find("/physics/sim/speed")) {
      ImGui::PushID("speed");
      property_widget(desk, *speed, static_cast<float>(74 * desk.scale));
      ImGui::PopID();
      ImGui::SameLine();
      ImGui::AlignTextToFramePadding();
      ImGui::TextDisabled("\u00d7 time");
    }
  }
};

[[maybe_unused]] const bool kTransportPanel =
    panel<TransportPanel>({.name = "transport", .title = "", .wide = Slot::top, .compact = Slot::top, .order = 0});

}  // namespace
}  // namespace limber
