// The layout of a property's line: the name beside the widget, or above it if one of them is too wide.
#pragma once

#include <string>
#include <vector>

#include "ui/panel/gui_context.h"
#include "ui/panel/widgets/number_fields.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

/// The places of an action's button and of its arguments: side by side, or the arguments below.
struct ActionLayout {
  float button = 0;
  bool below = false;
  FieldGrid fields;
};

/// The places of a property's name, widget and unit in its line.
struct LineLayout {
  bool above = false;             // the name is above the widget
  std::vector<std::string> name;  // lines of the name; none: the widget shows it
  std::string unit;
  float left = 0;  // width of the star
  float name_width = 0, name_height = 0;
  float unit_width = 0;  // beside the widget
  float widget_width = 0;
  float height = 0;
};

/// Puts the name above the widget if there is no room for it beside the widget.
LineLayout line_layout(const GuiContext& context, const PropertyHandle& handle, const PropertyLineOptions& options,
                       float width);
ActionLayout action_layout(const GuiContext& context, const Property& property, float width);

/// The range of the arguments of actions.
inline const SliderRange kArgument{-kUnbounded, kUnbounded, 1, 0, false};
inline constexpr float kNameSpacing = 2;  ///< Pixels between a name and the widget below it.

bool is_color(const Property& property);
/// True if the property is shown by numbers.
bool is_numeric(const Property& property);
/// The width of a color's swatch and the gap beside it.
float swatch_width();
/// The width of the buttons at the ends of a line.
float reset_width();

}  // namespace limber::panel
