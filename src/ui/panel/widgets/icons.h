// The panel's icons, drawn as lines and triangles, so that no icon font is needed, and the widgets that contain one.
#pragma once

#include <cstdint>
#include <string>

namespace limber::panel {

class WidgetNames;

enum class Icon : std::uint8_t {
  back,  ///< To the start: reset.
  play,
  pause,
  step,
  step_back,
  rewind,
  record,
  stop,
  star,
  star_empty,
  undo,
  search,
  warning,
  close,
  plus,
  up,
  down,
  right
};

/// Draws into the square with this center and half side length, in the current window.
void draw_icon(Icon icon, float x, float y, float half, std::uint32_t color);

/// A button with an icon, as high as a text field. `name` is its id and its name in `names`. Returns true if it was
/// pressed.
bool icon_button(WidgetNames& names, const char* name, Icon icon, const char* tooltip, bool on = false,
                 float width = 0);

/// A text field with a magnifier icon and a hint. `name`: its id and its name in `names`. Returns true if the text has
/// changed.
bool search_field(WidgetNames& names, const char* name, const char* hint, std::string& text, float width);

}  // namespace limber::panel
