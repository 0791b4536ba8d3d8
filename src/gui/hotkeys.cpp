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
    Hotkey{{GuiKey::r, kCtrlShift}, A::play_take, "Ctrl+Shift+R", "play the newest take; end it"},
    Hotkey{{GuiKey::backspace, kCtrl}, A::reset, "Ctrl+Backspace", "the scene from its start", true},
    Hotkey{{GuiKey::digit_1, {}}, A::recall, "1 .. 8", "recall a preset", false, 8},
    Hotkey{{GuiKey::z, kCtrl}, A::undo, "Ctrl+Z", "undo an edit"},
    Hotkey{{GuiKey::z, kCtrlShift}, A::redo, "Ctrl+Shift+Z", "redo it"},
    Hotkey{{GuiKey::y, kCtrl}, A::redo, "Ctrl+Y", "redo it"},
    Hotkey{{GuiKey::f, kCtrl}, A::search, "Ctrl+F", "search parameters", true},
    Hotkey{{GuiKey::up, kCtrl}, A::earlier, "Ctrl+Up", "the chosen behaviour acts earlier"},
    Hotkey{{GuiKey::down, kCtrl}, A::later, "Ctrl+Down", "later"},
    Hotkey{{GuiKey::equal, kCtrl}, A::larger, "Ctrl+=", "larger text", true},
    Hotkey{{GuiKey::minus, kCtrl}, A::smaller, "Ctrl+-", "smaller text", true},
    Hotkey{{GuiKey::home, {}}, A::home_view, "Home", "the view as it was at first"},
    Hotkey{{GuiKey::digit_1, kCtrl}, A::go_to_view, "Ctrl+1 .. 9", "a view that was kept", false, 9},
    Hotkey{{GuiKey::digit_1, kCtrlShift}, A::keep_view, "Ctrl+Shift+1 .. 9", "keep this view", false, 9},
    Hotkey{{GuiKey::f1, {}}, A::hide, "F1", "hide the panel", true},
    Hotkey{{GuiKey::f2, {}}, A::help, "F2", "this help", true},
    Hotkey{{GuiKey::f3, {}}, A::overlay, "F3", "joints, contacts, forces, targets over the picture", true},
    Hotkey{{GuiKey::f10, {}}, A::output, "F10", "a window of the picture alone, and away with it", true},
    Hotkey{{GuiKey::f11, {}}, A::full_screen, "F11", "the whole screen, and back: that window, else this one", true},
};

}  // namespace

std::span<const Hotkey> hotkeys() { return kHotkeys; }

const Hotkey* hotkey_of(const KeyPress& press, bool typing) {
  for (const Hotkey& hotkey : kHotkeys) {
    const int further = static_cast<int>(press.key) - static_cast<int>(hotkey.press.key);
    const bool is = press.mods == hotkey.press.mods && further >= 0 && further < hotkey.keys;
    if (is && (!typing || hotkey.while_typing)) return &hotkey;
  }
  return nullptr;
}

}  // namespace limber
