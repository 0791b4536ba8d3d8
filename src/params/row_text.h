// A row's values as people read them: in the reference and in the definitions for editors.
#pragma once

#include <string>

#include "params/table.h"

namespace limber {

/// "0 .. 10", "off|servo", "true|false", "any"; empty for an action. [any]
std::string values_text(const Row& row);
/// Numbers of that row: "1", "0 0 -9.81", "servo", "true"; six digits are what a person reads. [any]
std::string value_text(const Row& row, const double* values);
/// The default: "1", "0 0 -9.81", "servo", "true"; empty where nothing can be set. [any]
std::string initial_text(const Row& row);

}  // namespace limber
