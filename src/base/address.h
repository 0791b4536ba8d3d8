// Whole OSC addresses against patterns.
#pragma once

#include <string_view>

namespace limber {

/// Name by name as pattern_match has it; `//` in the pattern stands for any depth. Bounded: a pattern that needs too
/// many tries matches nothing.
bool address_matches(std::string_view pattern, std::string_view address);

}  // namespace limber
