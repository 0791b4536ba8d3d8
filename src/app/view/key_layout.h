// KeyLayout: maps the keys of a keyboard to shortcuts by the letters that the layout prints on them. [any]
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "ui/panel/hotkeys.h"

namespace limber::app {

/// The current layout of the keyboard.
class KeyLayout {
 public:
  /// Returns the text that the layout prints on a key without Shift, in UTF-8; empty: none. `key`: GLFW's key code,
  /// which is the position on a US keyboard.
  using PrintedText = std::function<std::string(int key)>;
  explicit KeyLayout(const PrintedText& printed);

  /// Returns the key for the letter, digit or sign printed on `key` (GLFW's code). A letter that the layout doesn't
  /// have (Cyrillic) stays at its position on a US keyboard; so do digits if all of them need Shift (AZERTY).
  panel::GuiKey key(int key) const;
  /// Printed text of the keys that stay at their US position.
  const panel::KeyLabels& labels() const { return labels_; }

 private:
  static constexpr std::size_t kPrinting = 96 - 39 + 1;  // from GLFW_KEY_APOSTROPHE to GLFW_KEY_GRAVE_ACCENT
  std::array<panel::GuiKey, kPrinting> keys_{};
  panel::KeyLabels labels_;
};

}  // namespace limber::app
