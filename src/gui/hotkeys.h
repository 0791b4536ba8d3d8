// The keys that act wherever the mouse is: one table, which the help overlay shows and the window's keys go by. A
// performer may choose others for each action.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
  const char* name = "";  ///< In the panel's settings, unique.
  const char* does = "";
  bool while_typing = false;  ///< It acts where letters would be typed, too.
  int keys = 1;               ///< So many in a row mean it, from that of `press` on: 1 to 9. More than one: not chosen.
};

/// By the name of a hotkey, its key as key_text() writes it.
using KeyChoices = std::map<std::string, std::string>;
/// What the keyboard prints on keys that act by their place, since its layout prints their letter nowhere.
using KeyLabels = std::map<GuiKey, std::string>;

/// "Ctrl+Shift+R". `labels`: instead of the key's own name.
std::string key_text(const KeyPress& press, const KeyLabels& labels = {});
/// The other way round; nothing: this is no key.
std::optional<KeyPress> parse_key(std::string_view text);

class Hotkeys {
 public:
  explicit Hotkeys(const KeyChoices& chosen = {});
  std::span<const Hotkey> all() const { return list_; }
  /// Choices that were left out, and why.
  const std::vector<std::string>& faults() const { return faults_; }
  const Hotkey* named(std::string_view name) const;
  /// What a press means; null: nothing. `typing`: a field takes letters.
  const Hotkey* of(const KeyPress& press, bool typing) const;
  /// What speaks against that key for a hotkey; empty: nothing.
  std::string against(std::string_view name, const KeyPress& press) const;

 private:
  std::vector<Hotkey> list_;
  std::vector<std::string> faults_;
};

/// "Ctrl+R", of several keys in a row "1 .. 8".
std::string shown_keys(const Hotkey& hotkey, const KeyLabels& labels);

}  // namespace limber
