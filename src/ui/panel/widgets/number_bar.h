// The widget for numbers: a bar that can be dragged, or edited as text after Ctrl and click; a drag field if the range
// is unbounded. The scale of wide ranges is nonlinear, so that typical values are not all at one end.
#pragma once

#include <string>

namespace limber {

/// Range and scale of a bar.
struct BarRange {
  double min = 0;
  double max = 1;        ///< If an end is infinite, there is a drag field instead of a bar.
  double typical = 0;    ///< The default value.
  double step = 0;       ///< 0: unspecified.
  bool integer = false;  ///< Integers only.
  bool bounded() const;
  /// Convert a value to its position on the bar, 0 .. 1, and back. Strictly increasing, and inverse to each other.
  double position_of(double value) const;
  double value_at(double position) const;

 private:
  double exponent() const;  // exponent of the scale; 1: linear
};

/// Formats with five significant digits, which avoids texts like 0.30000001.
std::string number_label(double value, bool integer);

/// Draws the widget. Returns true if the user has changed the value. `axis`: 0, 1, 2 for a mark in the color of x, y,
/// z; -1: none.
bool number_bar(const char* id, const BarRange& range, float width, double& value, int axis = -1);

}  // namespace limber
