// Icons as lines and triangles.
#include "ui/panel/widgets/icons.h"

#include <array>
#include <cmath>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/widget_names.h"

namespace limber::panel {

namespace {

constexpr float kPi = 3.14159265F;

struct Pen {
  ImDrawList& list;
  ImVec2 center;
  float half;
  std::uint32_t color;

  ImVec2 at(float x, float y) const { return {center.x + x * half, center.y + y * half}; }
  float width() const { return half * 0.24F; }
  void line(ImVec2 a, ImVec2 b) const { list.AddLine(a, b, color, width()); }
  void triangle(ImVec2 a, ImVec2 b, ImVec2 c) const { list.AddTriangleFilled(a, b, c, color); }
  void box(float x0, float y0, float x1, float y1) const { list.AddRectFilled(at(x0, y0), at(x1, y1), color); }
};

struct IconBox {
  Icon icon;
  float x0, y0, x1, y1;
};
constexpr IconBox kBoxes[] = {
    {Icon::back, -0.75F, -0.75F, -0.5F, 0.75F},   {Icon::pause, -0.65F, -0.75F, -0.18F, 0.75F},
    {Icon::pause, 0.18F, -0.75F, 0.65F, 0.75F},   {Icon::step, -0.8F, -0.75F, -0.5F, 0.75F},
    {Icon::step_back, 0.5F, -0.75F, 0.8F, 0.75F}, {Icon::stop, -0.75F, -0.75F, 0.75F, 0.75F}};

struct IconTriangle {
  Icon icon;
  float x[3], y[3];
};
constexpr IconTriangle kTriangles[] = {{Icon::back, {0.75F, 0.75F, -0.45F}, {-0.75F, 0.75F, 0}},
                                       {Icon::play, {-0.55F, 0.8F, -0.55F}, {-0.8F, 0, 0.8F}},
                                       {Icon::step, {-0.3F, 0.85F, -0.3F}, {-0.75F, 0, 0.75F}},
                                       {Icon::step_back, {0.3F, -0.85F, 0.3F}, {-0.75F, 0, 0.75F}},
                                       {Icon::up, {-0.7F, 0, 0.7F}, {0.4F, -0.6F, 0.4F}},
                                       {Icon::down, {-0.7F, 0.7F, 0}, {-0.4F, -0.4F, 0.6F}},
                                       {Icon::right, {-0.4F, 0.6F, -0.4F}, {-0.7F, 0, 0.7F}}};

void star(const Pen& pen, bool full) {
  std::array<ImVec2, 10> points;
  for (std::size_t i = 0; i < points.size(); i++) {
    const float angle = -kPi / 2 + kPi * static_cast<float>(i) / 5;
    const float radius = i % 2 == 0 ? 0.95F : 0.42F;
    points[i] = pen.at(radius * std::cos(angle), radius * std::sin(angle));
  }
  if (full) {
    for (std::size_t i = 0; i < points.size(); i += 2)
      pen.triangle(points[i], points[(i + 1) % 10], points[(i + 9) % 10]);
    std::array<ImVec2, 5> inner;
    for (std::size_t i = 0; i < inner.size(); i++) inner[i] = points[2 * i + 1];
    pen.list.AddConvexPolyFilled(inner.data(), 5, pen.color);
  } else {
    pen.list.AddPolyline(points.data(), 10, pen.color, ImDrawFlags_Closed, pen.half * 0.14F);
  }
}

void arrow_back(const Pen& pen) {
  pen.list.PathArcTo(pen.at(0, 0.1F), pen.half * 0.68F, -kPi * 0.85F, kPi * 0.6F, 20);
  pen.list.PathStroke(pen.color, 0, pen.half * 0.2F);
  pen.triangle(pen.at(-0.95F, -0.62F), pen.at(-0.3F, -0.5F), pen.at(-0.85F, 0.06F));
}

void magnifier(const Pen& pen) {
  pen.list.AddCircle(pen.at(-0.18F, -0.18F), pen.half * 0.55F, pen.color, 16, pen.width() * 0.8F);
  pen.line(pen.at(0.25F, 0.25F), pen.at(0.8F, 0.8F));
}

void double_arrow(const Pen& pen) {
  pen.triangle(pen.at(-0.02F, -0.7F), pen.at(-0.95F, 0), pen.at(-0.02F, 0.7F));
  pen.triangle(pen.at(0.93F, -0.7F), pen.at(0, 0), pen.at(0.93F, 0.7F));
}

void cross(const Pen& pen) {
  pen.line(pen.at(-0.6F, -0.6F), pen.at(0.6F, 0.6F));
  pen.line(pen.at(-0.6F, 0.6F), pen.at(0.6F, -0.6F));
}

void plus(const Pen& pen) {
  pen.line(pen.at(-0.75F, 0), pen.at(0.75F, 0));
  pen.line(pen.at(0, -0.75F), pen.at(0, 0.75F));
}

void warning_sign(const Pen& pen) {
  pen.list.AddTriangle(pen.at(0, -0.85F), pen.at(0.95F, 0.75F), pen.at(-0.95F, 0.75F), pen.color, pen.width() * 0.7F);
  pen.line(pen.at(0, -0.3F), pen.at(0, 0.25F));
  pen.list.AddCircleFilled(pen.at(0, 0.5F), pen.half * 0.12F, pen.color, 8);
}

}  // namespace

void draw_icon(Icon icon, float x, float y, float half, std::uint32_t color) {
  const Pen pen{*ImGui::GetWindowDrawList(), {x, y}, half, color};
  for (const IconBox& b : kBoxes) {
    if (b.icon == icon) pen.box(b.x0, b.y0, b.x1, b.y1);
  }
  for (const IconTriangle& t : kTriangles) {
    if (t.icon == icon) pen.triangle(pen.at(t.x[0], t.y[0]), pen.at(t.x[1], t.y[1]), pen.at(t.x[2], t.y[2]));
  }
  switch (icon) {
    case Icon::rewind:
      return double_arrow(pen);
    case Icon::record:
      return pen.list.AddCircleFilled(pen.center, half * 0.85F, color, 20);
    case Icon::star:
    case Icon::star_empty:
      return star(pen, icon == Icon::star);
    case Icon::undo:
      return arrow_back(pen);
    case Icon::search:
      return magnifier(pen);
    case Icon::warning:
      return warning_sign(pen);
    case Icon::close:
      return cross(pen);
    case Icon::plus:
      return plus(pen);
    default:  // boxes and triangles only
      return;
  }
}

bool icon_button(WidgetNames& names, const char* name, Icon icon, const char* tooltip, bool on, float width) {
  const float height = ImGui::GetFrameHeight();
  if (width <= 0) width = height * 1.25F;
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, packed_color(ThemeColor::active));
  ImGui::PushID(name);
  const bool pressed = ImGui::Button("##icon", {width, height});
  ImGui::PopID();
  names.add(name);
  if (on) ImGui::PopStyleColor();
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(icon, low.x + width / 2, low.y + height / 2, height * 0.27F,
            packed_color(on && !ImGui::IsItemHovered() ? ThemeColor::on_active : ThemeColor::text));
  if (ImGui::IsItemHovered() && tooltip != nullptr) ImGui::SetTooltip("%s", tooltip);
  return pressed;
}

bool search_field(WidgetNames& names, const char* name, const char* hint, std::string& text, float width) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float icon_width = ImGui::GetFontSize() * 1.25F;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {style.FramePadding.x + icon_width, style.FramePadding.y});
  ImGui::SetNextItemWidth(width);
  ImGui::PushID(name);
  const float space = (width < 0 ? ImGui::GetContentRegionAvail().x : width) - ImGui::GetStyle().FramePadding.x;
  const std::string shown = elided(hint, space, text_width);
  const bool changed = ImGui::InputTextWithHint("##search", shown.c_str(), &text, ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopID();
  ImGui::PopStyleVar();
  names.add(name);
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(Icon::search, low.x + style.FramePadding.x + icon_width * 0.35F, low.y + ImGui::GetFrameHeight() / 2,
            ImGui::GetFontSize() * 0.36F, packed_color(ThemeColor::secondary));
  return changed;
}

}  // namespace limber::panel
