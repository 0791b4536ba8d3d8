// Plots: values over time, of rows that were chosen by "plot it" in their menu.
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "gui/icons.h"
#include "gui/number_bar.h"
#include "gui/panel.h"
#include "gui/samples.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kPlotSamples = 300;
constexpr std::size_t kMostPlotted = 3;  // numbers of one row
constexpr std::array kPlotTones = {Tone::red, Tone::green, Tone::blue};

class PlotsPanel : public Panel {
 public:
  std::string badge(const Desk& desk) const override {
    return desk.plots.empty() ? "" : fmt::format("{}", desk.plots.size());
  }

  // a sample with each image that says something new
  void hear(Desk& desk) override {
    if (desk.image == nullptr || desk.image->snapshot->tick == tick_) return;
    tick_ = desk.image->snapshot->tick;
    std::erase_if(series_, [&](const auto& s) {
      return std::find(desk.plots.begin(), desk.plots.end(), s.first) == desk.plots.end();
    });
    for (const std::string& path : desk.plots) {
      const auto at = desk.find(path);
      HandValues::Values values{};
      if (!at || !desk.values(*at, values)) continue;
      Series& series = series_[path];
      series.width = std::min<std::size_t>(at->place.row->width, kMostPlotted);
      series.unit = at->place.row->unit;
      series.samples.add(tick_, values);
    }
  }

  void draw(Desk& desk) override {
    if (desk.plots.empty()) return ImGui::TextDisabled("a right click on a value: plot it");
    if (!ImGui::BeginChild("##plots", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    std::string gone;
    for (const std::string& path : desk.plots) {
      if (!plot(desk, path)) gone = path;
    }
    std::erase(desk.plots, gone);
    ImGui::EndChild();
  }

 private:
  struct Series {
    std::size_t width = 1;
    std::string unit;
    Samples samples{kPlotSamples};
  };

  // false: it is to go
  bool plot(Desk& desk, const std::string& path) {
    const Series& series = series_[path];
    ImGui::PushID(path.c_str());
    const bool closed = icon_button(desk.names, ("unplot:" + path).c_str(), Icon::close, "no plot any more");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    std::string words = path;
    if (!series.samples.empty()) {
      for (std::size_t i = 0; i < series.width; i++)
        words += fmt::format("  {}", shown_number(series.samples[series.samples.size() - 1][i], false));
      words += " " + series.unit;
    }
    ImGui::TextUnformatted(words.c_str());
    graph(series, ImGui::GetFontSize() * 3.4F);
    desk.names.note("plot:" + path);
    ImGui::PopID();
    return !closed;
  }

  static void graph(const Series& series, float height) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::Dummy({width, height});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + width, from.y + height};
    list.AddRectFilled(from, to, packed(Tone::field), ImGui::GetStyle().FrameRounding);
    if (series.samples.empty()) return;
    double low = series.samples[0][0];
    double high = low;
    for (std::size_t k = 0; k < series.samples.size(); k++) {
      for (std::size_t i = 0; i < series.width; i++) {
        low = std::min(low, series.samples[k][i]);
        high = std::max(high, series.samples[k][i]);
      }
    }
    const double span = std::max(high - low, 1e-9);
    std::vector<ImVec2> points(series.samples.size());
    for (std::size_t i = 0; i < series.width; i++) {
      for (std::size_t k = 0; k < points.size(); k++) {
        const double y = (series.samples[k][i] - low) / span;
        points[k] = {from.x + width * static_cast<float>(k) / static_cast<float>(kPlotSamples - 1),
                     to.y - 2 - static_cast<float>(y) * (height - 4)};
      }
      list.AddPolyline(points.data(), static_cast<int>(points.size()),
                       packed(series.width == 1 ? Tone::accent : kPlotTones[i]), 0, 1.4F);
    }
    list.AddText({from.x + 4, from.y + 1}, packed(Tone::dim), shown_number(high, false).c_str());
    list.AddText({from.x + 4, to.y - ImGui::GetFontSize() - 2}, packed(Tone::dim), shown_number(low, false).c_str());
  }

  std::map<std::string, Series> series_;
  std::uint64_t tick_ = ~std::uint64_t{0};
};

[[maybe_unused]] const bool kPlotsPanel = panel<PlotsPanel>(
    {.name = "plots", .title = "Plots", .wide = Slot::below_right, .compact = Slot::below, .order = 4});

}  // namespace
}  // namespace limber
