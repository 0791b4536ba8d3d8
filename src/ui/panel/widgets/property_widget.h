// The widget of a property: the only code that displays a property's value and converts user input to messages. All
// panels use it.
#pragma once

#include <string>
#include <string_view>

#include "ui/panel/gui_context.h"

namespace limber::panel {

/// Options of a property's line.
struct PropertyLineOptions {
  bool star = true;             ///< Button that marks it as a favorite.
  bool with_path = false;       ///< Show the address instead of the name.
  double name_fraction = 0.46;  ///< Fraction of the width for the name.
};

/// Draws a line with star, name, widget and reset button. A line outside the visible area is skipped. Its widgets are
/// named by the address, with /0, /1, … for vectors, and with the prefixes "star:" and "reset:".
void property_line(GuiContext& context, const PropertyHandle& handle, const PropertyLineOptions& options = {});

/// Draws only the widget with this width in pixels.
void property_widget(GuiContext& context, const PropertyHandle& handle, float width);

/// True if a value differs from the default by more than the rounding of 32-bit floats in OSC messages.
bool differs_from_default(const Property& property, const PendingValues::Values& values);

/// Returns the name with spaces: "linear damping".
std::string property_label(const Property& property);

/// Adds a tooltip to the last item (documentation, unit, range, default, address) and a context menu.
void property_hint(GuiContext& context, const PropertyHandle& handle);

}  // namespace limber::panel
