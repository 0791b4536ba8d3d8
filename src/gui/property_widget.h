// A row of the catalog as a widget: the one place that turns a row and its value into something to see and to move, and
// a hand's move into a message. Every panel takes its widgets from here.
#pragma once

#include <string>
#include <string_view>

#include "gui/desk.h"

namespace limber {

/// What is around a row's widget.
struct RowFrame {
  bool star = true;         ///< A star that makes it a favourite.
  bool with_path = false;   ///< Its address instead of its name alone.
  double name_part = 0.36;  ///< Of the width.
};

/// A whole line: star, name, widget, back to the default. A row that is scrolled out of sight costs nothing.
/// Names of its widgets: the address; of vectors with /0, /1, …; with "star:", "reset:" in front.
void property_row(Desk& desk, const PlacedRow& at, const RowFrame& frame = {});

/// Only the widget, so many pixels wide.
void property_widget(Desk& desk, const PlacedRow& at, float width);

/// Whether a value differs from its row's default beyond what a float on the wire loses.
bool differs_from_default(const Row& row, const HandValues::Values& values);

/// "linear_damping" as words.
std::string row_words(const Row& row);

/// Tooltip of the last item: what the row is, unit, range, default, address; and its menu on a right click.
void property_hint(Desk& desk, const PlacedRow& at);

}  // namespace limber
