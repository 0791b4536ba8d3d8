// Status, at the right end of the top bar: frame rate, number of bodies, lamps for incoming and outgoing messages and
// errors.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"

namespace limber {

namespace {

constexpr double kLampDuration = 0.25;  // s

class StatusPanel : public Panel {
 public:
  void update(PanelContext& context) override {
    const auto count = [&](const std::atomic<std::uint64_t>& counter, std::uint64_t& last, double& end) {
      const std::uint64_t now = counter.load(std::memory_order_relaxed);
      if (now != last) end = context.clock + kLampDuration;
      last = now;
    };
    count(context.link.counters.received, received_, in_until_);
    count(context.link.counters.sent, sent_, out_until_);
    frames_++;
    if (context.clock - frames_since_ < 1) return;
    frame_rate_ = frames_ / (context.clock - frames_since_);
    frames_since_ = context.clock;
    frames_ = 0;
  }

  void draw(PanelContext& context) override {
    const auto s = static_cast<float>(context.scale);
    const bool wide = ImGui::GetWindowWidth() > 1500 * s;
    const bool compact = ImGui::GetWindowWidth() < static_cast<float>(kCompactBelow) * s * 0.95F;
    std::string text = fmt::format("{:3.0f} fps", frame_rate_);
    if (wide && context.snapshot->body_list != nullptr) {
      std::size_t parts = 0;
      for (const BodyEntry& body : context.snapshot->body_list->bodies) parts += body.part_offsets.size();
      text += fmt::format("   {} bodies   {} parts", context.snapshot->body_list->bodies.size(), parts);
    }
    const float lamp = ImGui::GetFontSize() * 0.9F;
    const bool show_names = wide || compact;
    const char* const names[] = {"IN", "OUT", "LUA"};
    float width = ImGui::CalcTextSize(text.c_str()).x;
    const std::vector<HealthEntry> losses = context.link.health.entries();
    const std::string lost = losses.empty() ? "" : fmt::format("{}", losses.size());
    if (!losses.empty()) width += lamp + ImGui::CalcTextSize(lost.c_str()).x + 12 * s;
    for (const char* const name : names) width += lamp + (show_names ? ImGui::CalcTextSize(name).x : 0) + 6 * s;
    // in a compact window beside the transport controls, in the first of two rows
    if (compact) ImGui::SetCursorPos({0, ImGui::GetStyle().WindowPadding.y});
    if (!compact) ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowWidth() - width - 14 * s));
    ImGui::AlignTextToFramePadding();
    if (!losses.empty()) {
      draw_losses(context, losses, lost, lamp);
      ImGui::SameLine(0, 12 * s);
    }
    ImGui::TextUnformatted(text.c_str());
    context.names.add("status.text");
    const Tone tones[] = {context.clock < in_until_ ? Tone::blue : Tone::line,
                          context.clock < out_until_ ? Tone::green : Tone::line,
                          context.errors > 0 ? Tone::red : Tone::green};
    const std::string tips[] = {
        fmt::format("OSC in: {} messages", received_), fmt::format("OSC out: {} datagrams", sent_),
        context.errors > 0 ? fmt::format("Scripts: {} errors, see Errors", context.errors) : "Scripts: no errors"};
    for (std::size_t i = 0; i < 3; i++) {
      ImGui::SameLine(0, 6 * s);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float high = ImGui::GetFrameHeight();
      // errors are shown as a square, so that color is not the only cue
      const ImVec2 center{at.x + lamp / 2, at.y + high / 2};
      ImDrawList& list = *ImGui::GetWindowDrawList();
      const float half = lamp * 0.28F;
      if (i == 2 && context.errors > 0) {
        list.AddRectFilled({center.x - half * 1.2F, center.y - half * 1.2F},
                           {center.x + half * 1.2F, center.y + half * 1.2F}, packed_color(tones[i]));
      } else {
        list.AddCircleFilled(center, half, packed_color(tones[i]), 16);
      }
      ImGui::Dummy({lamp + (show_names ? ImGui::CalcTextSize(names[i]).x : 0), high});
      context.names.add(fmt::format("status.{}", names[i]));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tips[i].c_str());
      if (show_names)
        list.AddText({at.x + lamp, at.y + ImGui::GetStyle().FramePadding.y}, packed_color(Tone::secondary), names[i]);
    }
  }

 private:
  // A warning sign and the number of kinds of losses; a click copies the list.
  static void draw_losses(PanelContext& context, const std::vector<HealthEntry>& losses, const std::string& number,
                          float size) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float high = ImGui::GetFrameHeight();
    if (ImGui::InvisibleButton("##health", {size + ImGui::CalcTextSize(number.c_str()).x, high}))
      context.copy_with_notice(context.link.health.text());
    context.names.add("status.health");
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      for (const HealthEntry& entry : losses)
        ImGui::Text("%llu  %s (since %s)", static_cast<unsigned long long>(entry.count), entry.doc,
                    time_of_day(entry.since).c_str());
      ImGui::TextDisabled("Click to copy this list");
      ImGui::EndTooltip();
    }
    draw_icon(Icon::warning, at.x + size * 0.45F, at.y + high / 2, size * 0.42F, packed_color(Tone::accent));
    ImGui::GetWindowDrawList()->AddText({at.x + size, at.y + ImGui::GetStyle().FramePadding.y},
                                        packed_color(Tone::accent), number.c_str());
  }

  std::uint64_t received_ = 0, sent_ = 0;
  double in_until_ = 0, out_until_ = 0;
  int frames_ = 0;
  double frames_since_ = 0;
  double frame_rate_ = 0;
};

[[maybe_unused]] const bool kStatusPanel = register_panel_type<StatusPanel>(
    {.name = "status", .title = "", .wide_slot = PanelSlot::top, .compact_slot = PanelSlot::top, .order = 2});

}  // namespace
}  // namespace limber
