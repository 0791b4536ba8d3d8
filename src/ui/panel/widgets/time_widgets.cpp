// The bar is an invisible button with custom drawing.
#include "ui/panel/widgets/time_widgets.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panel/text/number_format.h"
#include "ui/panel/theme.h"

namespace limber::panel {

namespace {

constexpr double kMinRewind = 0.05;  // s; smaller rewinds are treated as canceled

void draw_history(const HistoryRange& range, double dragged_back, bool highlighted) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto at = [&](double back) {
    const double part = range.length > 0 ? std::clamp(back / range.length, 0.0, 1.0) : 0;
    return high.x - (high.x - low.x) * static_cast<float>(part);
  };
  list.AddRectFilled(low, high, packed_color(highlighted ? ThemeColor::hover : ThemeColor::field), style.FrameRounding);
  if (range.rewindable > 0)
    list.AddRectFilled({at(range.rewindable), low.y}, high, packed_color(ThemeColor::fill), style.FrameRounding);
  if (dragged_back > 0) {
    const float mark = std::max(style.GrabMinSize * 0.5F, 1.0F);
    list.AddRectFilled({at(dragged_back) - mark / 2, low.y + 1}, {at(dragged_back) + mark / 2, high.y - 1},
                       packed_color(ThemeColor::accent));
  }
  std::string text = number_label(range.rewindable, {.decimals = 1}) + " s back";
  if (range.length <= 0) text = "No history";
  if (dragged_back > 0) text = "-" + number_label(dragged_back, {.decimals = 1}) + " s";
  ImGui::RenderTextClipped(low, high, text.c_str(), text.c_str() + text.size(), nullptr, {0.5F, 0.5F});
}

}  // namespace

std::string clock_text(double seconds) {
  seconds += 1e-6;  // tolerance, because sums of time steps are slightly too small
  const auto minutes = static_cast<long>(seconds / 60);
  return fmt::format("{:02}:{:05.2f}", minutes,
                     std::floor((seconds - 60.0 * static_cast<double>(minutes)) * 100) / 100);
}

double history_bar(const char* id, const HistoryRange& range, float width, double& dragged_back) {
  ImGui::InvisibleButton(id, {width, ImGui::GetFrameHeight()});
  const bool dragged = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (dragged) {
    const double position = (ImGui::GetItemRectMax().x - ImGui::GetMousePos().x) / width;
    dragged_back = std::clamp(position * range.length, 0.0, std::max(range.rewindable, 0.0));
  }
  double back = 0;
  if (!ImGui::IsItemActive()) back = std::exchange(dragged_back, 0);
  draw_history(range, dragged_back, dragged || ImGui::IsItemHovered());
  return back > kMinRewind ? back : 0;
}

}  // namespace limber::panel
