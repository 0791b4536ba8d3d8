// Keys as text, and those that a performer chose.
#include "gui/hotkeys.h"

#include <gtest/gtest.h>

#include <set>

namespace limber {
namespace {

TEST(Hotkeys, EachHasANameAndAKeyOfItsOwn) {
  const Hotkeys hotkeys;
  std::set<std::string> names;
  for (const Hotkey& hotkey : hotkeys.all()) {
    EXPECT_TRUE(names.insert(hotkey.name).second) << hotkey.name;
    for (int i = 0; i < hotkey.keys; i++) {
      KeyPress press = hotkey.press;
      press.key = static_cast<GuiKey>(static_cast<int>(press.key) + i);
      EXPECT_EQ(hotkeys.of(press, false), &hotkey) << hotkey.name;
      EXPECT_EQ(parse_key(key_text(press)), press) << key_text(press);
    }
  }
}

TEST(Hotkeys, PanicHasAKeyThatEveryKeyboardHas) {
  const Hotkeys hotkeys;
  for (const bool typing : {false, true}) EXPECT_EQ(hotkeys.of({GuiKey::f12, {}}, typing)->action, HotkeyAction::panic);
  EXPECT_EQ(hotkeys.of({GuiKey::period, {true, false, false}}, true)->action, HotkeyAction::panic);
}

TEST(Hotkeys, ChosenKeysReplaceTheFirstOnes) {
  const Hotkeys hotkeys(KeyChoices{{"panic", "ctrl+SHIFT+p"}, {"step", "N"}, {"reset", "K"}});
  EXPECT_TRUE(hotkeys.faults().empty());
  EXPECT_EQ(hotkeys.of({GuiKey::p, {true, true, false}}, true)->action, HotkeyAction::panic);
  EXPECT_EQ(hotkeys.of({GuiKey::f12, {}}, false), nullptr);
  EXPECT_EQ(hotkeys.of({GuiKey::n, {}}, false)->action, HotkeyAction::step);
  EXPECT_EQ(hotkeys.of({GuiKey::k, {}}, false)->action, HotkeyAction::reset);
  EXPECT_EQ(hotkeys.of({GuiKey::k, {}}, true), nullptr) << "it types a letter";
  EXPECT_EQ(shown_keys(*hotkeys.named("panic"), {}), "Ctrl+Shift+P");
  EXPECT_EQ(shown_keys(*hotkeys.named("recall"), {}), "1 .. 8");
}

TEST(Hotkeys, WhatCanNotBeChosenIsSaid) {
  const auto fault = [](const std::string& name, const std::string& key) {
    const Hotkeys hotkeys(KeyChoices{{name, key}});
    EXPECT_EQ(hotkeys.faults().size(), 1u) << name << " " << key;
    EXPECT_EQ(hotkeys.all().size(), Hotkeys().all().size());
    return hotkeys.faults().empty() ? "" : hotkeys.faults().front();
  };
  EXPECT_EQ(fault("panic", "Ctrl+R"), "key 'Ctrl+R' for 'panic': this is the key of 'record'");
  EXPECT_EQ(fault("step", "5"), "key '5' for 'step': this is the key of 'recall'");
  EXPECT_EQ(fault("panic", "Hyper+R"), "key 'Hyper+R' for 'panic': this is no key; such as Ctrl+Shift+R");
  EXPECT_EQ(fault("panick", "F9"), "key 'F9' for 'panick': there is no such key to choose");
  EXPECT_EQ(fault("recall", "F9"), "key 'F9' for 'recall': there is no such key to choose");
  EXPECT_EQ(fault("play", "Escape"), "key 'Escape' for 'play': this key goes about the panel and its texts");
  for (const char* text : {"", "Ctrl+", "Ctrl", "RR", "F13"}) EXPECT_FALSE(parse_key(text)) << text;
}

}  // namespace
}  // namespace limber
