// Status, at the right end of the top bar: pictures a second, who is there, lamps of what comes in, goes out, and errs.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "gui/icons.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr double kLampStays = 0.25;  // s

class StatusPanel : public Panel {
 public:
  void hear(Desk& desk) override {
    const auto count = [&](const std::atomic<std::uint64_t>& counter, std::uint64_t& last, double& until) {
      const std::uint64_t now = counter.load(std::memory_order_relaxed);
      if (now != last) until = desk.clock + kLampStays;
      last = now;
    };
    count(desk.link.counters.received, received_, in_until_);
    count(desk.link.counters.sent, sent_, out_until_);
    pictures_++;
    if (desk.clock - since_ < 1) return;
    rate_ = pictures_ / (desk.clock - since_);
    since_ = desk.clock;
    pictures_ = 0;
  }

  void draw(Desk& desk) override {
    const auto s = static_cast<float>(desk.scale);
    const bool wide = ImGui::GetWindowWidth() > 1500 * s;
    const bool compact = ImGui::GetWindowWidth() < static_cast<float>(kCompactBelow) * s * 0.95F;
    std::string text = fmt::format("{:3.0f} fps", rate_);
    if (wide && desk.now->roster != nullptr) {
      std::size_t parts = 0;
      for (const RosterBody& body : desk.now->roster->bodies) parts += body.parts.size();
      text += fmt::format("   {} bodies   {} parts", desk.now->roster->bodies.size(), parts);
    }
    const float lamp = ImGui::GetFontSize() * 0.9F;
    const bool words = wide || compact;
    const char* const names[] = {"IN", "OUT", "LUA"};
    float width = ImGui::CalcTextSize(text.c_str()).x;
    const std::vector<HealthEntry> losses = desk.link.health.entries();
    const std::string lost = losses.empty() ? "" : fmt::format("{}", losses.size());
    if (!losses.empty()) width += lamp + ImGui::CalcTextSize(lost.c_str()).x + 12 * s;
    for (const char* const name : names) width += lamp + (words ? ImGui::CalcTextSize(name).x : 0) + 6 * s;
    // in a compact window beside the transport, in the first of its two rows
    if (compact) ImGui::SetCursorPos({0, ImGui::GetStyle().WindowPadding.y});
    if (!compact) ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowWidth() - width - 14 * s));
    ImGui::AlignTextToFramePadding();
    if (!losses.empty()) {
      health(desk, losses, lost, lamp);
      ImGui::SameLine(0, 12 * s);
    }
    ImGui::TextUnformatted(text.c_str());
    desk.names.note("status.text");
    const Tone tones[] = {desk.clock < in_until_ ? Tone::blue : Tone::line,
                          desk.clock < out_until_ ? Tone::green : Tone::line,
                          desk.errors > 0 ? Tone::red : Tone::green};
    const std::string tips[] = {
        fmt::format("OSC in: {} messages", received_), fmt::format("OSC out: {} datagrams", sent_),
        desk.errors > 0 ? fmt::format("scripts: {} errors stand, see Errors", desk.errors) : "scripts: all is well"};
    for (std::size_t i = 0; i < 3; i++) {
      ImGui::SameLine(0, 6 * s);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float high = ImGui::GetFrameHeight();
      // errors are a square, so that colour is not all that tells
      const ImVec2 middle{at.x + lamp / 2, at.y + high / 2};
      ImDrawList& list = *ImGui::GetWindowDrawList();
      const float half = lamp * 0.28F;
      if (i == 2 && desk.errors > 0) {
        list.AddRectFilled({middle.x - half * 1.2F, middle.y - half * 1.2F},
                           {middle.x + half * 1.2F, middle.y + half * 1.2F}, packed(tones[i]));
      } else {
        list.AddCircleFilled(middle, half, packed(tones[i]), 16);
      }
      ImGui::Dummy({lamp + (words ? ImGui::CalcTextSize(names[i]).x : 0), high});
      desk.names.note(fmt::format("status.{}", names[i]));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tips[i].c_str());
      if (words) list.AddText({at.x + lamp, at.y + ImGui::GetStyle().FramePadding.y}, packed(Tone::dim), names[i]);
    }
  }

 private:
  // a triangle and how many kinds of losses there are; a click copies all of them
  static void health(Desk& desk, const std::vector<HealthEntry>& losses, const std::string& number, float size) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float high = ImGui::GetFrameHeight();
    if (ImGui::InvisibleButton("##health", {size + ImGui::CalcTextSize(number.c_str()).x, high}))
      desk.copied(desk.link.health.text());
    desk.names.note("status.health");
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      for (const HealthEntry& entry : losses)
        ImGui::Text("%llu  %s (since %s)", static_cast<unsigned long long>(entry.count), entry.doc,
                    time_of_day(entry.since).c_str());
      ImGui::TextDisabled("a click copies this list");
      ImGui::EndTooltip();
    }
    draw_icon(Icon::warning, at.x + size * 0.45F, at.y + high / 2, size * 0.42F, packed(Tone::accent));
    ImGui::GetWindowDrawList()->AddText({at.x + size, at.y + ImGui::GetStyle().FramePadding.y}, packed(Tone::accent),
                                        number.c_str());
  }

  std::uint64_t received_ = 0, sent_ = 0;
  double in_until_ = 0, out_until_ = 0;
  int pictures_ = 0;
  double since_ = 0;
  double rate_ = 0;
};

[[maybe_unused]] const bool kStatusPanel =
    panel<StatusPanel>({.name = "status", .title = "", .wide = Slot::top, .compact = Slot::top, .order = 2});

}  // namespace
}  // namespace limber
