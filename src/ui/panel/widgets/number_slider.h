// The widget for numbers: a slider that can also be edited as text after Ctrl+click; a drag field if the range is
// unbounded. The scale of wide ranges is nonlinear, so that typical values are not all at one end.
#pragma once

#include <string>

namespace limber::panel {

/// Range and scale of a slider.
struct SliderRange {
  double min = 0;
  double max = 1;  ///< If an end is infinite, there is a drag field instead of a slider.
  double default_value = 0;
  double step = 0;       ///< 0: unspecified.
  bool integer = false;  ///< Integers only.
  bool bounded() const;
  /// Convert a value to its position on the slider, 0 .. 1, and back. Strictly increasing, and inverse to each other.
  double position_of(double value) const;
  double value_at(double position) const;

 private:
  double exponent() const;  // exponent of the scale; 1: linear
};

/// Formats with five significant digits, which avoids texts like 0.30000001.
std::string number_label(double value, bool integer);

/// Draws the widget. Returns true if the user has changed the value. `axis`: 0, 1, 2 for a mark in the color of x, y,
/// z; -1: none.
bool number_slider(const char* id, const SliderRange& range, float width, double& value, int axis = -1);

}  // namespace limber::panel
