// The keys that act wherever the mouse is: one table, which the help overlay shows and the window's keys go by.
#pragma once

#include <cstdint>
#include <span>

#include "gui/input.h"

namespace limber {

enum class HotkeyAction : std::uint8_t {
  play_pause,
  step,
  step_back,
  rewind,
  record,
  play_take,
  panic,
  reset,
  hide,
  help,
  search,
  undo,
  redo,
  larger,
  smaller,
  overlay,
  earlier,
  later,
  output,
  full_screen,
  home_view,
  keep_view,
  go_to_view,
  recall,
};

struct Hotkey {
  KeyPress press;
  HotkeyAction action = HotkeyAction::help;
  const char* shown = "";
  const char* does = "";
  bool while_typing = false;  ///< It acts where letters would be typed, too.
  int keys = 1;               ///< So many in a row mean it, from that of `press` on: 1 to 8.
};
std::span<const Hotkey> hotkeys();

/// What a press means; null: nothing. `typing`: a field takes letters.
const Hotkey* hotkey_of(const KeyPress& press, bool typing);

}  // namespace limber
