// Global hotkeys: one table for dispatch and for the help overlay. Users can rebind each action.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ui/panel/imgui/input.h"

namespace limber::panel {

enum class HotkeyAction : std::uint8_t {
  play_pause,
  step_forward,
  step_back,
  rewind,
  toggle_recording,
  toggle_take_playback,
  panic,
  reset,
  toggle_panel,
  toggle_help,
  focus_search,
  undo,
  redo,
  increase_text_size,
  decrease_text_size,
  toggle_overlay,
  toggle_lights,
  toggle_blackout,
  next_cue,
  previous_cue,
  pause_cues,
  tap_tempo,
  move_behavior_earlier,
  move_behavior_later,
  toggle_output_window,
  toggle_full_screen,
  default_view,
  frame_selection,
  frame_all,
  store_view,
  restore_view,
  recall_preset,
};

/// One or several consecutive keys for an action.
struct Hotkey {
  KeyPress press;
  HotkeyAction action = HotkeyAction::toggle_help;
  const char* name = "";  ///< Unique; used in the panel's settings.
  const char* description = "";
  bool while_typing = false;  ///< Also active while a text field has the focus.
  /// Number of consecutive keys, starting at `press` (1 to 9). If there is more than one, the hotkey can't be rebound.
  int key_count = 1;
  /// A user may bind the default key to another hotkey; this one then has no key. Set for hotkeys that are newer than
  /// the settings of some users.
  bool yields = false;
};

/// Rebound keys by the name of the hotkey, in the format of key_text().
using KeyBindings = std::map<std::string, std::string>;
/// Labels of keys that are identified by their position, because the keyboard layout has no key with their letter.
using KeyLabels = std::map<GuiKey, std::string>;

/// Returns text like "Ctrl+Shift+R". `labels` override the names of keys.
std::string key_text(const KeyPress& press, const KeyLabels& labels = {});
/// Parses the format of key_text(); empty if the text is not a key.
std::optional<KeyPress> parse_key(std::string_view text);

/// The hotkeys with the user's bindings.
class Hotkeys {
 public:
  explicit Hotkeys(const KeyBindings& bindings = {});
  std::span<const Hotkey> all() const { return list_; }
  /// Errors of rejected bindings.
  const std::vector<std::string>& errors() const { return errors_; }
  const Hotkey* find(std::string_view name) const;
  /// Returns the hotkey of a key press or null. `typing`: a text field has the focus.
  const Hotkey* match(const KeyPress& press, bool typing) const;
  /// Returns the reason why this key can't be bound to the hotkey; empty if it can.
  std::string conflict(std::string_view name, const KeyPress& press) const;

 private:
  std::vector<Hotkey> list_;
  std::vector<std::string> errors_;
};

/// Returns "Ctrl+R", or "1 .. 8" for consecutive keys.
std::string keys_text(const Hotkey& hotkey, const KeyLabels& labels);

}  // namespace limber::panel
