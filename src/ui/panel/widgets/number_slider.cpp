// Uses the slider behavior of Dear ImGui with custom drawing.
#include "ui/panel/widgets/number_slider.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/theme.h"

namespace limber::panel {

namespace {

constexpr double kMaxLinearSpan = 200;    // wider ranges get a nonlinear scale
constexpr double kDefaultPosition = 0.4;  // position of the default value on the slider
constexpr double kNoise = 1e-6;           // fraction of a linear range below which a value shows 0
constexpr float kSidePadding = 0.5F;      // space beside a number, in units of the frame's padding

double round_to_digits(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 4);
  return std::round(value / unit) * unit;
}

// The mark at the value. It leaves out the text, so that it covers no digit.
void draw_mark(float x, float width, const ImRect& box, const TextSpan& text) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto part = [&](float top, float bottom) {
    list.AddRectFilled({x - width / 2, top}, {x + width / 2, bottom}, packed_color(ThemeColor::accent));
  };
  const float margin = ImGui::GetStyle().FramePadding.y - 1;
  const float beside = 1 + width;
  if (x + beside < text.begin || x - beside > text.end) return part(box.Min.y + 1, box.Max.y - 1);
  part(box.Min.y, box.Min.y + margin);
  part(box.Max.y - margin, box.Max.y);
}

void draw_slider(const ImRect& box, const SliderRange& range, double value, ImGuiID id, int axis, double zero_below) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImGuiStyle& style = ImGui::GetStyle();
  const bool active = ImGui::GetActiveID() == id;
  const bool hovered = ImGui::GetHoveredID() == id;
  ImGui::RenderNavHighlight(box, id);
  list.AddRectFilled(box.Min, box.Max, packed_color(active || hovered ? ThemeColor::hover : ThemeColor::field),
                     style.FrameRounding);
  const float mark = std::max(style.GrabMinSize * 0.5F, 1.0F);
  float end = box.Min.x;
  if (range.bounded()) {
    const auto at = [&](double v) {
      const double position = std::clamp(range.position_of(v), 0.0, 1.0);
      return box.Min.x + static_cast<float>(position) * box.GetWidth();
    };
    const float zero = at(std::clamp(0.0, range.min, range.max));
    end = at(value);
    const float default_x = at(range.default_value);
    list.PushClipRect(box.Min, box.Max, true);
    if (std::abs(end - zero) >= 1)
      list.AddRectFilled({std::min(zero, end), box.Min.y}, {std::max(zero, end), box.Max.y},
                         packed_color(ThemeColor::fill), style.FrameRounding);
    list.AddLine({default_x, box.Max.y - style.FramePadding.y}, {default_x, box.Max.y},
                 packed_color(ThemeColor::secondary), 1);
    list.PopClipRect();
  }
  constexpr ThemeColor kAxes[] = {ThemeColor::red, ThemeColor::green, ThemeColor::blue};
  if (axis >= 0 && axis < 3) {
    list.AddRectFilled(box.Min, {box.Min.x + std::max(style.GrabMinSize * 0.6F, 2.0F), box.Max.y},
                       packed_color(kAxes[axis]), style.FrameRounding, ImDrawFlags_RoundCornersLeft);
  }
  const NumberFormat format{zero_below < 0 ? range.zero_below() : zero_below, range.integer};
  const TextSpan text = draw_number(value, format, {box.Min.x, box.Min.y, box.GetWidth(), box.GetHeight()});
  if (range.bounded()) draw_mark(std::clamp(end, box.Min.x + mark, box.Max.x - mark), mark, box, text);
}

}  // namespace

bool SliderRange::bounded() const { return std::isfinite(min) && std::isfinite(max) && max > min; }

double SliderRange::exponent() const {
  const double bound = std::max(std::abs(min), std::abs(max));
  const double size = default_value == 0 ? 1 : std::abs(default_value);
  if (linear || max - min <= kMaxLinearSpan || size > bound / 20 || (min < 0 && max < 0)) return 1;
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

double SliderRange::zero_below() const {
  return bounded() && exponent() == 1 ? (max - min) * kNoise : std::numeric_limits<double>::epsilon();
}

float text_width(std::string_view text) { return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x; }

float min_number_width(const SliderRange& range) {
  const bool short_exponent = range.bounded() && range.zero_below() > 1e-10 && std::abs(range.max) < 1e5;
  return text_width(short_exponent ? "-0.001" : "-1.2e-5") + 2 * ImGui::GetStyle().FramePadding.x * kSidePadding;
}

TextSpan draw_number(double value, const NumberFormat& format, const PanelRect& field) {
  const auto x = static_cast<float>(field.x);
  const auto width = static_cast<float>(field.width);
  const std::string text =
      fitted_number(value, format, width - 2 * ImGui::GetStyle().FramePadding.x * kSidePadding, text_width);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 at{std::floor(x + std::max((width - size.x) / 2, 0.0F)),
                  static_cast<float>(field.y + (field.height - static_cast<double>(size.y)) / 2)};
  ImGui::GetWindowDrawList()->AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  return {at.x, at.x + size.x};
}

bool number_slider(const char* id_text, const SliderRange& range, float width, double& value, int axis,
                   double zero_below) {
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
  draw_slider(box, range, value, id, axis, zero_below);
  return changed;
}

}  // namespace limber::panel
