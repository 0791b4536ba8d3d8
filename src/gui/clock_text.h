// Seconds as a clock shows them: "01:23.45".
#pragma once

#include <string>

namespace limber {

/// Hundredths are cut off, not rounded: a second begins when it has come.
std::string clock_text(double seconds);

}  // namespace limber
