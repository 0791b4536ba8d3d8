// Matches OSC addresses against OSC address patterns.
#pragma once

#include <string_view>

namespace limber {

/// Matches each component with pattern_match(); `//` in the pattern matches any number of components. The work is
/// bounded: a pattern that needs more than 2000 attempts matches nothing.
bool address_matches(std::string_view pattern, std::string_view address);

}  // namespace limber
