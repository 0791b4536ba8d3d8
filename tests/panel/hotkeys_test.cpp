// Keys as text, and rebound hotkeys.
#include "ui/panel/hotkeys.h"

#include <gtest/gtest.h>

#include <set>

namespace limber::panel {
namespace {

TEST(Hotkeys, HaveUniqueNamesAndKeys) {
  const Hotkeys hotkeys;
  std::set<std::string> names;
  for (const Hotkey& hotkey : hotkeys.all()) {
    EXPECT_TRUE(names.insert(hotkey.name).second) << hotkey.name;
    for (int i = 0; i < hotkey.key_count; i++) {
      KeyPress press = hotkey.press;
      press.key = static_cast<GuiKey>(static_cast<int>(press.key) + i);
      EXPECT_EQ(hotkeys.match(press, false), &hotkey) << hotkey.name;
      EXPECT_EQ(parse_key(key_text(press)), press) << key_text(press);
    }
  }
}

TEST(Hotkeys, PanicUsesKeyOfEveryKeyboard) {
  const Hotkeys hotkeys;
  for (const bool typing : {false, true})
    EXPECT_EQ(hotkeys.match({GuiKey::f12, {}}, typing)->action, HotkeyAction::panic);
  EXPECT_EQ(hotkeys.match({GuiKey::period, {true, false, false}}, true)->action, HotkeyAction::panic);
}

TEST(Hotkeys, BindingsReplaceDefaults) {
  const Hotkeys hotkeys(KeyBindings{{"panic", "ctrl+SHIFT+p"}, {"step", "N"}, {"reset", "K"}});
  EXPECT_TRUE(hotkeys.errors().empty());
  EXPECT_EQ(hotkeys.match({GuiKey::p, {true, true, false}}, true)->action, HotkeyAction::panic);
  EXPECT_EQ(hotkeys.match({GuiKey::f12, {}}, false), nullptr);
  EXPECT_EQ(hotkeys.match({GuiKey::n, {}}, false)->action, HotkeyAction::step_forward);
  EXPECT_EQ(hotkeys.match({GuiKey::k, {}}, false)->action, HotkeyAction::reset);
  EXPECT_EQ(hotkeys.match({GuiKey::k, {}}, true), nullptr) << "it types a letter";
  EXPECT_EQ(keys_text(*hotkeys.find("panic"), {}), "Ctrl+Shift+P");
  EXPECT_EQ(keys_text(*hotkeys.find("recall"), {}), "1 .. 8");
}

TEST(Hotkeys, FramingYieldsItsKeyToABinding) {
  const Hotkeys defaults;
  EXPECT_EQ(defaults.match({GuiKey::f, {}}, false)->action, HotkeyAction::frame_selection);
  EXPECT_EQ(defaults.match({GuiKey::a, {}}, false)->action, HotkeyAction::frame_all);
  EXPECT_EQ(defaults.match({GuiKey::f, {}}, true), nullptr) << "it types a letter";
  EXPECT_EQ(defaults.match({GuiKey::none, {}}, false), nullptr);
  const Hotkeys hotkeys(KeyBindings{{"record", "F"}, {"frame_all", "G"}, {"reset", "A"}});
  EXPECT_TRUE(hotkeys.errors().empty());
  EXPECT_EQ(hotkeys.match({GuiKey::f, {}}, false)->action, HotkeyAction::toggle_recording);
  EXPECT_EQ(hotkeys.match({GuiKey::a, {}}, false)->action, HotkeyAction::reset);
  EXPECT_EQ(hotkeys.match({GuiKey::g, {}}, false)->action, HotkeyAction::frame_all);
  EXPECT_EQ(hotkeys.match({GuiKey::none, {}}, false), nullptr);
  EXPECT_EQ(keys_text(*hotkeys.find("frame"), {}), "(no key)");
}

TEST(Hotkeys, ReportInvalidBindings) {
  const auto error = [](const std::string& name, const std::string& key) {
    const Hotkeys hotkeys(KeyBindings{{name, key}});
    EXPECT_EQ(hotkeys.errors().size(), 1u) << name << " " << key;
    EXPECT_EQ(hotkeys.all().size(), Hotkeys().all().size());
    return hotkeys.errors().empty() ? "" : hotkeys.errors().front();
  };
  EXPECT_EQ(error("panic", "Ctrl+R"), "key 'Ctrl+R' for 'panic': already used by 'record'");
  EXPECT_EQ(error("step", "5"), "key '5' for 'step': already used by 'recall'");
  EXPECT_EQ(error("panic", "Hyper+R"), "key 'Hyper+R' for 'panic': not a key; expected for example Ctrl+Shift+R");
  EXPECT_EQ(error("panick", "F9"), "key 'F9' for 'panick': hotkey not found or not configurable");
  EXPECT_EQ(error("recall", "F9"), "key 'F9' for 'recall': hotkey not found or not configurable");
  EXPECT_EQ(error("play", "Escape"), "key 'Escape' for 'play': reserved for navigation and text fields");
  for (const char* text : {"", "Ctrl+", "Ctrl", "RR", "F13"}) EXPECT_FALSE(parse_key(text)) << text;
}

}  // namespace
}  // namespace limber::panel
