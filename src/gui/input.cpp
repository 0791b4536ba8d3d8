// Events into Dear ImGui's fields, some a frame.
#include "gui/input.h"

#include <imgui.h>

namespace limber {

namespace {

void tell_mods(ImGuiIO& io, const KeyMods& mods) {
  io.KeyCtrl = mods.ctrl;
  io.KeyShift = mods.shift;
  io.KeyAlt = mods.alt;
}

// keys that do something to a text by themselves; letters come as text beside their keys
bool acts_on_text(GuiKey key) { return key > GuiKey::none && key < GuiKey::period && key != GuiKey::space; }

void let_go(ImGuiIO& io) {
  for (bool& down : io.MouseDown) down = false;
  for (bool& down : io.KeysDown) down = false;
  tell_mods(io, {});
  io.AddFocusEvent(false);
}

}  // namespace

void InputQueue::push(const InputEvent& event) {
  const bool moves = event.kind == InputEvent::Kind::move;
  if (moves && !events_.empty() && events_.back().kind == InputEvent::Kind::move) events_.pop_back();
  if (events_.size() >= kMost) events_.pop_front();
  events_.push_back(event);
}

std::vector<KeyPress> InputQueue::frame() {
  ImGuiIO& io = ImGui::GetIO();
  std::vector<KeyPress> pressed;
  bool buttons[3] = {};
  bool keys[static_cast<std::size_t>(GuiKey::count)] = {};
  bool any_button = false;
  bool moved = false;  // with a button held
  bool any_key = false;
  bool any_text = false;
  for (; !events_.empty(); events_.pop_front()) {
    const InputEvent& event = events_.front();
    switch (event.kind) {
      case InputEvent::Kind::move:
        if (any_button) return pressed;  // a press is where the mouse was then
        moved = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
        x_ = event.x;
        y_ = event.y;
        io.MousePos = {static_cast<float>(x_), static_cast<float>(y_)};
        break;
      case InputEvent::Kind::button:
        if (event.button < 0 || event.button > 2) break;
        if (buttons[event.button] || any_key || any_text) return pressed;
        if (!event.down && moved) return pressed;  // a drag's end counts before it is let go of
        buttons[event.button] = any_button = true;
        tell_mods(io, event.mods);
        io.MouseDown[event.button] = event.down;
        break;
      case InputEvent::Kind::wheel:
        io.MouseWheelH += static_cast<float>(event.x);
        io.MouseWheel += static_cast<float>(event.y);
        break;
      case InputEvent::Kind::key: {
        const auto key = static_cast<std::size_t>(event.key);
        if (event.key == GuiKey::none) {  // a modifier alone
          if (any_button || any_text) return pressed;
          tell_mods(io, event.mods);
          break;
        }
        // a letter's key means nothing by itself: many of them fit into a frame, as fast as somebody types
        const bool letter = event.key >= GuiKey::period && !event.mods.ctrl && !event.mods.alt &&
                            (event.key < GuiKey::f1 || event.key > GuiKey::f12);
        if ((keys[key] && !letter) || any_button || (any_text && !letter)) return pressed;
        keys[key] = true;
        any_key |= acts_on_text(event.key);
        tell_mods(io, event.mods);
        io.KeysDown[key] = event.down;
        if (event.down) pressed.push_back({event.key, event.mods});
        break;
      }
      case InputEvent::Kind::text:
        if (any_button || any_key) return pressed;
        any_text = true;
        io.AddInputCharacter(event.letter);
        break;
      case InputEvent::Kind::focus:
        if (!event.down) let_go(io);
        if (event.down) io.AddFocusEvent(true);
        break;
    }
  }
  return pressed;
}

}  // namespace limber
