// The few signs of the panel, drawn as lines, so that no font of signs is needed.
#pragma once

#include <cstdint>

namespace limber {

class WidgetNames;

enum class Icon : std::uint8_t {
  back,
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

/// Into the square of that middle and half side, of the current window.
void draw_icon(Icon icon, float x, float y, float half, std::uint32_t color);

/// A button with a sign, as high as a field; `name` is its id and, in `names`, its name. True: it was pressed.
bool icon_button(WidgetNames& names, const char* name, Icon icon, const char* tip, bool on = false, float width = 0);

}  // namespace limber
