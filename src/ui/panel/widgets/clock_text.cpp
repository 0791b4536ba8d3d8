// Minutes, and seconds with two decimals.
#include "ui/panel/widgets/clock_text.h"

#include <cmath>

#include <fmt/format.h>

namespace limber {

std::string clock_text(double seconds) {
  seconds += 1e-6;  // tolerance, because sums of time steps are slightly too small
  const auto minutes = static_cast<long>(seconds / 60);
  return fmt::format("{:02}:{:05.2f}", minutes,
                     std::floor((seconds - 60.0 * static_cast<double>(minutes)) * 100) / 100);
}

}  // namespace limber
