// What the keys of a keyboard mean: shortcuts follow the letter that the layout prints on a key. [any]
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "gui/hotkeys.h"

namespace limber {

class KeyLayout {
 public:
  /// What the layout prints on a key without Shift, UTF-8; empty: nothing. Keys are GLFW's, by their place on a US
  /// keyboard.
  using Printed = std::function<std::string(int key)>;
  explicit KeyLayout(const Printed& printed);

  /// The key that prints its letter, digit or sign. A letter that the layout prints nowhere (Cyrillic) stays at its
  /// place on a US keyboard; so do digits where all of them need Shift (AZERTY). `key`: GLFW's.
  GuiKey key(int key) const;
  /// What is printed on the keys that stay at their place.
  const KeyLabels& labels() const { return labels_; }

 private:
  static constexpr std::size_t kPrinting = 96 - 39 + 1;  // from GLFW_KEY_APOSTROPHE to GLFW_KEY_GRAVE_ACCENT
  std::array<GuiKey, kPrinting> keys_{};
  KeyLabels labels_;
};

}  // namespace limber
