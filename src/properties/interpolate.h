// Interpolation between two values of a property.
#pragma once

#include "properties/property_table.h"

namespace limber {

/// Writes the value at `amount` between `a` (0) and `b` (1) to `out`. Both ends are exact. Numbers are interpolated
/// linearly and never leave [a, b], rotations along the shorter arc; booleans and choices switch at 0.5. If `a` and `b`
/// are valid values of the property, so is the result. Each array has `width` numbers; `out` may be `a` or `b`. [any]
void mix(const Property& property, const double* a, const double* b, double amount, double* out);

}  // namespace limber
