// Chooses the number of columns by the narrowest useful field.
#include "ui/panel/widgets/number_fields.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace limber::panel {

namespace {

constexpr double kVectorNoise = 1e-6;  // fraction of a vector's largest component below which a component shows 0

}  // namespace

FieldGrid field_grid(std::size_t count, float width, float min_width) {
  FieldGrid grid;
  grid.gap = ImGui::GetStyle().ItemInnerSpacing.x * 0.7F;
  const auto each_of = [&](std::size_t columns) {
    return std::floor((width - grid.gap * static_cast<float>(columns - 1)) / static_cast<float>(columns));
  };
  grid.columns = std::max<std::size_t>(count, 1);
  while (grid.columns > 1 && (count % grid.columns != 0 || each_of(grid.columns) < min_width)) grid.columns--;
  grid.rows = (count + grid.columns - 1) / grid.columns;
  grid.each = each_of(grid.columns);
  return grid;
}

FieldGrid field_grid(const Property& property, float width, ImFont* font) {
  ImGui::PushFont(font);
  float min_width = 0;
  for (std::size_t i = 0; i < property.width; i++)
    min_width = std::max(min_width, min_number_width(range_of(property, i)));
  ImGui::PopFont();
  return field_grid(property.width, width, min_width);
}

SliderRange range_of(const Property& property, std::size_t i) {
  return {property.low(i), property.high(i), property.initial[i], property.step,
          property.type == PropertyType::integer};
}

double zero_below(const Property& property, std::size_t i, const PendingValues::Values& values) {
  const double noise = range_of(property, i).zero_below();
  // the components of a value for each axis are independent, those of a color are in 0 .. 1
  if (property.type != PropertyType::vec3 || property.own_axis || property.euler) return noise;
  double largest = 0;
  for (std::size_t k = 0; k < property.width; k++) largest = std::max(largest, std::abs(values[k]));
  return std::isfinite(largest) ? std::max(noise, largest * kVectorNoise) : noise;
}

void next_field(std::size_t i, const FieldGrid& grid, float left) {
  if (i % grid.columns != 0) {
    ImGui::SameLine(0, grid.gap);
  } else if (i > 0) {
    ImGui::SetCursorPosX(left);
  }
}

std::string component_name(const PropertyHandle& handle, std::size_t i) {
  return handle.ref.property->width > 1 ? fmt::format("{}/{}", handle.path, i) : handle.path;
}

}  // namespace limber::panel
