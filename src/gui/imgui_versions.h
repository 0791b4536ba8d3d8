// The differences between Dear ImGui 1.86 (Debian 12), 1.90 (Debian 13) and 1.92. No other file asks for the version.
#pragma once

#include <string>

#include <imgui.h>

#include "gui/input.h"

struct ImRect;

namespace limber::imgui {

/// Prepares a new context for the functions below: keys, and no distribution of events over frames besides
/// InputQueue's.
void start_input(ImGuiIO& io);
void set_mods(ImGuiIO& io, const KeyMods& mods);
void set_key(ImGuiIO& io, GuiKey key, bool down);
void set_button(ImGuiIO& io, int button, bool down);
void set_position(ImGuiIO& io, float x, float y);
void add_wheel(ImGuiIO& io, float x, float y);
/// Releases every key and button, as the window has lost the focus.
void release_all(ImGuiIO& io);

/// Height of a font in pixels.
float font_height(const ImFont& font);
/// False if glyphs are drawn into the font texture when they are first used; else all of them are when fonts are
/// loaded.
bool builds_fonts();
/// Publishes fonts that were loaded; without `paints` there is no texture. `replaces`: the renderer has a texture of
/// earlier ones.
void publish_fonts(bool paints, bool replaces);

/// One line of text in a rectangle, with "…" at its end where it is too long.
void text_ellipsis(const ImVec2& low, const ImVec2& high, const std::string& text);

/// What makes a slider or drag widget active in this frame.
struct Activation {
  bool active = false;
  bool by_text = false;  ///< With a text field in its place.
};
/// `box`, `id`: the last item's.
bool is_hovered(const ImRect& box, ImGuiID id);
Activation activation(ImGuiID id, bool hovered);

}  // namespace limber::imgui
