// The implementations for all supported versions.
#include "ui/panel/imgui/imgui_versions.h"

#include <iterator>

#include <imgui_impl_opengl3.h>
#include <imgui_internal.h>

#define LIMBER_IMGUI_EVENTS (IMGUI_VERSION_NUM >= 18900)  // event queue instead of key arrays
#ifdef IMGUI_HAS_TEXTURES
#define LIMBER_IMGUI_TEXTURES 1  // 1.92: the renderer updates the font texture
#else
#define LIMBER_IMGUI_TEXTURES 0
#endif

namespace limber::panel::imgui {

namespace {

struct KeyPair {
  GuiKey key;
  ImGuiKey imgui_key;
};
constexpr KeyPair kKeys[] = {{GuiKey::tab, ImGuiKey_Tab},
                             {GuiKey::left, ImGuiKey_LeftArrow},
                             {GuiKey::right, ImGuiKey_RightArrow},
                             {GuiKey::up, ImGuiKey_UpArrow},
                             {GuiKey::down, ImGuiKey_DownArrow},
                             {GuiKey::page_up, ImGuiKey_PageUp},
                             {GuiKey::page_down, ImGuiKey_PageDown},
                             {GuiKey::home, ImGuiKey_Home},
                             {GuiKey::end, ImGuiKey_End},
                             {GuiKey::insert, ImGuiKey_Insert},
                             {GuiKey::erase, ImGuiKey_Delete},
                             {GuiKey::backspace, ImGuiKey_Backspace},
                             {GuiKey::space, ImGuiKey_Space},
                             {GuiKey::enter, ImGuiKey_Enter},
                             {GuiKey::escape, ImGuiKey_Escape},
                             {GuiKey::a, ImGuiKey_A},
                             {GuiKey::c, ImGuiKey_C},
                             {GuiKey::v, ImGuiKey_V},
                             {GuiKey::x, ImGuiKey_X},
                             {GuiKey::y, ImGuiKey_Y},
                             {GuiKey::z, ImGuiKey_Z}};

// The field with the font's height has another name since 1.92.
template <class Font>
float height_of(const Font& font) {
  if constexpr (requires { font.LegacySize; }) {
    return font.LegacySize;
  } else {
    return font.FontSize;
  }
}

// An argument was removed in 1.91.
template <class List>
void ellipsis(List* list, const ImVec2& low, const ImVec2& high, const char* begin, const char* end) {
  if constexpr (requires { ImGui::RenderTextEllipsis(list, low, high, high.x, high.x, begin, end, nullptr); }) {
    ImGui::RenderTextEllipsis(list, low, high, high.x, high.x, begin, end, nullptr);
  } else {
    ImGui::RenderTextEllipsis(list, low, high, high.x, begin, end, nullptr);
  }
}

// A parameter was added in 1.89; the field with its value has another name since 1.91.
template <class Rect, class Item>
bool hoverable(const Rect& box, ImGuiID id, const Item& item) {
  if constexpr (requires { item.ItemFlags; }) {
    return ImGui::ItemHoverable(box, id, item.ItemFlags);
  } else if constexpr (requires { ImGui::ItemHoverable(box, id, item.InFlags); }) {
    return ImGui::ItemHoverable(box, id, item.InFlags);
  } else {
    return ImGui::ItemHoverable(box, id);
  }
}

}  // namespace

#if LIMBER_IMGUI_EVENTS

void start_input(ImGuiIO& io) { io.ConfigInputTrickleEventQueue = false; }

void set_mods(ImGuiIO& io, const KeyMods& mods) {
  io.AddKeyEvent(ImGuiMod_Ctrl, mods.ctrl);
  io.AddKeyEvent(ImGuiMod_Shift, mods.shift);
  io.AddKeyEvent(ImGuiMod_Alt, mods.alt);
}

void set_key(ImGuiIO& io, GuiKey key, bool down) {
  for (const KeyPair& named : kKeys) {
    if (named.key == key) io.AddKeyEvent(named.imgui_key, down);
  }
}

void set_button(ImGuiIO& io, int button, bool down) { io.AddMouseButtonEvent(button, down); }
void set_position(ImGuiIO& io, float x, float y) { io.AddMousePosEvent(x, y); }
void add_wheel(ImGuiIO& io, float x, float y) { io.AddMouseWheelEvent(x, y); }

void release_all(ImGuiIO& io) {
  for (int button = 0; button < static_cast<int>(std::size(io.MouseDown)); button++)
    io.AddMouseButtonEvent(button, false);
  for (const KeyPair& named : kKeys) io.AddKeyEvent(named.imgui_key, false);
  set_mods(io, {});
  io.AddFocusEvent(false);
}

Activation activation(ImGuiID id, bool hovered) {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  const bool clicked = hovered && g.IO.MouseClicked[0];
  const bool by_keys = g.NavActivateId == id;
  if (clicked) ImGui::SetKeyOwner(ImGuiKey_MouseLeft, id);
  const bool by_text = by_keys && (g.NavActivateFlags & ImGuiActivateFlags_PreferInput) != 0;
  return {.active = clicked || by_keys, .by_text = (clicked && g.IO.KeyCtrl) || by_text};
}

#else

void start_input(ImGuiIO& io) {
  for (const KeyPair& named : kKeys) io.KeyMap[named.imgui_key] = static_cast<int>(named.key);
}

void set_mods(ImGuiIO& io, const KeyMods& mods) {
  io.KeyCtrl = mods.ctrl;
  io.KeyShift = mods.shift;
  io.KeyAlt = mods.alt;
}

void set_key(ImGuiIO& io, GuiKey key, bool down) { io.KeysDown[static_cast<std::size_t>(key)] = down; }
void set_button(ImGuiIO& io, int button, bool down) { io.MouseDown[button] = down; }
void set_position(ImGuiIO& io, float x, float y) { io.MousePos = {x, y}; }

void add_wheel(ImGuiIO& io, float x, float y) {
  io.MouseWheelH += x;
  io.MouseWheel += y;
}

void release_all(ImGuiIO& io) {
  for (bool& down : io.MouseDown) down = false;
  for (bool& down : io.KeysDown) down = false;
  set_mods(io, {});
  io.AddFocusEvent(false);
}

Activation activation(ImGuiID id, bool hovered) {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  const bool tabbed = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) != 0;
  const bool clicked = hovered && g.IO.MouseClicked[0];
  const bool by_text = tabbed || (clicked && g.IO.KeyCtrl) || g.NavActivateInputId == id;
  return {.active = clicked || by_text || g.NavActivateId == id, .by_text = by_text};
}

#endif

bool builds_fonts() {
#if LIMBER_IMGUI_TEXTURES
  return (ImGui::GetIO().BackendFlags & ImGuiBackendFlags_RendererHasTextures) == 0;
#else
  return true;
#endif
}

void publish_fonts(bool draws, bool has_texture) {
  if (!draws) ImGui::GetIO().Fonts->SetTexID(ImTextureID{});
#if !LIMBER_IMGUI_TEXTURES
  if (draws && has_texture) {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
#else
  static_cast<void>(has_texture);
#endif
}

float font_height(const ImFont& font) { return height_of(font); }

// a pointer until 1.91.3, then a number
ImTextureID texture_id(std::uint32_t name) { return (ImTextureID)(std::uintptr_t)name; }

void text_ellipsis(const ImVec2& low, const ImVec2& high, const std::string& text) {
  ellipsis(ImGui::GetWindowDrawList(), low, high, text.c_str(), text.c_str() + text.size());
}

bool is_hovered(const ImRect& box, ImGuiID id) { return hoverable(box, id, ImGui::GetCurrentContext()->LastItemData); }

}  // namespace limber::panel::imgui
