// Performance: the time of a tick and its budget, its phases, and lost messages.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/number_format.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/samples.h"

namespace limber::panel {

namespace {

constexpr std::size_t kGraphTicks = 240;       // number of ticks in the graph
constexpr double kGraphSmoothing = 0.05;       // weight of a new tick in the averages
constexpr double kGraphUpdateInterval = 0.25;  // s between updates of the numbers, so that they are readable

struct Phase {
  const char* name;
  double engine::PhaseTimes::*time;
  const char* hint;
};
constexpr std::array kPhases = {
    Phase{"Commands", &engine::PhaseTimes::commands, "Messages from OSC, the panel and consoles, and preset morphs."},
    Phase{"Scripts", &engine::PhaseTimes::scripts, "Timers, contact callbacks and on_step of the scene."},
    Phase{"Behaviors", &engine::PhaseTimes::behaviors, "All active behaviors. The list of behaviors shows each time."},
    Phase{"Callbacks", &engine::PhaseTimes::callbacks, "On-change callbacks: values that were set are passed on."},
    Phase{"Physics", &engine::PhaseTimes::physics,
          "Collisions, joints and motion. Usually the largest part; it grows with bodies, contacts and substeps."},
    Phase{"Readouts", &engine::PhaseTimes::readouts, "Forces, contacts and other computed values."},
    Phase{"Snapshot", &engine::PhaseTimes::snapshot, "Copy of the state for the view, the panel and OSC."},
    Phase{"GC", &engine::PhaseTimes::gc, "Garbage collection of the scene's Lua memory."}};

constexpr const char* kMeanHint = "Milliseconds per tick, averaged over about the last 20 ticks.";

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
      shown_ = {mean_tick_, max_, budget, context.snapshot->speed};
      shown_phases_ = means_;
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
    figure(context, 0, {"Tick", fmt::format("Computing time of a tick. {} Normal: below the budget.", kMeanHint)},
           shown_[0]);
    figure(context, 1,
           {"Max",
            "The slowest tick since the last click on the graph, in milliseconds. A single one above the budget delays "
            "the show by its excess; the first ticks of a scene are slow."},
           shown_[1]);
    figure(context, 0,
           {"Budget",
            "Milliseconds of real time per tick: timestep / speed. Slower ticks make the simulation lag (Speed)."},
           shown_[2]);
    figure(context, 1,
           {"Speed",
            "Simulated seconds per real second. Normal: the speed that is set, 1 by default; less if ticks take longer "
            "than the budget.",
            " \u00d7"},
           shown_[3]);
    for (std::size_t i = 0; i < kPhases.size(); i++)
      figure(context, i % 2, {kPhases[i].name, fmt::format("{} {}", kPhases[i].hint, kMeanHint)}, shown_phases_[i]);
    figure(
        context, 0,
        {"Dropped", "OSC datagrams that were lost because they arrived faster than they were read. Normal: 0.", "", 0},
        static_cast<double>(lost));
    figure(context, 1,
           {"Queue", "Messages that were dropped because the queue of the simulation was full. Normal: 0.", "", 0},
           static_cast<double>(context.link.command_queue.dropped()));
  }

  void graph(GuiContext& context, float height, double budget) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::InvisibleButton("##graph", {width, height})) max_ = 0;
    context.names.add("performance.graph");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Computing time of the last %d ticks; the red line is the budget; click to reset the maximum",
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

  struct Label {
    const char* name;
    std::string hint;
    const char* unit = " ms";
    int decimals = 2;
  };

  // Draws a name and a value in the left (0) or right (1) column.
  static void figure(GuiContext& context, std::size_t column, const Label& label, double value) {
    const float half = std::floor(ImGui::GetContentRegionAvail().x / 2);
    if (column > 0) ImGui::SameLine(half);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = (column > 0 ? ImGui::GetContentRegionAvail().x : half) - 1;
    ImGui::Dummy({width, std::max(ImGui::GetTextLineHeight(), imgui::font_height(*context.fonts.code))});
    context.names.add(fmt::format("performance.{}", label.name));
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
      ImGui::TextUnformatted(label.hint.c_str());
      ImGui::PopTextWrapPos();
      ImGui::EndTooltip();
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText(at, packed_color(ThemeColor::secondary), label.name);
    const float x = ImGui::GetFontSize() * 5.2F;
    ImGui::PushFont(context.fonts.code);
    const float space = width - x - text_width(label.unit);
    const NumberFormat format{.integer = label.decimals == 0, .decimals = label.decimals == 0 ? -1 : label.decimals};
    const std::string text = fitted_number(value, format, space, text_width) + label.unit;
    list.AddText({at.x + x, at.y - ImGui::GetFontSize() / 16}, packed_color(ThemeColor::text), text.c_str());
    ImGui::PopFont();
  }

  std::shared_ptr<const engine::Snapshot> last_;
  Samples ticks_{kGraphTicks};
  double mean_tick_ = 0;
  double max_ = 0;
  std::array<double, kPhases.size()> means_{};
  double updated_at_ = -1;
  std::array<double, 4> shown_{};
  std::array<double, kPhases.size()> shown_phases_{};
};

[[maybe_unused]] const bool kPerformancePanel =
    register_panel_type<PerformancePanel>({.name = "performance",
                                           .title = "Performance",
                                           .wide_slot = PanelSlot::bottom_right,
                                           .compact_slot = PanelSlot::bottom,
                                           .order = 3});

}  // namespace
}  // namespace limber::panel
