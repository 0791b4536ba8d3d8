// Rows of number fields: the components of a property side by side, or in several rows if a field would be too narrow
// for its number.
#pragma once

#include <cstddef>

#include "ui/panel/gui_context.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

/// The arrangement of `count` fields in a width.
struct FieldGrid {
  std::size_t columns = 1;
  std::size_t rows = 1;
  float each = 0;  ///< Width of a field.
  float gap = 0;   ///< Between two fields of a row.
};
FieldGrid field_grid(std::size_t count, float width, float min_width);
/// The arrangement of a property's numbers. `font`: of the numbers.
FieldGrid field_grid(const Property& property, float width, ImFont* font);

/// The range of a component.
SliderRange range_of(const Property& property, std::size_t i);

/// Values of component `i` nearer to zero show 0: noise with respect to the range (SliderRange::zero_below), or to the
/// largest component of a vector.
double zero_below(const Property& property, std::size_t i, const PendingValues::Values& values);

/// Moves the cursor to the field `i` of the grid, which begins at `left` (ImGui::GetCursorPosX()).
void next_field(std::size_t i, const FieldGrid& grid, float left);

/// The name of a component's widget: the address, with /0, /1, … for vectors.
std::string component_name(const PropertyHandle& handle, std::size_t i);

}  // namespace limber::panel
