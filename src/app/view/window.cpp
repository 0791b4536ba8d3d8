// Wraps GLFW and prevents Xlib from ending the program.
#include "app/view/window.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/view/key_layout.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber::app {

namespace {

std::function<void()> display_lost;

int handle_lost_display(void*) {
  if (display_lost) display_lost();
  std::_Exit(3);  // as Xlib would do
}

// Xlib would end the program at an invalid request, such as one for a window that was destroyed from outside
bool request_failed = false;
int handle_failed_request(void*, void*) {
  request_failed = true;
  return 0;
}

// Sets a handler of Xlib if Xlib is in use. GLFW before 3.4 links it; later versions load it privately, and Wayland
// windows don't use it.
template <class Handler>
void set_handler(const char* setter, Handler handler) {
  using Setter = Handler (*)(Handler);
  if (const auto set = reinterpret_cast<Setter>(system::find_symbol(setter))) set(handler);
}

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "unknown error of GLFW" : text;
}

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

std::string printed_on(int key) {
  const char* const name = glfwGetKeyName(key, 0);
  return name == nullptr ? "" : name;
}

panel::KeyMods key_mods(int mods) {
  return {(mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_ALT) != 0};
}

constexpr int kCornerOffset = 64;  // distance from the corner of the other screen, in its units

Window& window_of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

GLFWmonitor* monitor_of(GLFWwindow* window) {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  int count = 0;
  GLFWmonitor** const screens = glfwGetMonitors(&count);
  GLFWmonitor* best = nullptr;
  int best_area = -1;
  for (int i = 0; i < count; i++) {
    int left = 0;
    int top = 0;
    glfwGetMonitorPos(screens[i], &left, &top);
    const GLFWvidmode* const mode = glfwGetVideoMode(screens[i]);
    if (mode == nullptr) continue;
    const int across = std::min(x + width, left + mode->width) - std::max(x, left);
    const int down = std::min(y + height, top + mode->height) - std::max(y, top);
    const int area = std::max(across, 0) * std::max(down, 0);
    if (area > best_area) best = screens[i];
    best_area = std::max(best_area, area);
  }
  return best;
}

struct ContextKind {
  int client;    // GLFW_OPENGL_API, GLFW_OPENGL_ES_API
  int creation;  // GLFW_NATIVE_CONTEXT_API (GLX with X11), GLFW_EGL_CONTEXT_API
  int major, minor;
};

GLFWwindow* make_window(const char* title, int width, int height, const ContextKind& kind, bool visible = true) {
  const bool core = kind.client == GLFW_OPENGL_API && kind.major == 3 && kind.minor >= 2;
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, kind.client);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, kind.creation);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, kind.major);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, kind.minor);
  glfwWindowHint(GLFW_OPENGL_PROFILE, core ? GLFW_OPENGL_CORE_PROFILE : GLFW_OPENGL_ANY_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, core ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "limber");
  return glfwCreateWindow(width, height, title, nullptr, nullptr);
}

// EGL in addition to GLX: some X servers have no GLX, and OpenGL ES comes with EGL
std::vector<ContextKind> context_kinds(render::GlApi api) {
  const render::GlApiInfo& info = render::gl_api_info(api);
  if (!render::gl_can_load(api)) return {};
  if (api == render::GlApi::es)
    return {{GLFW_OPENGL_ES_API, GLFW_EGL_CONTEXT_API, info.major, info.minor},
            {GLFW_OPENGL_ES_API, GLFW_NATIVE_CONTEXT_API, info.major, info.minor}};
  return {{GLFW_OPENGL_API, GLFW_NATIVE_CONTEXT_API, info.major, info.minor},
          {GLFW_OPENGL_API, GLFW_EGL_CONTEXT_API, info.major, info.minor}};
}

// names of the OpenGL versions that the driver offers, of any age
std::vector<std::string> available_versions() {
  std::vector<std::string> names;
  const auto probe = [&](const char* name, std::initializer_list<ContextKind> kinds) {
    for (const ContextKind& kind : kinds) {
      GLFWwindow* const window = make_window("", 1, 1, kind, false);
      if (window == nullptr) continue;
      names.push_back(fmt::format("{} {}.{}", name, glfwGetWindowAttrib(window, GLFW_CONTEXT_VERSION_MAJOR),
                                  glfwGetWindowAttrib(window, GLFW_CONTEXT_VERSION_MINOR)));
      glfwDestroyWindow(window);
      return;
    }
  };
  probe("OpenGL", {{GLFW_OPENGL_API, GLFW_NATIVE_CONTEXT_API, 1, 0}, {GLFW_OPENGL_API, GLFW_EGL_CONTEXT_API, 1, 0}});
  probe("OpenGL ES",
        {{GLFW_OPENGL_ES_API, GLFW_EGL_CONTEXT_API, 2, 0}, {GLFW_OPENGL_ES_API, GLFW_NATIVE_CONTEXT_API, 2, 0}});
  return names;
}

}  // namespace

bool Window::has_display() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

Result<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height,
                                             std::span<const render::GlApi> apis) {
  if (!has_display())
    return Error{"no display: DISPLAY and WAYLAND_DISPLAY are not set; a desktop session or xvfb-run sets one"};
#if defined(GLFW_PLATFORM)
  // GLFW 3.4 tries Wayland first, even in sessions without it
  if (!is_set("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() != GLFW_TRUE) {
    const std::string reason = glfw_error();
    const char* const fix = is_set("DISPLAY") || reason.starts_with("Wayland")
                                ? "Set DISPLAY (and XAUTHORITY) or WAYLAND_DISPLAY as in the desktop session"
                                : "GLFW needs an X server here. On Debian: apt-get install xwayland, log in again";
    return Error{fmt::format("no window can be opened: {}. {}", reason, fix)};
  }
  request_failed = false;
  set_handler("XSetIOErrorHandler", handle_lost_display);
  set_handler("XSetErrorHandler", handle_failed_request);
  for (const render::GlApi api : apis) {
    for (const ContextKind& kind : context_kinds(api)) {
      GLFWwindow* const window = make_window(title.c_str(), width, height, kind);
      if (window != nullptr) return std::unique_ptr<Window>(new Window(window, api));
    }
  }
  const std::string error = render::gl_context_error(apis, available_versions());
  glfwTerminate();
  return Error{fmt::format("no window can be opened: {}", error)};
}

Result<std::unique_ptr<Window>> Window::open_beside(const Window& first, const std::string& title, int width,
                                                    int height) {
  GLFWmonitor* const first_monitor = monitor_of(first.window_);
  GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), nullptr, first.window_);
  if (window == nullptr) return Error{fmt::format("no second window can be opened: {}", glfw_error())};
  std::unique_ptr<Window> beside(new Window(window, first.api_));
  glfwMakeContextCurrent(first.window_);
  int count = 0;
  GLFWmonitor** const screens = glfwGetMonitors(&count);
  GLFWmonitor** const other =
      std::find_if(screens, screens + count, [&](GLFWmonitor* s) { return s != first_monitor; });
  if (other == screens + count) return beside;
  int x = 0;
  int y = 0;
  glfwGetMonitorPos(*other, &x, &y);
  glfwSetWindowPos(window, x + kCornerOffset, y + kCornerOffset);
  return beside;
}

Window::Window(GLFWwindow* window, render::GlApi api) : window_(window), api_(api) {
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, on_key);
  glfwSetCharCallback(window_, on_char);
  glfwSetMouseButtonCallback(window_, on_button);
  glfwSetCursorPosCallback(window_, on_move);
  glfwSetScrollCallback(window_, on_scroll);
  glfwSetWindowFocusCallback(window_, on_focus);
  glfwSetDropCallback(window_, on_drop);
  glfwGetCursorPos(window_, &x_, &y_);
}

// without glfwTerminate(): drivers that are unloaded leak memory
Window::~Window() { glfwDestroyWindow(window_); }

void Window::on_display_lost(std::function<void()> callback) { display_lost = std::move(callback); }

// presses and releases of modifier keys are events, too: they decide whether later letters are shortcuts
void Window::on_key(GLFWwindow* window, int key, int, int action, int) {
  if (action == GLFW_REPEAT) return;  // the panel repeats keys itself
  panel::InputEvent event{.kind = panel::InputEvent::Kind::key};
  event.key = KeyLayout(printed_on).key(key);
  event.down = action == GLFW_PRESS;
  const auto either_down = [&](int left, int right) {
    return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
  };
  event.mods = {either_down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL),
                either_down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
                either_down(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT)};
  window_of(window).events_.push_back(event);
}

void Window::on_char(GLFWwindow* window, unsigned character) {
  panel::InputEvent event{.kind = panel::InputEvent::Kind::text};
  event.character = character;
  window_of(window).events_.push_back(event);
}

void Window::on_button(GLFWwindow* window, int button, int action, int mods) {
  panel::InputEvent event{.kind = panel::InputEvent::Kind::button};
  event.button = button;
  event.down = action == GLFW_PRESS;
  event.mods = key_mods(mods);
  window_of(window).events_.push_back(event);
}

void Window::on_focus(GLFWwindow* window, int focused) {
  panel::InputEvent event{.kind = panel::InputEvent::Kind::focus};
  event.down = focused == GLFW_TRUE;
  window_of(window).events_.push_back(event);
}

void Window::on_drop(GLFWwindow* window, int count, const char** paths) {
  std::vector<std::string>& dropped = window_of(window).dropped_;
  dropped.insert(dropped.end(), paths, paths + count);
}

void Window::on_move(GLFWwindow* window, double x, double y) {
  Window& self = window_of(window);
  const double dx = x - std::exchange(self.x_, x);
  const double dy = y - std::exchange(self.y_, y);
  panel::InputEvent event{.kind = panel::InputEvent::Kind::move};
  // convert from window units to pixels, which differ on some screens
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window, &width, &height);
  event.x = width > 0 ? x * self.width() / width : x;
  event.y = height > 0 ? y * self.height() / height : y;
  self.events_.push_back(event);
  const auto button_down = [&](int button) { return glfwGetMouseButton(window, button) == GLFW_PRESS; };
  const auto key_down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
  const bool shift = key_down(GLFW_KEY_LEFT_SHIFT) || key_down(GLFW_KEY_RIGHT_SHIFT);
  if (button_down(GLFW_MOUSE_BUTTON_LEFT) && !shift) {
    self.mouse_.orbit_x += dx;
    self.mouse_.orbit_y += dy;
  } else if (button_down(GLFW_MOUSE_BUTTON_LEFT) || button_down(GLFW_MOUSE_BUTTON_RIGHT) ||
             button_down(GLFW_MOUSE_BUTTON_MIDDLE)) {
    self.mouse_.pan_x += dx;
    self.mouse_.pan_y += dy;
  }
}

void Window::on_scroll(GLFWwindow* window, double x, double y) {
  window_of(window).mouse_.wheel += y;
  panel::InputEvent event{.kind = panel::InputEvent::Kind::wheel};
  event.x = x;
  event.y = y;
  window_of(window).events_.push_back(event);
}

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

panel::KeyLabels Window::key_labels() const { return KeyLayout(printed_on).labels(); }

bool Window::closed() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

bool Window::lost() const { return request_failed; }

int Window::width() const {
  int width = 0;
  glfwGetFramebufferSize(window_, &width, nullptr);
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE ? 0 : width;
}

int Window::height() const {
  int height = 0;
  glfwGetFramebufferSize(window_, nullptr, &height);
  return height;
}

double Window::refresh_rate() const {
  GLFWmonitor* const screen = monitor_of(window_);
  const GLFWvidmode* const mode = screen == nullptr ? nullptr : glfwGetVideoMode(screen);
  return mode == nullptr || mode->refreshRate <= 0 ? 60 : mode->refreshRate;
}

double Window::content_scale() const {
  float x = 1;
  glfwGetWindowContentScale(window_, &x, nullptr);
  return x > 0 ? static_cast<double>(x) : 1;
}

std::string Window::clipboard() const {
  const char* const text = glfwGetClipboardString(window_);
  return text == nullptr ? "" : text;
}

void Window::set_clipboard(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

std::vector<panel::InputEvent> Window::consume_events() { return std::exchange(events_, {}); }
std::vector<std::string> Window::consume_dropped() { return std::exchange(dropped_, {}); }
MouseMovement Window::consume_mouse() { return std::exchange(mouse_, {}); }
void Window::set_title(const std::string& text) { glfwSetWindowTitle(window_, text.c_str()); }

bool Window::is_full_screen() const { return glfwGetWindowMonitor(window_) != nullptr; }

Result<void> Window::move_to_monitor(const std::string& which) {
  int count = 0;
  GLFWmonitor** const screens = glfwGetMonitors(&count);
  GLFWmonitor* found = nullptr;
  std::vector<std::string> names;
  const std::optional<double> number = parse_number(which);
  for (int i = count - 1; i >= 0; i--) {
    const char* const name = glfwGetMonitorName(screens[i]);
    names.insert(names.begin(), fmt::format("{} ({})", i + 1, name == nullptr ? "" : printable(name)));
    const bool named = name != nullptr && normalized_name(name).find(normalized_name(which)) != std::string::npos;
    if (number ? *number == i + 1 : named) found = screens[i];
  }
  const GLFWvidmode* const mode = found == nullptr ? nullptr : glfwGetVideoMode(found);
  if (mode == nullptr)
    return Error{fmt::format("monitor '{}' not found; available: {}", printable(which), fmt::join(names, ", "))};
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetMonitorPos(found, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  glfwSetWindowPos(window_, x + std::max(0, mode->width - width) / 2, y + std::max(0, mode->height - height) / 2);
  glfwPollEvents();  // toggle_full_screen() reads the window's position
  return {};
}

void Window::hide_pointer() { glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN); }

void Window::toggle_full_screen() {
  if (is_full_screen()) {
    glfwSetWindowMonitor(window_, nullptr, windowed_rect_[0], windowed_rect_[1], windowed_rect_[2], windowed_rect_[3],
                         GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* const screen = monitor_of(window_);
  const GLFWvidmode* const mode = screen == nullptr ? nullptr : glfwGetVideoMode(screen);
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &windowed_rect_[0], &windowed_rect_[1]);
  glfwGetWindowSize(window_, &windowed_rect_[2], &windowed_rect_[3]);
  glfwSetWindowMonitor(window_, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::swap() { glfwSwapBuffers(window_); }
void Window::make_current() { glfwMakeContextCurrent(window_); }
void Window::set_vsync(bool enabled) { glfwSwapInterval(enabled ? 1 : 0); }

}  // namespace limber::app
