// Formats seconds as a clock: "01:23.45".
#pragma once

#include <string>

namespace limber {

/// Returns minutes and seconds; hundredths are truncated, not rounded.
std::string clock_text(double seconds);

}  // namespace limber
