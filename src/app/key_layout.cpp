// Keys are assigned by what is printed on them, and those that remain by their place.
#include "app/key_layout.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

namespace limber {

namespace {

struct KeyName {
  int glfw;
  GuiKey key;
};
constexpr KeyName kKeys[] = {{GLFW_KEY_TAB, GuiKey::tab},
                             {GLFW_KEY_LEFT, GuiKey::left},
                             {GLFW_KEY_RIGHT, GuiKey::right},
                             {GLFW_KEY_UP, GuiKey::up},
                             {GLFW_KEY_DOWN, GuiKey::down},
                             {GLFW_KEY_PAGE_UP, GuiKey::page_up},
                             {GLFW_KEY_PAGE_DOWN, GuiKey::page_down},
                             {GLFW_KEY_HOME, GuiKey::home},
                             {GLFW_KEY_END, GuiKey::end},
                             {GLFW_KEY_INSERT, GuiKey::insert},
                             {GLFW_KEY_DELETE, GuiKey::erase},
                             {GLFW_KEY_BACKSPACE, GuiKey::backspace},
                             {GLFW_KEY_SPACE, GuiKey::space},
                             {GLFW_KEY_ENTER, GuiKey::enter},
                             {GLFW_KEY_KP_ENTER, GuiKey::enter},
                             {GLFW_KEY_ESCAPE, GuiKey::escape},
                             {GLFW_KEY_PERIOD, GuiKey::period},
                             {GLFW_KEY_COMMA, GuiKey::comma},
                             {GLFW_KEY_MINUS, GuiKey::minus},
                             {GLFW_KEY_KP_SUBTRACT, GuiKey::minus},
                             {GLFW_KEY_EQUAL, GuiKey::equal},
                             {GLFW_KEY_KP_ADD, GuiKey::equal},
                             {GLFW_KEY_SLASH, GuiKey::slash}};

// GLFW's own order within these runs is ours
GuiKey by_place(int key) {
  const auto run = [&](int first, int last, GuiKey begin) {
    return key >= first && key <= last ? static_cast<GuiKey>(static_cast<int>(begin) + key - first) : GuiKey::none;
  };
  for (const GuiKey found : {run(GLFW_KEY_A, GLFW_KEY_Z, GuiKey::a), run(GLFW_KEY_0, GLFW_KEY_9, GuiKey::digit_0),
                             run(GLFW_KEY_F1, GLFW_KEY_F12, GuiKey::f1)}) {
    if (found != GuiKey::none) return found;
  }
  const auto* const named =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&](const KeyName& k) { return k.glfw == key; });
  return named == std::end(kKeys) ? GuiKey::none : named->key;
}

// the key of a letter, digit or sign
GuiKey by_letter(const std::string& printed) {
  if (printed.size() != 1) return GuiKey::none;
  const char c = printed[0];
  if (c >= 'a' && c <= 'z') return by_place(GLFW_KEY_A + c - 'a');
  const std::string_view others = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-=/";  // GLFW's numbers are ASCII
  return others.find(c) == std::string_view::npos ? GuiKey::none : by_place(c);
}

// a key that exists; GLFW reports an error for others
bool prints(int key) {
  return by_place(key) != GuiKey::none ||
         std::string_view("';[\\]`").find(static_cast<char>(key)) != std::string_view::npos;
}

bool is_digit(int key) { return key >= GLFW_KEY_0 && key <= GLFW_KEY_9; }

}  // namespace

KeyLayout::KeyLayout(const Printed& printed) {
  static_assert(GLFW_KEY_GRAVE_ACCENT - GLFW_KEY_APOSTROPHE + 1 == kPrinting);
  std::array<std::string, kPrinting> names;
  bool digits = false;
  for (std::size_t i = 0; i < kPrinting; i++) {
    const int key = GLFW_KEY_APOSTROPHE + static_cast<int>(i);
    if (prints(key)) names[i] = printed(key);
    digits |= names[i].size() == 1 && is_digit(names[i][0]);
  }
  std::set<GuiKey> used;
  for (std::size_t i = 0; i < kPrinting; i++) {
    const int place = GLFW_KEY_APOSTROPHE + static_cast<int>(i);
    const GuiKey key = is_digit(place) && !digits ? by_place(place) : by_letter(names[i]);
    if (key != GuiKey::none && used.insert(key).second) keys_[i] = key;
  }
  for (std::size_t i = 0; i < kPrinting; i++) {
    const GuiKey key = by_place(GLFW_KEY_APOSTROPHE + static_cast<int>(i));
    if (keys_[i] != GuiKey::none || key == GuiKey::none || !used.insert(key).second) continue;
    keys_[i] = key;
    if (!names[i].empty()) labels_[key] = names[i];
  }
}

GuiKey KeyLayout::key(int key) const {
  const int place = key - GLFW_KEY_APOSTROPHE;
  if (place < 0 || place >= static_cast<int>(kPrinting)) return by_place(key);
  return keys_[static_cast<std::size_t>(place)];
}

}  // namespace limber
