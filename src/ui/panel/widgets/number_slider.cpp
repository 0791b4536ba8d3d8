// Uses the slider behavior of Dear ImGui with custom drawing.
#include "ui/panel/widgets/number_slider.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panel/imgui_versions.h"
#include "ui/panel/theme.h"

namespace limber::panel {

namespace {

constexpr double kMaxLinearSpan = 200;    // wider ranges get a nonlinear scale
constexpr double kDefaultPosition = 0.4;  // position of the default value on the slider

double round_to_digits(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 4);
  return std::round(value / unit) * unit;
}

void draw_slider(const ImRect& box, const SliderRange& range, double value, ImGuiID id, int axis) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImGuiStyle& style = ImGui::GetStyle();
  const bool active = ImGui::GetActiveID() == id;
  const bool hovered = ImGui::GetHoveredID() == id;
  ImGui::RenderNavHighlight(box, id);
  list.AddRectFilled(box.Min, box.Max, packed_color(active || hovered ? ThemeColor::hover : ThemeColor::field),
                     style.FrameRounding);
  if (range.bounded()) {
    const auto at = [&](double v) {
      const double position = std::clamp(range.position_of(v), 0.0, 1.0);
      return box.Min.x + static_cast<float>(position) * box.GetWidth();
    };
    const float zero = at(std::clamp(0.0, range.min, range.max));
    const float end = at(value);
    const float mark = std::max(style.GrabMinSize * 0.5F, 1.0F);
    const float default_x = at(range.default_value);
    list.PushClipRect(box.Min, box.Max, true);
    list.AddRectFilled({std::min(zero, end), box.Min.y}, {std::max(zero, end), box.Max.y},
                       packed_color(ThemeColor::fill), style.FrameRounding);
    list.AddLine({default_x, box.Max.y - box.GetHeight() * 0.18F}, {default_x, box.Max.y},
                 packed_color(ThemeColor::secondary), 1);
    const float x = std::clamp(end, box.Min.x + mark, box.Max.x - mark);
    list.AddRectFilled({x - mark / 2, box.Min.y + 1}, {x + mark / 2, box.Max.y - 1}, packed_color(ThemeColor::accent));
    list.PopClipRect();
  }
  constexpr ThemeColor kAxes[] = {ThemeColor::red, ThemeColor::green, ThemeColor::blue};
  if (axis >= 0 && axis < 3) {
    list.AddRectFilled(box.Min, {box.Min.x + std::max(style.GrabMinSize * 0.6F, 2.0F), box.Max.y},
                       packed_color(kAxes[axis]), style.FrameRounding, ImDrawFlags_RoundCornersLeft);
  }
  const std::string text = number_label(value, range.integer);
  ImGui::RenderTextClipped({box.Min.x + style.FramePadding.x * 0.5F, box.Min.y}, box.Max, text.c_str(),
                           text.c_str() + text.size(), nullptr, {0.5F, 0.5F});
}

}  // namespace

bool SliderRange::bounded() const { return std::isfinite(min) && std::isfinite(max) && max > min; }

double SliderRange::exponent() const {
  const double bound = std::max(std::abs(min), std::abs(max));
  const double size = default_value == 0 ? 1 : std::abs(default_value);
  if (max - min <= kMaxLinearSpan || size > bound / 20 || (min < 0 && max < 0)) return 1;
  // the default value is at kDefaultPosition from the lower end, or from zero if the range contains it
  const double span = min >= 0 ? max - min : bound;
  return std::log(std::max(size - std::max(min, 0.0), 1e-12) / span) / std::log(kDefaultPosition);
}

double SliderRange::position_of(double value) const {
  const double p = exponent();
  if (p == 1) return (value - min) / (max - min);
  if (min >= 0) return std::pow(std::max(0.0, (value - min) / (max - min)), 1 / p);
  // negative and positive values are scaled separately from zero; each side is as long as its part of the range
  const double zero = -min / (max - min);
  if (value < 0) return zero * (1 - std::pow(std::min(value / min, 1.0), 1 / p));
  return zero + (1 - zero) * (max > 0 ? std::pow(value / max, 1 / p) : 0);
}

double SliderRange::value_at(double position) const {
  const double p = exponent();
  if (p == 1) return min + position * (max - min);
  if (min >= 0) return min + (max - min) * std::pow(position, p);
  const double zero = -min / (max - min);
  if (position < zero) return min * std::pow(1 - position / zero, p);
  return zero < 1 ? max * std::pow((position - zero) / (1 - zero), p) : 0;
}

std::string number_label(double value, bool integer) {
  if (!std::isfinite(value)) return value > 0 ? "inf" : "-inf";
  if (integer) return fmt::format("{:.0f}", value);
  const std::string text = fmt::format("{:.5g}", value);
  return text == "-0" ? "0" : text;
}

bool number_slider(const char* id_text, const SliderRange& range, float width, double& value, int axis) {
  ImGuiWindow* const window = ImGui::GetCurrentWindow();
  if (window->SkipItems) return false;
  ImGuiContext& g = *ImGui::GetCurrentContext();
  const ImGuiID id = window->GetID(id_text);
  const ImRect box(window->DC.CursorPos,
                   {window->DC.CursorPos.x + width, window->DC.CursorPos.y + ImGui::GetFrameHeight()});
  ImGui::ItemSize(box, ImGui::GetStyle().FramePadding.y);
  if (!ImGui::ItemAdd(box, id, &box, ImGuiItemFlags_Inputable)) return false;
  const bool hovered = imgui::is_hovered(box, id);
  bool typing = ImGui::TempInputIsActive(id);
  if (!typing) {
    const imgui::Activation activation = imgui::activation(id, hovered);
    if (activation.active) {
      ImGui::SetActiveID(id, window);
      ImGui::SetFocusID(id, window);
      ImGui::FocusWindow(window);
      g.ActiveIdUsingNavDirMask |= (1u << ImGuiDir_Left) | (1u << ImGuiDir_Right);
      typing = activation.by_text;
    }
  }
  const double low = range.min;
  const double high = range.max;
  if (typing) {
    double typed = value;
    const bool changed =
        ImGui::TempInputScalar(box, id, id_text, ImGuiDataType_Double, &typed, "%.9g", nullptr, nullptr);
    if (!changed || !std::isfinite(typed)) return false;
    value = std::clamp(range.integer ? std::round(typed) : typed, low, high);
    return true;
  }
  bool changed = false;
  if (range.bounded()) {
    double position = std::clamp(range.position_of(value), 0.0, 1.0);
    const double zero = 0;
    const double one = 1;
    ImRect grab;
    changed = ImGui::SliderBehavior(box, id, ImGuiDataType_Double, &position, &zero, &one, "%.6f", 0, &grab);
    if (changed) value = std::clamp(round_to_digits(range.value_at(position)), low, high);
  } else {
    const double speed =
        range.step > 0 ? range.step : std::max({std::abs(value), std::abs(range.default_value), 0.1}) * 0.01;
    changed = ImGui::DragBehavior(id, ImGuiDataType_Double, &value, static_cast<float>(speed), &low, &high, "%.6g", 0);
    if (changed) value = round_to_digits(value);
  }
  if (changed && range.integer) value = std::round(value);
  draw_slider(box, range, value, id, axis);
  return changed;
}

}  // namespace limber::panel
