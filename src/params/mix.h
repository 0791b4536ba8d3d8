// Mixing: what lies between two values of a row.
#pragma once

#include "params/table.h"

namespace limber {

/// `amount` 0: `a`, 1: `b`, each to the bit; numbers go straight and never beyond either end, rotations along the
/// shorter arc, what has no values in between switches at one half. What lies between two values that the row takes, it
/// takes. `out` may be `a` or `b`; row.width numbers each. [any]
void mix(const Row& row, const double* a, const double* b, double amount, double* out);

}  // namespace limber
