// Plots: values over time, of properties that were added by their context menu.
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/samples.h"

namespace limber::panel {

namespace {

constexpr std::size_t kPlotSamples = 300;
constexpr std::size_t kMaxComponents = 3;  // maximum number of components of a property
constexpr std::array kPlotColors = {ThemeColor::red, ThemeColor::green, ThemeColor::blue};

class PlotsPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    return context.plots.empty() ? "" : fmt::format("{}", context.plots.size());
  }

  // Adds a sample for each value snapshot of a new tick.
  void update(GuiContext& context) override {
    if (context.value_snapshot == nullptr || context.value_snapshot->snapshot->tick == last_tick_) return;
    last_tick_ = context.value_snapshot->snapshot->tick;
    std::erase_if(series_, [&](const auto& s) {
      return std::find(context.plots.begin(), context.plots.end(), s.first) == context.plots.end();
    });
    for (const std::string& path : context.plots) {
      const auto handle = context.find(path);
      PendingValues::Values values{};
      if (!handle || !context.values(*handle, values)) continue;
      Series& series = series_[path];
      series.width = std::min<std::size_t>(handle->ref.property->width, kMaxComponents);
      series.unit = handle->ref.property->unit;
      series.samples.add(last_tick_, values);
    }
  }

  void draw(GuiContext& context) override {
    if (context.plots.empty()) return ImGui::TextDisabled("Right click a value and select Plot");
    if (!ImGui::BeginChild("##plots", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    std::string closed;
    for (const std::string& path : context.plots) {
      if (!plot(context, path)) closed = path;
    }
    std::erase(context.plots, closed);
    ImGui::EndChild();
  }

 private:
  struct Series {
    std::size_t width = 1;
    std::string unit;
    Samples samples{kPlotSamples};
  };

  // Returns false if the plot was closed.
  bool plot(GuiContext& context, const std::string& path) {
    const Series& series = series_[path];
    ImGui::PushID(path.c_str());
    const bool closed = icon_button(context.names, ("unplot:" + path).c_str(), Icon::close, "Remove the plot");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    std::string numbers;
    if (!series.samples.empty()) {
      for (std::size_t i = 0; i < series.width; i++)
        numbers += "  " + number_label(series.samples[series.samples.size() - 1][i]);
      numbers += " " + series.unit;
    }
    const float space = ImGui::GetContentRegionAvail().x;
    ImGui::TextUnformatted((elided(path, space - text_width(numbers), text_width) + numbers).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    graph(series, ImGui::GetFontSize() * 3.4F);
    context.names.add("plot:" + path);
    ImGui::PopID();
    return !closed;
  }

  static void graph(const Series& series, float height) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::Dummy({width, height});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + width, from.y + height};
    list.AddRectFilled(from, to, packed_color(ThemeColor::field), ImGui::GetStyle().FrameRounding);
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
                       packed_color(series.width == 1 ? ThemeColor::accent : kPlotColors[i]), 0, 1.4F);
    }
    list.AddText({from.x + 4, from.y + 1}, packed_color(ThemeColor::secondary), number_label(high).c_str());
    list.AddText({from.x + 4, to.y - ImGui::GetFontSize() - 2}, packed_color(ThemeColor::secondary),
                 number_label(low).c_str());
  }

  std::map<std::string, Series> series_;
  std::uint64_t last_tick_ = ~std::uint64_t{0};
};

[[maybe_unused]] const bool kPlotsPanel = register_panel_type<PlotsPanel>({.name = "plots",
                                                                           .title = "Plots",
                                                                           .wide_slot = PanelSlot::bottom_right,
                                                                           .compact_slot = PanelSlot::bottom,
                                                                           .order = 4});

}  // namespace
}  // namespace limber::panel
