// The table, and keys as text.
#include "gui/hotkeys.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

using A = HotkeyAction;
constexpr KeyMods kCtrl{true, false, false};
constexpr KeyMods kShift{false, true, false};
constexpr KeyMods kCtrlShift{true, true, false};

constexpr std::array kHotkeys = {
    Hotkey{{GuiKey::f12, {}}, A::panic, "panic", "panic: all comes to rest; again: the show goes on", true},
    Hotkey{{GuiKey::period, kCtrl}, A::panic, "panic_2", "panic", true},
    Hotkey{{GuiKey::space, {}}, A::play_pause, "play", "play, pause"},
    Hotkey{{GuiKey::period, {}}, A::step, "step", "one tick"},
    Hotkey{{GuiKey::comma, {}}, A::step_back, "step_back", "one tick back"},
    Hotkey{{GuiKey::comma, kShift}, A::rewind, "rewind", "two seconds back"},
    Hotkey{{GuiKey::r, kCtrl}, A::record, "record", "record a take, from the scene's start; end it"},
    Hotkey{{GuiKey::r, kCtrlShift}, A::play_take, "play_take", "play the newest take; end it"},
    Hotkey{{GuiKey::backspace, kCtrl}, A::reset, "reset", "the scene from its start", true},
    Hotkey{{GuiKey::digit_1, {}}, A::recall, "recall", "recall a preset", false, 8},
    Hotkey{{GuiKey::z, kCtrl}, A::undo, "undo", "undo an edit"},
    Hotkey{{GuiKey::z, kCtrlShift}, A::redo, "redo", "redo it"},
    Hotkey{{GuiKey::y, kCtrl}, A::redo, "redo_2", "redo it"},
    Hotkey{{GuiKey::f, kCtrl}, A::search, "search", "search parameters", true},
    Hotkey{{GuiKey::up, kCtrl}, A::earlier, "earlier", "the chosen behaviour acts earlier"},
    Hotkey{{GuiKey::down, kCtrl}, A::later, "later", "later"},
    Hotkey{{GuiKey::equal, kCtrl}, A::larger, "larger", "larger text", true},
    Hotkey{{GuiKey::minus, kCtrl}, A::smaller, "smaller", "smaller text", true},
    Hotkey{{GuiKey::home, {}}, A::home_view, "home_view", "the view as it was at first"},
    Hotkey{{GuiKey::digit_1, kCtrl}, A::go_to_view, "go_to_view", "a view that was kept", false, 9},
    Hotkey{{GuiKey::digit_1, kCtrlShift}, A::keep_view, "keep_view", "keep this view", false, 9},
    Hotkey{{GuiKey::f1, {}}, A::hide, "hide", "hide the panel", true},
    Hotkey{{GuiKey::f2, {}}, A::help, "help", "this help", true},
    Hotkey{{GuiKey::f3, {}}, A::overlay, "overlay", "joints, contacts, forces, targets over the picture", true},
    Hotkey{{GuiKey::f10, {}}, A::output, "output", "a window of the picture alone, and away with it", true},
    Hotkey{{GuiKey::f11, {}},
           A::full_screen,
           "full_screen",
           "the whole screen, and back: that window, else this one",
           true},
};

// from GuiKey::tab to slash
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

// whether it types a letter or edits a text
bool types(const KeyPress& press) {
  const bool function = press.key >= GuiKey::f1 && press.key <= GuiKey::f12;
  return !press.mods.ctrl && !press.mods.alt && !function;
}

std::string_view name_of(const Hotkey& hotkey) { return hotkey.name; }

bool means(const Hotkey& hotkey, const KeyPress& press) {
  const int further = static_cast<int>(press.key) - static_cast<int>(hotkey.press.key);
  return press.mods == hotkey.press.mods && further >= 0 && further < hotkey.keys;
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

Hotkeys::Hotkeys(const KeyChoices& chosen) : list_(kHotkeys.begin(), kHotkeys.end()) {
  for (const auto& [name, text] : chosen) {
    const std::optional<KeyPress> press = parse_key(text);
    const auto hotkey = std::ranges::find(list_, std::string_view(name), name_of);
    std::string why;
    if (hotkey == list_.end() || hotkey->keys > 1) {
      why = "there is no such key to choose";
    } else if (!press) {
      why = "this is no key; such as Ctrl+Shift+R";
    } else {
      why = against(name, *press);
    }
    if (why.empty()) {
      hotkey->press = *press;
    } else {
      faults_.push_back(fmt::format("key '{}' for '{}': {}", printable(text), printable(name), why));
    }
  }
}

const Hotkey* Hotkeys::named(std::string_view name) const {
  const auto hotkey = std::ranges::find(list_, name, name_of);
  return hotkey == list_.end() ? nullptr : &*hotkey;
}

const Hotkey* Hotkeys::of(const KeyPress& press, bool typing) const {
  for (const Hotkey& hotkey : list_) {
    if (means(hotkey, press) && (!typing || (hotkey.while_typing && !types(press)))) return &hotkey;
  }
  return nullptr;
}

std::string Hotkeys::against(std::string_view name, const KeyPress& press) const {
  if (types(press) && press.key <= GuiKey::escape && press.key != GuiKey::space && press.key != GuiKey::home)
    return "this key goes about the panel and its texts";
  for (const Hotkey& other : list_) {
    if (other.name != name && means(other, press)) return fmt::format("this is the key of '{}'", other.name);
  }
  return {};
}

std::string shown_keys(const Hotkey& hotkey, const KeyLabels& labels) {
  std::string text = key_text(hotkey.press, labels);
  if (hotkey.keys == 1) return text;
  return fmt::format("{} .. {}", text,
                     key_name(static_cast<GuiKey>(static_cast<int>(hotkey.press.key) + hotkey.keys - 1)));
}

}  // namespace limber
