// A number's widget: a bar that fills up to its value and can be dragged, or typed into with Ctrl and a click; without
// ends, a field that is dragged. Wide ranges are stretched, so that usual values are not all at one end.
#pragma once

#include <string>

namespace limber {

struct BarRange {
  double min = 0;
  double max = 1;      ///< Infinite ends: no bar, a field.
  double usual = 0;    ///< The default.
  double step = 0;     ///< 0: nothing is said.
  bool whole = false;  ///< Whole numbers alone.
  bool bounded() const;
  /// Where on the bar, 0 .. 1, a value stands; and back. Strictly rising, inverse to each other.
  double place_of(double value) const;
  double value_at(double place) const;

 private:
  double power() const;  // 1: straight
};

/// Five digits: nobody wants 0.30000001.
std::string shown_number(double value, bool whole);

/// True: a hand has changed it. `axis`: 0, 1, 2 gives it a mark of x, y, z; -1 none.
bool number_bar(const char* id, const BarRange& range, float width, double& value, int axis = -1);

}  // namespace limber
