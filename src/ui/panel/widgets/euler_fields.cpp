// Converts with euler_of() and quat_euler().
#include "ui/panel/widgets/euler_fields.h"

#include <fmt/format.h>
#include <imgui.h>

#include "base/vec.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_fields.h"

namespace limber::panel {

namespace {

constexpr const char* kEulerLabel = "Euler angles";
constexpr const char* kEulerUnit = "deg";
constexpr const char* kEulerHint =
    "The same rotation as Euler angles: about the fixed axes x, then y, then z, as quat.euler(x, y, z) in Lua, but in "
    "degrees. At y = ±90 only the sum or difference of x and z is determined, and z shows 0.";

SliderRange angle_range(std::size_t i) {
  const double bound = i == 1 ? 90 : 180;
  return {-bound, bound, 0, 0, false, true};
}

FieldGrid angle_grid(const GuiContext& context, float width) {
  ImGui::PushFont(context.fonts.code);
  const float min_width = min_number_width(angle_range(0));
  ImGui::PopFont();
  return field_grid(3, width, min_width);
}

void angle_hint() {
  if (!ImGui::IsItemHovered() || ImGui::IsMouseDown(0)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(kEulerHint);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace

Vec3 degrees_of(const double* quaternion) { return euler_of(glm::normalize(quat_at(quaternion))) * (180 / kPi); }

void put_degrees(const Vec3& degrees, double* quaternion) {
  const Vec3 angles = degrees * (kPi / 180);
  put(quaternion, quat_euler(angles.x, angles.y, angles.z));
}

float euler_height(const GuiContext& context, float width) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float row = imgui::font_height(*context.fonts.code) + 2 * style.FramePadding.y + style.ItemSpacing.y;
  return ImGui::GetTextLineHeight() + style.ItemSpacing.y + row * static_cast<float>(angle_grid(context, width).rows);
}

void euler_fields(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  const bool writable = handle.ref.property->writable();
  const float left = ImGui::GetCursorPosX();
  ImGui::TextDisabled("%s", kEulerLabel);
  context.names.add("name:euler:" + handle.path);
  angle_hint();
  ImGui::SameLine(0, ImGui::GetFontSize() * 0.6F);
  ImGui::TextDisabled("%s", kEulerUnit);
  const Vec3 degrees = degrees_of(values.data());
  double angles[] = {degrees.x, degrees.y, degrees.z};
  const FieldGrid grid = angle_grid(context, width);
  bool changed = false;
  bool dragging = false;
  ImGui::SetCursorPosX(left);
  for (std::size_t i = 0; i < 3; i++) {
    next_field(i, grid, left);
    ImGui::PushFont(context.fonts.code);
    const SliderRange range = angle_range(i);
    if (writable) {
      changed |= number_slider(fmt::format("##euler{}", i).c_str(), range, grid.each, angles[i], static_cast<int>(i));
      dragging |= ImGui::IsItemActive();
    } else {
      const ImVec2 at = ImGui::GetCursorScreenPos();
      ImGui::Dummy({grid.each, ImGui::GetFrameHeight()});
      draw_number(angles[i], {range.zero_below()}, {at.x, at.y, grid.each, ImGui::GetFrameHeight()});
    }
    ImGui::PopFont();
    context.names.add(fmt::format("euler:{}/{}", handle.path, i));
    angle_hint();
  }
  if (!changed) return;
  put_degrees({angles[0], angles[1], angles[2]}, values.data());
  context.set(handle, values, dragging);
}

}  // namespace limber::panel
