// Ranges and values of properties as text, for the reference and the editor annotations.
#pragma once

#include <string>

#include "properties/property_table.h"

namespace limber {

/// Returns the allowed values: "0 .. 10", "off|servo", "true|false", "any"; empty for an action. [any]
std::string range_or_choices_text(const Property& property);
/// Returns a value with six digits: "1", "0 0 -9.81", "servo", "true". [any]
std::string value_text(const Property& property, const double* values);
/// Returns the default in the same form; empty if the property can't be set. [any]
std::string initial_text(const Property& property);

}  // namespace limber
