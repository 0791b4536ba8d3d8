// Performance: what ticks take beside what they may take, phase by phase, and what was lost.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <imgui.h>

#include "gui/panel.h"
#include "gui/samples.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kGraphTicks = 240;  // ticks in the graph
constexpr double kGraphSmooth = 0.05;     // of a new tick in the means
constexpr double kGraphRenew = 0.25;      // s between numbers, so that they can be read

struct Phase {
  const char* name;
  double PhaseTimes::*time;
};
constexpr std::array kPhases = {
    Phase{"commands", &PhaseTimes::commands},    Phase{"scripts", &PhaseTimes::scripts},
    Phase{"behaviours", &PhaseTimes::behaviors}, Phase{"effects", &PhaseTimes::effects},
    Phase{"physics", &PhaseTimes::physics},      Phase{"readouts", &PhaseTimes::readouts},
    Phase{"snapshot", &PhaseTimes::snapshot},    Phase{"collector", &PhaseTimes::collector}};

class PerformancePanel : public Panel {
 public:
  void hear(Desk& desk) override {
    if (desk.now == nullptr || desk.now == last_) return;
    const bool ticked = last_ == nullptr || desk.now->tick != last_->tick;
    last_ = desk.now;
    if (!ticked) return;
    const double total = last_->times.total() * 1e3;
    const bool first = ticks_.empty();
    ticks_.add(last_->tick, {total});
    most_ = std::max(most_, total);
    const auto blend = [&](double& mean, double value) { mean = first ? value : mean + kGraphSmooth * (value - mean); };
    blend(tick_, total);
    for (std::size_t i = 0; i < kPhases.size(); i++) blend(means_[i], last_->times.*kPhases[i].time * 1e3);
  }

  void draw(Desk& desk) override {
    const double budget =
        desk.number("/physics/sim/timestep", 1.0 / 60) / std::max(desk.number("/physics/sim/speed", 1), 0.01) * 1e3;
    if (desk.clock - renewed_ > kGraphRenew) {
      renewed_ = desk.clock;
      shown_ = {fmt::format("{:.2f} ms", tick_), fmt::format("{:.2f} ms", most_), fmt::format("{:.1f} ms", budget),
                fmt::format("{:.2f} \u00d7", desk.now->speed)};
      for (std::size_t i = 0; i < kPhases.size(); i++) shown_phases_[i] = fmt::format("{:.2f} ms", means_[i]);
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, ImGui::GetFontSize() * 0.12F});
    const float lines = ImGui::GetTextLineHeightWithSpacing() * 7.2F;
    const float height = std::max(ImGui::GetContentRegionAvail().y - lines, ImGui::GetFontSize() * 1.6F);
    graph(desk, height, budget);
    const bool seen = ImGui::BeginChild("##numbers", {}, false, ImGuiWindowFlags_NavFlattened);
    if (seen) numbers(desk);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }

 private:
  void numbers(Desk& desk) const {
    const std::uint64_t lost = desk.link.counters.dropped.load() + desk.link.counters.dropped_kernel.load();
    pair(desk, "tick", shown_[0], "most", shown_[1]);
    pair(desk, "may take", shown_[2], "reached", shown_[3]);
    for (std::size_t i = 0; i + 1 < kPhases.size(); i += 2)
      pair(desk, kPhases[i].name, shown_phases_[i], kPhases[i + 1].name, shown_phases_[i + 1]);
    pair(desk, "lost in", fmt::format("{}", lost), "inbox", fmt::format("{}", desk.link.inbox.dropped()));
  }

  void graph(Desk& desk, float height, double budget) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::InvisibleButton("##graph", {width, height})) most_ = 0;
    desk.names.note("performance.graph");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("ms of the last %d ticks; the line: what a tick may take; a click forgets the most",
                        static_cast<int>(kGraphTicks));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + width, from.y + height};
    list.AddRectFilled(from, to, packed(Tone::field), ImGui::GetStyle().FrameRounding);
    const std::size_t count = ticks_.size();
    const auto taken = [&](std::size_t i) { return static_cast<float>(ticks_[i][0]); };
    float high = static_cast<float>(budget) * 0.25F;
    for (std::size_t i = 0; i < count; i++) high = std::max(high, taken(i));
    const float top = std::max(high * 1.2F, 1e-6F);
    const auto y = [&](float v) { return to.y - std::min(v / top, 1.0F) * height; };
    list.PushClipRect(from, to, true);
    if (budget < static_cast<double>(top))
      list.AddLine({from.x, y(static_cast<float>(budget))}, {to.x, y(static_cast<float>(budget))}, packed(Tone::red));
    ImVec2 points[kGraphTicks];
    for (std::size_t i = 0; i < count; i++) {
      points[i] = {from.x + width * static_cast<float>(i) / static_cast<float>(kGraphTicks - 1), y(taken(i))};
    }
    list.AddPolyline(points, static_cast<int>(count), packed(Tone::accent), 0, 1.4F);
    list.PopClipRect();
  }

  static void pair(Desk& desk, const char* name, const std::string& value, const char* other,
                   const std::string& second) {
    const float half = ImGui::GetWindowWidth() / 2;
    const float name_width = half * 0.5F;
    const auto one = [&](const char* what, const std::string& text, float x) {
      ImGui::SameLine(x + 1);
      ImGui::TextDisabled("%s", what);
      ImGui::SameLine(x + name_width);
      ImGui::PushFont(desk.fonts.code);
      ImGui::TextUnformatted(text.c_str());
      ImGui::PopFont();
    };
    ImGui::Dummy({0, ImGui::GetTextLineHeight()});
    one(name, value, 0);
    one(other, second, half);
  }

  std::shared_ptr<const Snapshot> last_;
  Samples ticks_{kGraphTicks};
  double tick_ = 0;
  double most_ = 0;
  std::array<double, kPhases.size()> means_{};
  double renewed_ = -1;
  std::array<std::string, 4> shown_;
  std::array<std::string, kPhases.size()> shown_phases_;
};

[[maybe_unused]] const bool kPerformancePanel = panel<PerformancePanel>(
    {.name = "performance", .title = "Performance", .wide = Slot::below_right, .compact = Slot::below, .order = 3});

}  // namespace
}  // namespace limber
