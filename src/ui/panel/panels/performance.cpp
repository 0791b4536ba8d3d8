// Performance: the time of a tick and its budget, its phases, and lost messages.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/samples.h"

namespace limber::panel {

namespace {

constexpr std::size_t kGraphTicks = 240;       // number of ticks in the graph
constexpr double kGraphSmoothing = 0.05;       // weight of a new tick in the averages
constexpr double kGraphUpdateInterval = 0.25;  // s between updates of the numbers, so that they are readable

struct Phase {
  const char* name;
  double engine::PhaseTimes::*time;
};
constexpr std::array kPhases = {
    Phase{"Commands", &engine::PhaseTimes::commands},   Phase{"Scripts", &engine::PhaseTimes::scripts},
    Phase{"Behaviors", &engine::PhaseTimes::behaviors}, Phase{"Callbacks", &engine::PhaseTimes::callbacks},
    Phase{"Physics", &engine::PhaseTimes::physics},     Phase{"Readouts", &engine::PhaseTimes::readouts},
    Phase{"Snapshot", &engine::PhaseTimes::snapshot},   Phase{"GC", &engine::PhaseTimes::gc}};

class PerformancePanel : public Panel {
 public:
  void update(GuiContext& context) override {
    if (context.snapshot == nullptr || context.snapshot == last_) return;
    const bool ticked = last_ == nullptr || context.snapshot->tick != last_->tick;
    last_ = context.snapshot;
    if (!ticked) return;
    const double total = last_->times.total() * 1e3;
    const bool first = ticks_.empty();
    ticks_.add(last_->tick, {total});
    max_ = std::max(max_, total);
    const auto blend = [&](double& mean, double value) {
      mean = first ? value : mean + kGraphSmoothing * (value - mean);
    };
    blend(mean_tick_, total);
    for (std::size_t i = 0; i < kPhases.size(); i++) blend(means_[i], last_->times.*kPhases[i].time * 1e3);
  }

  void draw(GuiContext& context) override {
    const double budget = context.number("/physics/sim/timestep", 1.0 / 60) /
                          std::max(context.number("/physics/sim/speed", 1), 0.01) * 1e3;
    if (context.clock - updated_at_ > kGraphUpdateInterval) {
      updated_at_ = context.clock;
      shown_ = {fmt::format("{:.2f} ms", mean_tick_), fmt::format("{:.2f} ms", max_), fmt::format("{:.1f} ms", budget),
                fmt::format("{:.2f} \u00d7", context.snapshot->speed)};
      for (std::size_t i = 0; i < kPhases.size(); i++) shown_phases_[i] = fmt::format("{:.2f} ms", means_[i]);
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, ImGui::GetFontSize() * 0.12F});
    const float lines = ImGui::GetTextLineHeightWithSpacing() * 7.2F;
    const float height = std::max(ImGui::GetContentRegionAvail().y - lines, ImGui::GetFontSize() * 1.6F);
    graph(context, height, budget);
    const bool visible = ImGui::BeginChild("##numbers", {}, false, ImGuiWindowFlags_NavFlattened);
    if (visible) numbers(context);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }

 private:
  void numbers(GuiContext& context) const {
    const std::uint64_t lost = context.link.counters.dropped.load() + context.link.counters.dropped_kernel.load();
    pair(context, "Tick", shown_[0], "Max", shown_[1]);
    pair(context, "Budget", shown_[2], "Speed", shown_[3]);
    for (std::size_t i = 0; i + 1 < kPhases.size(); i += 2)
      pair(context, kPhases[i].name, shown_phases_[i], kPhases[i + 1].name, shown_phases_[i + 1]);
    pair(context, "Dropped", fmt::format("{}", lost), "Queue", fmt::format("{}", context.link.command_queue.dropped()));
  }

  void graph(GuiContext& context, float height, double budget) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::InvisibleButton("##graph", {width, height})) max_ = 0;
    context.names.add("performance.graph");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Time of the last %d ticks in ms; the red line is the budget; click to reset the maximum",
                        static_cast<int>(kGraphTicks));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + width, from.y + height};
    list.AddRectFilled(from, to, packed_color(ThemeColor::field), ImGui::GetStyle().FrameRounding);
    const std::size_t count = ticks_.size();
    const auto tick_time = [&](std::size_t i) { return static_cast<float>(ticks_[i][0]); };
    float high = static_cast<float>(budget) * 0.25F;
    for (std::size_t i = 0; i < count; i++) high = std::max(high, tick_time(i));
    const float top = std::max(high * 1.2F, 1e-6F);
    const auto y = [&](float v) { return to.y - std::min(v / top, 1.0F) * height; };
    list.PushClipRect(from, to, true);
    if (budget < static_cast<double>(top))
      list.AddLine({from.x, y(static_cast<float>(budget))}, {to.x, y(static_cast<float>(budget))},
                   packed_color(ThemeColor::red));
    ImVec2 points[kGraphTicks];
    for (std::size_t i = 0; i < count; i++) {
      points[i] = {from.x + width * static_cast<float>(i) / static_cast<float>(kGraphTicks - 1), y(tick_time(i))};
    }
    list.AddPolyline(points, static_cast<int>(count), packed_color(ThemeColor::accent), 0, 1.4F);
    list.PopClipRect();
  }

  static void pair(GuiContext& context, const char* name, const std::string& value, const char* other,
                   const std::string& second) {
    const float half = ImGui::GetWindowWidth() / 2;
    const float name_width = half * 0.5F;
    const auto draw = [&](const char* label, const std::string& text, float x) {
      ImGui::SameLine(x + 1);
      ImGui::TextDisabled("%s", label);
      ImGui::SameLine(x + name_width);
      ImGui::PushFont(context.fonts.code);
      ImGui::TextUnformatted(text.c_str());
      ImGui::PopFont();
    };
    ImGui::Dummy({0, ImGui::GetTextLineHeight()});
    draw(name, value, 0);
    draw(other, second, half);
  }

  std::shared_ptr<const engine::Snapshot> last_;
  Samples ticks_{kGraphTicks};
  double mean_tick_ = 0;
  double max_ = 0;
  std::array<double, kPhases.size()> means_{};
  double updated_at_ = -1;
  std::array<std::string, 4> shown_;
  std::array<std::string, kPhases.size()> shown_phases_;
};

[[maybe_unused]] const bool kPerformancePanel =
    register_panel_type<PerformancePanel>({.name = "performance",
                                           .title = "Performance",
                                           .wide_slot = PanelSlot::bottom_right,
                                           .compact_slot = PanelSlot::bottom,
                                           .order = 3});

}  // namespace
}  // namespace limber::panel
