// Assigns keys by their printed letters first, the remaining keys by position.
#include "app/view/key_layout.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

namespace limber::app {

namespace {

struct KeyName {
  int glfw;
  panel::GuiKey key;
};
constexpr KeyName kKeys[] = {{GLFW_KEY_TAB, panel::GuiKey::tab},
                             {GLFW_KEY_LEFT, panel::GuiKey::left},
                             {GLFW_KEY_RIGHT, panel::GuiKey::right},
                             {GLFW_KEY_UP, panel::GuiKey::up},
                             {GLFW_KEY_DOWN, panel::GuiKey::down},
                             {GLFW_KEY_PAGE_UP, panel::GuiKey::page_up},
                             {GLFW_KEY_PAGE_DOWN, panel::GuiKey::page_down},
                             {GLFW_KEY_HOME, panel::GuiKey::home},
                             {GLFW_KEY_END, panel::GuiKey::end},
                             {GLFW_KEY_INSERT, panel::GuiKey::insert},
                             {GLFW_KEY_DELETE, panel::GuiKey::erase},
                             {GLFW_KEY_BACKSPACE, panel::GuiKey::backspace},
                             {GLFW_KEY_SPACE, panel::GuiKey::space},
                             {GLFW_KEY_ENTER, panel::GuiKey::enter},
                             {GLFW_KEY_KP_ENTER, panel::GuiKey::enter},
                             {GLFW_KEY_ESCAPE, panel::GuiKey::escape},
                             {GLFW_KEY_PERIOD, panel::GuiKey::period},
                             {GLFW_KEY_COMMA, panel::GuiKey::comma},
                             {GLFW_KEY_MINUS, panel::GuiKey::minus},
                             {GLFW_KEY_KP_SUBTRACT, panel::GuiKey::minus},
                             {GLFW_KEY_EQUAL, panel::GuiKey::equal},
                             {GLFW_KEY_KP_ADD, panel::GuiKey::equal},
                             {GLFW_KEY_SLASH, panel::GuiKey::slash}};

// GuiKey has the order of GLFW within letters, digits and function keys
panel::GuiKey key_at_position(int key) {
  const auto run = [&](int first, int last, panel::GuiKey begin) {
    return key >= first && key <= last ? static_cast<panel::GuiKey>(static_cast<int>(begin) + key - first)
                                       : panel::GuiKey::none;
  };
  for (const panel::GuiKey found :
       {run(GLFW_KEY_A, GLFW_KEY_Z, panel::GuiKey::a), run(GLFW_KEY_0, GLFW_KEY_9, panel::GuiKey::digit_0),
        run(GLFW_KEY_F1, GLFW_KEY_F12, panel::GuiKey::f1)}) {
    if (found != panel::GuiKey::none) return found;
  }
  const auto* const named =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&](const KeyName& k) { return k.glfw == key; });
  return named == std::end(kKeys) ? panel::GuiKey::none : named->key;
}

// the key of a letter, digit or sign
panel::GuiKey key_of_letter(const std::string& printed) {
  if (printed.size() != 1) return panel::GuiKey::none;
  const char c = printed[0];
  if (c >= 'a' && c <= 'z') return key_at_position(GLFW_KEY_A + c - 'a');
  const std::string_view others = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-=/";  // GLFW's key codes are ASCII
  return others.find(c) == std::string_view::npos ? panel::GuiKey::none : key_at_position(c);
}

// true for printable keys that exist; GLFW reports an error for others
bool is_printing_key(int key) {
  return key_at_position(key) != panel::GuiKey::none ||
         std::string_view("';[\\]`").find(static_cast<char>(key)) != std::string_view::npos;
}

bool is_digit(int key) { return key >= GLFW_KEY_0 && key <= GLFW_KEY_9; }

}  // namespace

KeyLayout::KeyLayout(const PrintedText& printed) {
  static_assert(GLFW_KEY_GRAVE_ACCENT - GLFW_KEY_APOSTROPHE + 1 == kPrinting);
  std::array<std::string, kPrinting> names;
  bool digits = false;
  for (std::size_t i = 0; i < kPrinting; i++) {
    const int key = GLFW_KEY_APOSTROPHE + static_cast<int>(i);
    if (is_printing_key(key)) names[i] = printed(key);
    digits |= names[i].size() == 1 && is_digit(names[i][0]);
  }
  std::set<panel::GuiKey> used;
  for (std::size_t i = 0; i < kPrinting; i++) {
    const int position = GLFW_KEY_APOSTROPHE + static_cast<int>(i);
    const panel::GuiKey key = is_digit(position) && !digits ? key_at_position(position) : key_of_letter(names[i]);
    if (key != panel::GuiKey::none && used.insert(key).second) keys_[i] = key;
  }
  for (std::size_t i = 0; i < kPrinting; i++) {
    const panel::GuiKey key = key_at_position(GLFW_KEY_APOSTROPHE + static_cast<int>(i));
    if (keys_[i] != panel::GuiKey::none || key == panel::GuiKey::none || !used.insert(key).second) continue;
    keys_[i] = key;
    if (!names[i].empty()) labels_[key] = names[i];
  }
}

panel::GuiKey KeyLayout::key(int key) const {
  const int position = key - GLFW_KEY_APOSTROPHE;
  if (position < 0 || position >= static_cast<int>(kPrinting)) return key_at_position(key);
  return keys_[static_cast<std::size_t>(position)];
}

}  // namespace limber::app
