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

/// Draws only the widget with this width in pixels. The caller draws its context menu: property_menu().
void property_widget(GuiContext& context, const PropertyHandle& handle, float width);

/// True if a value differs from the default by more than the rounding of 32-bit floats in OSC messages.
bool differs_from_default(const Property& property, const PendingValues::Values& values);

/// Returns the name with spaces: "linear damping".
std::string property_label(const Property& property);

/// Adds a tooltip to the last item (documentation, unit, range, default, address). A right click on the item opens the
/// property's menu.
void property_hint(const PropertyHandle& handle);

/// Draws the property's context menu, if it is open. Call it once per property, in the same id scope as its widgets.
void property_menu(GuiContext& context, const PropertyHandle& handle);

}  // namespace limber::panel
