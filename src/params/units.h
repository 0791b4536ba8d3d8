// The units that rows may have: a closed list, so that a mistyped one is found.
#pragma once

#include <span>
#include <string_view>

namespace limber {

struct Unit {
  std::string_view symbol;
  std::string_view means;
};

std::span<const Unit> units();
/// The empty text counts: a pure number.
bool known_unit(std::string_view symbol);

}  // namespace limber
