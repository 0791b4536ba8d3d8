// The context of Dear ImGui: its options, clipboard, fonts and renderer.
#include "ui/panel/imgui/gui_host.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <imgui_impl_opengl3.h>

#include "base/log/log.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/theme.h"

namespace limber::panel {

namespace {

void set_clipboard(void* options, const char* text) { static_cast<const GuiHostOptions*>(options)->copy(text); }
const char* get_clipboard(void* options) {
  static std::string pasted;
  pasted = static_cast<const GuiHostOptions*>(options)->paste();
  return pasted.c_str();
}

}  // namespace

GuiHost::GuiHost(const GuiHostOptions& options)
    : options_(options), context_(ImGui::CreateContext()), files_(find_fonts(options.font_root)) {
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.ConfigInputTextCursorBlink = options_.draws;
  io.ClipboardUserData = &options_;
  io.SetClipboardTextFn = set_clipboard;
  io.GetClipboardTextFn = get_clipboard;
  io.MousePos = {-1, -1};
  imgui::start_input(io);
  for (const std::string& warning : files_.warnings) log_warning("{}", warning);
  if (options_.draws && !ImGui_ImplOpenGL3_Init(options_.glsl.c_str())) {
    log_error("the panel is not available: can't load libGL.so.1. On Debian: apt-get install libgl1");
    options_.draws = false;
  }
}

GuiHost::~GuiHost() {
  make_current();
  if (options_.draws) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void GuiHost::make_current() const { ImGui::SetCurrentContext(context_); }

void GuiHost::update_fonts(const GuiFrame& frame, double text_size, const std::set<unsigned>& characters, bool reload) {
  const double pixels = std::floor(text_size * std::clamp(frame.display_scale, 0.5, 4.0));
  if (pixels == font_pixels_ && !reload) return;
  font_pixels_ = pixels;
  scale_ = pixels / 16;
  fonts_ = load_fonts(files_, pixels, characters);
  apply_theme(scale_);
  imgui::publish_fonts(options_.draws, fonts_drawn_);
}

std::vector<KeyPress> GuiHost::begin_frame(const GuiFrame& frame, double text_size,
                                           const std::set<unsigned>& characters, bool reload) {
  make_current();
  update_fonts(frame, text_size, characters, reload);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(frame.width), static_cast<float>(frame.height)};
  io.DeltaTime = static_cast<float>(std::clamp(frame.clock - last_clock_, 1e-4, 0.5));
  last_clock_ = frame.clock;
  if (options_.draws) {
    ImGui_ImplOpenGL3_NewFrame();
    fonts_drawn_ = true;
  }
  return input_.next_frame();
}

void GuiHost::render() {
  make_current();
  if (options_.draws) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace limber::panel
