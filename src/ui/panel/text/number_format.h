// Numbers as text that fits a width. All numbers of the panel are formatted here: fields, readouts, plots, counters.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace limber::panel {

/// Returns the width of a text in any unit, for example in pixels of the current font.
using TextWidth = std::function<float(std::string_view)>;

/// Describes how a number is shown.
struct NumberFormat {
  double zero_below = 0;  ///< Values nearer to zero are rounding noise and show 0.
  bool integer = false;
  int decimals = -1;  ///< Fixed number of decimals, for numbers that change in each frame; -1: as many as are needed.
};

/// Maximum number of significant digits: those that a 32-bit float has.
inline constexpr int kMaxDigits = 6;

/// Returns the number with as many digits as fit the width, at most kMaxDigits (integers: all). The sign, the exponent
/// and the digits before the point are never cut: if they don't fit, the text is in scientific form ("1.2e7"), and
/// longer than the width if even one digit with its exponent doesn't fit. NaN is "nan", an infinity "inf" or "-inf".
std::string fitted_number(double value, const NumberFormat& format, float width, const TextWidth& width_of);

/// Returns the number with kMaxDigits, for places of any width.
std::string number_label(double value, const NumberFormat& format = {});

}  // namespace limber::panel
