// Delivers events to Dear ImGui, as many per frame as are unambiguous.
#include "ui/panel/imgui/input.h"

#include <utility>

#include "ui/panel/imgui/imgui_versions.h"

namespace limber::panel {

namespace {

// Keys that edit text by themselves; characters arrive as separate text events.
bool edits_text(GuiKey key) { return key > GuiKey::none && key < GuiKey::period && key != GuiKey::space; }

}  // namespace

void InputQueue::push(const InputEvent& event) {
  const bool moves = event.kind == InputEvent::Kind::move;
  if (moves && !events_.empty() && events_.back().kind == InputEvent::Kind::move) events_.pop_back();
  if (events_.size() >= kMaxEvents) events_.pop_front();
  events_.push_back(event);
}

bool InputQueue::deliver_button(const InputEvent& event, Delivered& delivered) {
  if (event.button < 0 || event.button > 2) return true;
  if (delivered.buttons[static_cast<std::size_t>(event.button)] || delivered.any_key || delivered.any_text)
    return false;
  if (!event.down && delivered.moved) return false;  // deliver the end of the drag before the release
  delivered.buttons[static_cast<std::size_t>(event.button)] = delivered.any_button = true;
  ImGuiIO& io = ImGui::GetIO();
  imgui::set_mods(io, event.mods);
  imgui::set_button(io, event.button, event.down);
  pressed_buttons_[static_cast<std::size_t>(event.button)] = event.down;
  return true;
}

bool InputQueue::deliver_key(const InputEvent& event, Delivered& delivered) {
  ImGuiIO& io = ImGui::GetIO();
  if (event.key == GuiKey::none) {  // only a modifier changed
    if (delivered.any_button || delivered.any_text) return false;
    imgui::set_mods(io, event.mods);
    return true;
  }
  const auto key = static_cast<std::size_t>(event.key);
  // The key of a character has no effect by itself, so several of them can be delivered in one frame during fast
  // typing.
  const bool letter = event.key >= GuiKey::period && !event.mods.ctrl && !event.mods.alt &&
                      (event.key < GuiKey::f1 || event.key > GuiKey::f12);
  if ((delivered.keys[key] && !letter) || delivered.any_button || (delivered.any_text && !letter)) return false;
  delivered.keys[key] = true;
  delivered.any_key |= edits_text(event.key);
  imgui::set_mods(io, event.mods);
  imgui::set_key(io, event.key, event.down);
  if (event.down) delivered.pressed.push_back({event.key, event.mods});
  return true;
}

// Returns false if the event belongs to the next frame.
bool InputQueue::deliver(const InputEvent& event, Delivered& delivered) {
  ImGuiIO& io = ImGui::GetIO();
  switch (event.kind) {
    case InputEvent::Kind::move:
      if (delivered.any_button) return false;  // a press happens at the position of its own frame
      delivered.moved = pressed_buttons_[0] || pressed_buttons_[1] || pressed_buttons_[2];
      x_ = event.x;
      y_ = event.y;
      imgui::set_position(io, static_cast<float>(x_), static_cast<float>(y_));
      return true;
    case InputEvent::Kind::button:
      return deliver_button(event, delivered);
    case InputEvent::Kind::wheel:
      imgui::add_wheel(io, static_cast<float>(event.x), static_cast<float>(event.y));
      return true;
    case InputEvent::Kind::key:
      return deliver_key(event, delivered);
    case InputEvent::Kind::text:
      if (delivered.any_button || delivered.any_key) return false;
      delivered.any_text = true;
      io.AddInputCharacter(event.character);
      return true;
    case InputEvent::Kind::focus:
      if (event.down) {
        io.AddFocusEvent(true);
      } else {
        imgui::release_all(io);
        pressed_buttons_ = {};
      }
      return true;
  }
  return true;
}

std::vector<KeyPress> InputQueue::next_frame() {
  Delivered delivered;
  while (!events_.empty() && deliver(events_.front(), delivered)) events_.pop_front();
  return std::move(delivered.pressed);
}

}  // namespace limber::panel
