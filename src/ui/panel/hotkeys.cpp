// The table of hotkeys, and conversion of keys to and from text.
#include "ui/panel/hotkeys.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::panel {

namespace {

using A = HotkeyAction;
constexpr KeyMods kCtrl{true, false, false};
constexpr KeyMods kShift{false, true, false};
constexpr KeyMods kCtrlShift{true, true, false};

constexpr std::array kHotkeys = {
    Hotkey{{GuiKey::f12, {}}, A::panic, "panic", "Panic: stop all motion; press again to resume", true},
    Hotkey{{GuiKey::period, kCtrl}, A::panic, "panic_2", "Panic", true},
    Hotkey{{GuiKey::space, {}}, A::play_pause, "play", "Play or pause"},
    Hotkey{{GuiKey::period, {}}, A::step_forward, "step", "Step one tick"},
    Hotkey{{GuiKey::comma, {}}, A::step_back, "step_back", "Step back one tick"},
    Hotkey{{GuiKey::comma, kShift}, A::rewind, "rewind", "Rewind two seconds"},
    Hotkey{{GuiKey::r, kCtrl}, A::toggle_recording, "record", "Record a take from the start of the scene, or stop it"},
    Hotkey{{GuiKey::r, kCtrlShift}, A::toggle_take_playback, "play_take", "Play the latest take, or stop it"},
    Hotkey{{GuiKey::backspace, kCtrl}, A::reset, "reset", "Reset the scene", true},
    Hotkey{{GuiKey::digit_1, {}}, A::recall_preset, "recall", "Recall a preset", false, 8},
    Hotkey{{GuiKey::z, kCtrl}, A::undo, "undo", "Undo an edit"},
    Hotkey{{GuiKey::z, kCtrlShift}, A::redo, "redo", "Redo an edit"},
    Hotkey{{GuiKey::y, kCtrl}, A::redo, "redo_2", "Redo an edit"},
    Hotkey{{GuiKey::f, kCtrl}, A::focus_search, "search", "Search parameters", true},
    Hotkey{{GuiKey::up, kCtrl}, A::move_behavior_earlier, "earlier", "Run the selected behavior earlier"},
    Hotkey{{GuiKey::down, kCtrl}, A::move_behavior_later, "later", "Run the selected behavior later"},
    Hotkey{{GuiKey::equal, kCtrl}, A::increase_text_size, "larger", "Larger text", true},
    Hotkey{{GuiKey::minus, kCtrl}, A::decrease_text_size, "smaller", "Smaller text", true},
    Hotkey{{GuiKey::home, {}}, A::default_view, "home_view", "Default view"},
    Hotkey{{GuiKey::f, {}}, A::frame_selection, "frame", "Frame the selected object in the view", false, 1, true},
    Hotkey{{GuiKey::a, {}}, A::frame_all, "frame_all", "Frame all bodies in the view", false, 1, true},
    Hotkey{{GuiKey::digit_1, kCtrl}, A::restore_view, "go_to_view", "Restore a stored view", false, 9},
    Hotkey{{GuiKey::digit_1, kCtrlShift}, A::store_view, "keep_view", "Store this view", false, 9},
    Hotkey{{GuiKey::f1, {}}, A::toggle_panel, "hide", "Hide the panel", true},
    Hotkey{{GuiKey::f2, {}}, A::toggle_help, "help", "Show this help", true},
    Hotkey{{GuiKey::f3, {}}, A::toggle_overlay, "overlay", "Show joints, contacts, forces and targets", true},
    Hotkey{{GuiKey::l, kCtrl}, A::toggle_lights, "lights", "Arm or disarm the output to lights", true, 1, true},
    Hotkey{{GuiKey::b, kCtrl}, A::toggle_blackout, "blackout", "Blackout of all lighting fixtures", true, 1, true},
    Hotkey{{GuiKey::f5, {}}, A::next_cue, "cue_go", "Start the next cue", true, 1, true},
    Hotkey{{GuiKey::f5, kShift}, A::previous_cue, "cue_back", "Start the cue before the last one again", true, 1, true},
    Hotkey{{GuiKey::f6, {}}, A::pause_cues, "cue_pause", "Pause or resume the time until the next cue", true, 1, true},
    Hotkey{{GuiKey::f7, {}}, A::tap_tempo, "tap", "Tap the tempo: press it on each beat", true, 1, true},
    Hotkey{{GuiKey::f10, {}}, A::toggle_output_window, "output", "Open or close the output window", true},
    Hotkey{{GuiKey::f11, {}},
           A::toggle_full_screen,
           "full_screen",
           "Full screen on or off: the output window, else this one",
           true},
};

// Names of the keys from GuiKey::tab to GuiKey::slash.
constexpr std::array<std::string_view, 20> kNames = {
    "Tab",    "Left",      "Right", "Up",    "Down",   "PageUp", "PageDown", "Home", "End", "Insert",
    "Delete", "Backspace", "Space", "Enter", "Escape", ".",      ",",        "-",    "=",   "/"};
static_assert(static_cast<std::size_t>(GuiKey::slash) == kNames.size());

std::string key_name(GuiKey key) {
  const auto from = [key](GuiKey first) { return static_cast<int>(key) - static_cast<int>(first); };
  if (key == GuiKey::none) return "";
  if (key <= GuiKey::slash) return std::string(kNames[static_cast<std::size_t>(from(GuiKey::tab))]);
  if (key <= GuiKey::f12) return fmt::format("F{}", from(GuiKey::f1) + 1);
  if (key <= GuiKey::digit_9) return fmt::format("{}", from(GuiKey::digit_0));
  return std::string(1, static_cast<char>('A' + from(GuiKey::a)));
}

std::string mods_text(const KeyMods& mods) {
  return fmt::format("{}{}{}", mods.ctrl ? "Ctrl+" : "", mods.alt ? "Alt+" : "", mods.shift ? "Shift+" : "");
}

// True if the key types a character or edits text.
bool types_text(const KeyPress& press) {
  const bool function = press.key >= GuiKey::f1 && press.key <= GuiKey::f12;
  return !press.mods.ctrl && !press.mods.alt && !function;
}

std::string_view name_of(const Hotkey& hotkey) { return hotkey.name; }

bool matches(const Hotkey& hotkey, const KeyPress& press) {
  if (hotkey.press.key == GuiKey::none) return false;
  const int offset = static_cast<int>(press.key) - static_cast<int>(hotkey.press.key);
  return press.mods == hotkey.press.mods && offset >= 0 && offset < hotkey.key_count;
}

}  // namespace

std::string key_text(const KeyPress& press, const KeyLabels& labels) {
  const auto label = labels.find(press.key);
  return mods_text(press.mods) + (label == labels.end() ? key_name(press.key) : label->second);
}

std::optional<KeyPress> parse_key(std::string_view text) {
  KeyPress press;
  for (bool more = true; more;) {
    more = false;
    for (const auto& [word, mod] :
         {std::pair("ctrl+", &KeyMods::ctrl), {"alt+", &KeyMods::alt}, {"shift+", &KeyMods::shift}}) {
      const std::size_t size = std::string_view(word).size();
      if (!same_name(text.substr(0, size), word)) continue;
      press.mods.*mod = more = true;
      text.remove_prefix(size);
    }
  }
  for (int key = 1; key < static_cast<int>(GuiKey::count); key++) {
    press.key = static_cast<GuiKey>(key);
    if (same_name(text, key_name(press.key))) return press;
  }
  return std::nullopt;
}

Hotkeys::Hotkeys(const KeyBindings& bindings) : list_(kHotkeys.begin(), kHotkeys.end()) {
  for (Hotkey& hotkey : list_) {
    const auto takes_key = [&](const auto& binding) {
      return binding.first != hotkey.name && parse_key(binding.second) == hotkey.press;
    };
    if (hotkey.yields && std::ranges::any_of(bindings, takes_key)) hotkey.press = {};
  }
  for (const auto& [name, text] : bindings) {
    const std::optional<KeyPress> press = parse_key(text);
    const auto hotkey = std::ranges::find(list_, std::string_view(name), name_of);
    std::string reason;
    if (hotkey == list_.end() || hotkey->key_count > 1) {
      reason = "hotkey not found or not configurable";
    } else if (!press) {
      reason = "not a key; expected for example Ctrl+Shift+R";
    } else {
      reason = conflict(name, *press);
    }
    if (reason.empty()) {
      hotkey->press = *press;
    } else {
      errors_.push_back(fmt::format("key '{}' for '{}': {}", printable(text), printable(name), reason));
    }
  }
}

const Hotkey* Hotkeys::find(std::string_view name) const {
  const auto hotkey = std::ranges::find(list_, name, name_of);
  return hotkey == list_.end() ? nullptr : &*hotkey;
}

const Hotkey* Hotkeys::match(const KeyPress& press, bool typing) const {
  for (const Hotkey& hotkey : list_) {
    if (matches(hotkey, press) && (!typing || (hotkey.while_typing && !types_text(press)))) return &hotkey;
  }
  return nullptr;
}

std::string Hotkeys::conflict(std::string_view name, const KeyPress& press) const {
  if (types_text(press) && press.key <= GuiKey::escape && press.key != GuiKey::space && press.key != GuiKey::home)
    return "reserved for navigation and text fields";
  for (const Hotkey& other : list_) {
    if (other.name != name && matches(other, press)) return fmt::format("already used by '{}'", other.name);
  }
  return {};
}

std::string keys_text(const Hotkey& hotkey, const KeyLabels& labels) {
  if (hotkey.press.key == GuiKey::none) return "(no key)";
  std::string text = key_text(hotkey.press, labels);
  if (hotkey.key_count == 1) return text;
  return fmt::format("{} .. {}", text,
                     key_name(static_cast<GuiKey>(static_cast<int>(hotkey.press.key) + hotkey.key_count - 1)));
}

}  // namespace limber::panel
