// The list of units that properties may have. PropertyTable checks units against it, which finds typing errors.
#pragma once

#include <span>
#include <string_view>

namespace limber {

struct Unit {
  std::string_view symbol;
  std::string_view meaning;
};

std::span<const Unit> units();
/// True for a symbol in units() and for the empty text (a dimensionless number).
bool known_unit(std::string_view symbol);

}  // namespace limber
