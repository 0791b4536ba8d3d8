// InputQueue: mouse and keyboard events in order, distributed over frames of Dear ImGui: a press and a release within
// one frame are delivered in two frames, so that none is lost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace limber::panel {

/// Keys by their meaning; independent of the window system.
enum class GuiKey : std::uint8_t {
  none,
  tab,
  left,
  right,
  up,
  down,
  page_up,
  page_down,
  home,
  end,
  insert,
  erase,
  backspace,
  space,
  enter,
  escape,
  period,
  comma,
  minus,
  equal,
  slash,
  f1,
  f2,
  f3,
  f4,
  f5,
  f6,
  f7,
  f8,
  f9,
  f10,
  f11,
  f12,
  digit_0,
  digit_1,
  digit_2,
  digit_3,
  digit_4,
  digit_5,
  digit_6,
  digit_7,
  digit_8,
  digit_9,
  a,
  b,
  c,
  d,
  e,
  f,
  g,
  h,
  i,
  j,
  k,
  l,
  m,
  n,
  o,
  p,
  q,
  r,
  s,
  t,
  u,
  v,
  w,
  x,
  y,
  z,
  count
};

struct KeyMods {
  bool ctrl = false, shift = false, alt = false;
  bool operator==(const KeyMods&) const = default;
};

/// One event of the mouse, the keyboard or the window's focus.
struct InputEvent {
  enum class Kind : std::uint8_t { move, button, wheel, key, text, focus };
  Kind kind = Kind::move;
  double x = 0, y = 0;  ///< Pixels of the view; for a wheel: steps.
  int button = 0;       ///< 0 left, 1 right, 2 middle.
  GuiKey key = GuiKey::none;
  bool down = false;  ///< Button or key pressed; for focus: gained.
  KeyMods mods = {};
  std::uint32_t character = 0;  ///< Unicode.
};

/// A key press, for hotkeys.
struct KeyPress {
  GuiKey key = GuiKey::none;
  KeyMods mods = {};
  bool operator==(const KeyPress&) const = default;
};

class InputQueue {
 public:
  static constexpr std::size_t kMaxEvents = 4096;  ///< If there are more events, the oldest is dropped.

  void push(const InputEvent& event);
  bool empty() const { return events_.empty(); }
  /// Passes the next frame's events to the current context. Returns the keys pressed in it.
  std::vector<KeyPress> next_frame();
  double x() const { return x_; }
  double y() const { return y_; }

 private:
  // events already delivered in this frame
  struct Delivered {
    std::vector<KeyPress> pressed;
    std::array<bool, 3> buttons{};
    std::array<bool, static_cast<std::size_t>(GuiKey::count)> keys{};
    bool any_button = false;
    bool moved = false;  // with a pressed button
    bool any_key = false;
    bool any_text = false;
  };
  bool deliver(const InputEvent& event, Delivered& delivered);
  bool deliver_button(const InputEvent& event, Delivered& delivered);
  static bool deliver_key(const InputEvent& event, Delivered& delivered);

  std::deque<InputEvent> events_;
  std::array<bool, 3> pressed_buttons_{};  // as reported to Dear ImGui
  double x_ = -1, y_ = -1;
};

}  // namespace limber::panel
