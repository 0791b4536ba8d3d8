// InputQueue: events of mouse and keyboard in their order, distributed over frames of Dear ImGui: a press and a release
// within one frame become two frames, so that none is lost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace limber {

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

struct InputEvent {
  enum class Kind : std::uint8_t { move, button, wheel, key, text, focus };
  Kind kind = Kind::move;
  double x = 0, y = 0;  ///< Pixels of the picture; of a wheel: steps.
  int button = 0;       ///< 0 left, 1 right, 2 middle.
  GuiKey key = GuiKey::none;
  bool down = false;  ///< A button, a key; of focus: the window has it.
  KeyMods mods = {};
  std::uint32_t letter = 0;  ///< Unicode.
};

/// A key that went down, for hotkeys.
struct KeyPress {
  GuiKey key = GuiKey::none;
  KeyMods mods = {};
  bool operator==(const KeyPress&) const = default;
};

class InputQueue {
 public:
  static constexpr std::size_t kMost = 4096;  ///< More events than that wait for nobody: the oldest go.

  void push(const InputEvent& event);
  bool empty() const { return events_.empty(); }
  /// Tells the current context what of it belongs to the next frame; gives the keys that go down in it.
  std::vector<KeyPress> frame();
  double x() const { return x_; }
  double y() const { return y_; }

 private:
  // what a frame has been told of already
  struct Taken {
    std::vector<KeyPress> pressed;
    std::array<bool, 3> buttons{};
    std::array<bool, static_cast<std::size_t>(GuiKey::count)> keys{};
    bool any_button = false;
    bool moved = false;  // with a button held
    bool any_key = false;
    bool any_text = false;
  };
  bool take(const InputEvent& event, Taken& taken);
  bool take_button(const InputEvent& event, Taken& taken);
  static bool take_key(const InputEvent& event, Taken& taken);

  std::deque<InputEvent> events_;
  std::array<bool, 3> held_{};  // buttons, as reported to Dear ImGui
  double x_ = -1, y_ = -1;
};

}  // namespace limber
