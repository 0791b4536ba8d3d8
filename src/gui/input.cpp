// Events into Dear ImGui's fields, some a frame.
#include "gui/input.h"

#include <utility>

#include "gui/imgui_versions.h"

namespace limber {

namespace {

// keys that do something to a text by themselves; letters come as text beside their keys
bool acts_on_text(GuiKey key) { return key > GuiKey::none && key < GuiKey::period && key != GuiKey::space; }

}  // namespace

void InputQueue::push(const InputEvent& event) {
  const bool moves = event.kind == InputEvent::Kind::move;
  if (moves && !events_.empty() && events_.back().kind == InputEvent::Kind::move) events_.pop_back();
  if (events_.size() >= kMost) events_.pop_front();
  events_.push_back(event);
}

bool InputQueue::take_button(const InputEvent& event, Taken& taken) {
  if (event.button < 0 || event.button > 2) return true;
  if (taken.buttons[static_cast<std::size_t>(event.button)] || taken.any_key || taken.any_text) return false;
  if (!event.down && taken.moved) return false;  // a drag's end counts before it is let go of
  taken.buttons[static_cast<std::size_t>(event.button)] = taken.any_button = true;
  ImGuiIO& io = ImGui::GetIO();
  imgui::set_mods(io, event.mods);
  imgui::set_button(io, event.button, event.down);
  held_[static_cast<std::size_t>(event.button)] = event.down;
  return true;
}

bool InputQueue::take_key(const InputEvent& event, Taken& taken) {
  ImGuiIO& io = ImGui::GetIO();
  if (event.key == GuiKey::none) {  // a modifier alone
    if (taken.any_button || taken.any_text) return false;
    imgui::set_mods(io, event.mods);
    return true;
  }
  const auto key = static_cast<std::size_t>(event.key);
  // a letter's key means nothing by itself: many of them fit into a frame, as fast as somebody types
  const bool letter = event.key >= GuiKey::period && !event.mods.ctrl && !event.mods.alt &&
                      (event.key < GuiKey::f1 || event.key > GuiKey::f12);
  if ((taken.keys[key] && !letter) || taken.any_button || (taken.any_text && !letter)) return false;
  taken.keys[key] = true;
  taken.any_key |= acts_on_text(event.key);
  imgui::set_mods(io, event.mods);
  imgui::set_key(io, event.key, event.down);
  if (event.down) taken.pressed.push_back({event.key, event.mods});
  return true;
}

// false: it belongs to the next frame
bool InputQueue::take(const InputEvent& event, Taken& taken) {
  ImGuiIO& io = ImGui::GetIO();
  switch (event.kind) {
    case InputEvent::Kind::move:
      if (taken.any_button) return false;  // a press is where the mouse was then
      taken.moved = held_[0] || held_[1] || held_[2];
      x_ = event.x;
      y_ = event.y;
      imgui::set_position(io, static_cast<float>(x_), static_cast<float>(y_));
      return true;
    case InputEvent::Kind::button:
      return take_button(event, taken);
    case InputEvent::Kind::wheel:
      imgui::add_wheel(io, static_cast<float>(event.x), static_cast<float>(event.y));
      return true;
    case InputEvent::Kind::key:
      return take_key(event, taken);
    case InputEvent::Kind::text:
      if (taken.any_button || taken.any_key) return false;
      taken.any_text = true;
      io.AddInputCharacter(event.letter);
      return true;
    case InputEvent::Kind::focus:
      if (event.down) {
        io.AddFocusEvent(true);
      } else {
        imgui::release_all(io);
        held_ = {};
      }
      return true;
  }
  return true;
}

std::vector<KeyPress> InputQueue::frame() {
  Taken taken;
  while (!events_.empty() && take(events_.front(), taken)) events_.pop_front();
  return std::move(taken.pressed);
}

}  // namespace limber
