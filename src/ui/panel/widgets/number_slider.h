// The widget for numbers: a slider that can also be edited as text after Ctrl+click; a drag field if the range is
// unbounded. The scale of wide ranges is nonlinear, so that typical values are not all at one end.
#pragma once

#include <string_view>

#include "ui/panel/layout.h"
#include "ui/panel/text/number_format.h"

namespace limber::panel {

/// Range and scale of a slider.
struct SliderRange {
  double min = 0;
  double max = 1;  ///< If an end is infinite, there is a drag field instead of a slider.
  double default_value = 0;
  double step = 0;       ///< 0: unspecified.
  bool integer = false;  ///< Integers only.
  bool linear = false;   ///< A linear scale, even if the range is wide.
  bool bounded() const;
  /// Convert a value to its position on the slider, 0 .. 1, and back. Strictly increasing, and inverse to each other.
  double position_of(double value) const;
  double value_at(double position) const;
  /// Values nearer to zero show 0: a millionth of a linear range. On a nonlinear scale small values are as usual as
  /// large ones, so only the rounding errors of doubles show 0 there.
  double zero_below() const;

 private:
  double exponent() const;  // exponent of the scale; 1: linear
};

/// Returns the width of a text in pixels, in the current font.
float text_width(std::string_view text);

/// Returns the width in pixels of a field in which a number of the range keeps its sign, its exponent and two digits.
/// Call it with the font of numbers.
float min_number_width(const SliderRange& range);

/// Draws a number in a field, centered, in the current font and color. Returns the horizontal range of the text.
struct TextSpan {
  float begin = 0, end = 0;
};
TextSpan draw_number(double value, const NumberFormat& format, const PanelRect& field);

/// Draws the widget. Returns true if the user has changed the value. `axis`: 0, 1, 2 for a mark in the color of x, y,
/// z; -1: none. Values nearer to zero than `zero_below` show 0; negative: as the range says.
bool number_slider(const char* id, const SliderRange& range, float width, double& value, int axis = -1,
                   double zero_below = -1);

}  // namespace limber::panel
