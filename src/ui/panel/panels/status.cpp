// Status, at the right end of the top bar: frame rate, number of bodies, indicators for incoming and outgoing messages
// and errors.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "base/plural.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/number_format.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"

namespace limber::panel {

namespace {

constexpr double kLampDuration = 0.25;  // s

class StatusPanel : public Panel {
 public:
  void update(GuiContext& context) override {
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

  void draw(GuiContext& context) override {
    const auto s = static_cast<float>(context.scale);
    const bool wide = ImGui::GetWindowWidth() > 1500 * s;
    const bool compact = ImGui::GetWindowWidth() < static_cast<float>(kCompactBelow) * s * 0.95F;
    std::string text = number_label(frame_rate_, {.decimals = 0}) + " fps";
    if (wide) text += counts_text(*context.snapshot);
    const float indicator = ImGui::GetFontSize() * 0.9F;
    float width = ImGui::CalcTextSize(text.c_str()).x;
    const std::vector<engine::HealthEntry> losses = context.link.health.entries();
    const std::string lost = losses.empty() ? "" : fmt::format("{}", losses.size());
    if (!losses.empty()) width += indicator + ImGui::CalcTextSize(lost.c_str()).x + 12 * s;
    for (const char* const name : kNames) width += indicator + ImGui::CalcTextSize(name).x + 6 * s;
    if (compact) {
      // beside the transport controls, in the first of two rows
      ImGui::SetCursorPos({0, ImGui::GetStyle().WindowPadding.y});
    } else {
      ImGui::SameLine();
    }
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowWidth() - width - 14 * s));
    ImGui::AlignTextToFramePadding();
    if (!losses.empty()) {
      draw_losses(context, losses, lost, indicator);
      ImGui::SameLine(0, 12 * s);
    }
    ImGui::TextUnformatted(text.c_str());
    context.names.add("status.text");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Frames of the window per second (usually 60). World: %s",
                        counts_text(*context.snapshot).c_str());
    for (const Indicator& each : indicators(context)) {
      ImGui::SameLine(0, 6 * s);
      draw_indicator(indicator, each);
      context.names.add(fmt::format("status.{}", each.name));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", each.tip.c_str());
    }
  }

 private:
  static constexpr const char* kNames[] = {"IN", "OUT", "LUA"};
  struct Indicator {
    const char* name;
    ThemeColor color;
    bool square;
    std::string tip;
  };
  std::array<Indicator, 3> indicators(const GuiContext& context) const {
    const bool in = context.clock < in_until_;
    const bool out = context.clock < out_until_;
    const std::uint64_t errors = context.errors;
    // errors are shown as a square, so that color is not the only cue
    return {Indicator{kNames[0], in ? ThemeColor::blue : ThemeColor::line, false,
                      "OSC in: " + counted(received_, "message")},
            Indicator{kNames[1], out ? ThemeColor::green : ThemeColor::line, false,
                      "OSC out: " + counted(sent_, "datagram")},
            errors > 0 ? Indicator{kNames[2], ThemeColor::red, true,
                                   fmt::format("Scripts: {}, see Errors", counted(errors, "error"))}
                       : Indicator{kNames[2], ThemeColor::green, false, "Scripts: no errors"}};
  }
  static std::string counts_text(const engine::Snapshot& snapshot) {
    if (snapshot.body_list == nullptr) return {};
    std::size_t parts = 0;
    for (const engine::BodyEntry& body : snapshot.body_list->bodies) parts += body.part_offsets.size();
    return fmt::format("   {}   {}", counted(snapshot.body_list->bodies.size(), "body", "bodies"),
                       counted(parts, "part"));
  }
  static void draw_indicator(float size, const Indicator& indicator) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float high = ImGui::GetFrameHeight();
    const ImVec2 center{at.x + size / 2, at.y + high / 2};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float half = size * 0.28F;
    if (indicator.square) {
      list.AddRectFilled({center.x - half * 1.2F, center.y - half * 1.2F},
                         {center.x + half * 1.2F, center.y + half * 1.2F}, packed_color(indicator.color));
    } else {
      list.AddCircleFilled(center, half, packed_color(indicator.color), 16);
    }
    ImGui::Dummy({size + ImGui::CalcTextSize(indicator.name).x, high});
    list.AddText({at.x + size, at.y + ImGui::GetStyle().FramePadding.y}, packed_color(ThemeColor::secondary),
                 indicator.name);
  }
  // A warning sign and the number of kinds of losses; a click copies the list.
  static void draw_losses(GuiContext& context, const std::vector<engine::HealthEntry>& losses,
                          const std::string& number, float size) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float high = ImGui::GetFrameHeight();
    if (ImGui::InvisibleButton("##health", {size + ImGui::CalcTextSize(number.c_str()).x, high}))
      context.copy_with_notice(context.link.health.text());
    context.names.add("status.health");
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      for (const engine::HealthEntry& entry : losses)
        ImGui::Text("%llu  %s (since %s)", static_cast<unsigned long long>(entry.count), entry.doc,
                    engine::time_of_day(entry.since).c_str());
      ImGui::TextDisabled("Click to copy this list");
      ImGui::EndTooltip();
    }
    draw_icon(Icon::warning, at.x + size * 0.45F, at.y + high / 2, size * 0.42F, packed_color(ThemeColor::accent));
    ImGui::GetWindowDrawList()->AddText({at.x + size, at.y + ImGui::GetStyle().FramePadding.y},
                                        packed_color(ThemeColor::accent), number.c_str());
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
}  // namespace limber::panel
