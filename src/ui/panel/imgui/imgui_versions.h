// The differences between Dear ImGui 1.86 (Debian 12), 1.90 (Debian 13) and 1.92. No other file checks the version.
#pragma once

#include <cstdint>
#include <string>

#include <imgui.h>

#include "ui/panel/imgui/input.h"

struct ImRect;

namespace limber::panel::imgui {

/// Prepares a new context for the functions below: key mapping, and disables Dear ImGui's own distribution of events
/// over frames, because InputQueue does that.
void start_input(ImGuiIO& io);
/// Pass one input event to Dear ImGui.
void set_mods(ImGuiIO& io, const KeyMods& mods);
void set_key(ImGuiIO& io, GuiKey key, bool down);
void set_button(ImGuiIO& io, int button, bool down);
void set_position(ImGuiIO& io, float x, float y);
void add_wheel(ImGuiIO& io, float x, float y);
/// Releases all keys and buttons because the window has lost the focus.
void release_all(ImGuiIO& io);

/// Height of a font in pixels.
float font_height(const ImFont& font);
/// True if all glyphs are rasterized when fonts are loaded; false if each is rasterized on first use.
bool builds_fonts();
/// Publishes loaded fonts; without `draws` there is no texture. `has_texture`: the renderer already has a texture of
/// earlier fonts.
void publish_fonts(bool draws, bool has_texture);

/// Returns the texture with this OpenGL name for Dear ImGui.
ImTextureID texture_id(std::uint32_t name);

/// Draws one line of text in a rectangle, truncated with "…" if it is too long.
void text_ellipsis(const ImVec2& low, const ImVec2& high, const std::string& text);

/// Describes how a slider or drag widget is activated in this frame.
struct Activation {
  bool active = false;
  bool by_text = false;  ///< As a text field, for typing the value.
};
/// `box` and `id` of the last item.
bool is_hovered(const ImRect& box, ImGuiID id);
Activation activation(ImGuiID id, bool hovered);

}  // namespace limber::panel::imgui
