// The table.
#include "gui/hotkeys.h"

#include <array>

namespace limber {

namespace {

using A = HotkeyAction;
constexpr KeyMods kCtrl{true, false, false};
constexpr KeyMods kShift{false, true, false};
constexpr KeyMods kCtrlShift{true, true, false};

constexpr std::array kHotkeys = {
    Hotkey{{GuiKey::period, kCtrl}, A::panic, "Ctrl+.", "panic: all comes to rest; again: the show goes on", true},
    Hotkey{{GuiKey::space, {}}, A::play_pause, "Space", "play, pause"},
    Hotkey{{GuiKey::period, {}}, A::step, ".", "one tick"},
    Hotkey{{GuiKey::comma, {}}, A::step_back, ",", "one tick back"},
    Hotkey{{GuiKey::comma, kShift}, A::rewind, "Shift+,", "two seconds back"},
    Hotkey{{GuiKey::r, kCtrl}, A::record, "Ctrl+R", "record a take, from the scene's start; end it"},
    Hotkey{{GuiKey::backspace, kCtrl}, A::reset, "Ctrl+Backspace", "the scene from its start", true},
    Hotkey{{GuiKey::digit_1, {}}, A::recall, "1 .. 8", "recall a preset"},
    Hotkey{{GuiKey::z, kCtrl}, A::undo, "Ctrl+Z", "undo an edit"},
    Hotkey{{GuiKey::z, kCtrlShift}, A::redo, "Ctrl+Shift+Z", "redo it"},
    Hotkey{{GuiKey::y, kCtrl}, A::redo, "Ctrl+Y", "redo it"},
    Hotkey{{GuiKey::f, kCtrl}, A::search, "Ctrl+F", "search parameters", true},
    Hotkey{{GuiKey::equal, kCtrl}, A::larger, "Ctrl+=", "larger text", true},
    Hotkey{{GuiKey::minus, kCtrl}, A::smaller, "Ctrl+-", "smaller text", true},
    Hotkey{{GuiKey::home, {}}, A::home_view, "Home", "the view as it was at first"},
    Hotkey{{GuiKey::f1, {}}, A::hide, "F1", "hide the panel", true},
    Hotkey{{GuiKey::f2, {}}, A::help, "F2", "this help", true},
    Hotkey{{GuiKey::f11, {}}, A::full_screen, "F11", "the whole screen, and back", true},
};

}  // namespace

std::span<const Hotkey> hotkeys() { return kHotkeys; }

const Hotkey* hotkey_of(const KeyPress& press, bool typing) {
  const bool digit = press.key >= GuiKey::digit_1 && press.key <= GuiKey::digit_8 && press.mods == KeyMods{};
  for (const Hotkey& hotkey : kHotkeys) {
    const bool is = hotkey.action == A::recall ? digit : hotkey.press == press;
    if (is && (!typing || hotkey.while_typing)) return &hotkey;
  }
  return nullptr;
}

}  // namespace limber
