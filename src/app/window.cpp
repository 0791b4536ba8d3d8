// GLFW, and Xlib's way of ending programs kept from it.
#include "app/window.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/key_layout.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber {

namespace {

std::function<void()> display_lost;

int handle_lost_display(void*) {
  if (display_lost) display_lost();
  std::_Exit(3);  // Xlib would do that
}

// Xlib would end the program at a wrong request, such as one about a window that somebody has destroyed
bool request_failed = false;
int handle_failed_request(void*, void*) {
  request_failed = true;
  return 0;
}

// Sets a handler of Xlib, if Xlib is in use: GLFW before 3.4 links it, later versions load it where only they see it,
// and windows of Wayland do without.
template <class Handler>
void set_handler(const char* setter, Handler handler) {
  using Setter = Handler (*)(Handler);
  if (const auto set = reinterpret_cast<Setter>(system::find_symbol(setter))) set(handler);
}

std::string glfw_fault() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "GLFW does not say why" : text;
}

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

std::string printed_on(int key) {
  const char* const name = glfwGetKeyName(key, 0);
  return name == nullptr ? "" : name;
}

KeyMods key_mods(int mods) {
  return {(mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_ALT) != 0};
}

constexpr int kFromCorner = 64;  // of another screen, in its units

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

GLFWmonitor* screen_of(GLFWwindow* window) {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  int count = 0;
  GLFWmonitor** const screens = glfwGetMonitors(&count);
  GLFWmonitor* best = nullptr;
  int most = -1;
  for (int i = 0; i < count; i++) {
    int left = 0;
    int top = 0;
    glfwGetMonitorPos(screens[i], &left, &top);
    const GLFWvidmode* const mode = glfwGetVideoMode(screens[i]);
    if (mode == nullptr) continue;
    const int across = std::min(x + width, left + mode->width) - std::max(x, left);
    const int down = std::min(y + height, top + mode->height) - std::max(y, top);
    const int shared = std::max(across, 0) * std::max(down, 0);
    if (shared > most) best = screens[i];
    most = std::max(most, shared);
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

// EGL beside GLX: some X servers have no GLX, and OpenGL ES comes with EGL
std::vector<ContextKind> context_kinds(GlApi api) {
  const GlApiInfo& info = gl_api_info(api);
  if (!gl_can_load(api)) return {};
  if (api == GlApi::es)
    return {{GLFW_OPENGL_ES_API, GLFW_EGL_CONTEXT_API, info.major, info.minor},
            {GLFW_OPENGL_ES_API, GLFW_NATIVE_CONTEXT_API, info.major, info.minor}};
  return {{GLFW_OPENGL_API, GLFW_NATIVE_CONTEXT_API, info.major, info.minor},
          {GLFW_OPENGL_API, GLFW_EGL_CONTEXT_API, info.major, info.minor}};
}

// the versions of any age that the driver has
std::vector<std::string> offered_versions() {
  std::vector<std::string> names;
  const auto look = [&](const char* name, std::initializer_list<ContextKind> kinds) {
    for (const ContextKind& kind : kinds) {
      GLFWwindow* const window = make_window("", 1, 1, kind, false);
      if (window == nullptr) continue;
      names.push_back(fmt::format("{} {}.{}", name, glfwGetWindowAttrib(window, GLFW_CONTEXT_VERSION_MAJOR),
                                  glfwGetWindowAttrib(window, GLFW_CONTEXT_VERSION_MINOR)));
      glfwDestroyWindow(window);
      return;
    }
  };
  look("OpenGL", {{GLFW_OPENGL_API, GLFW_NATIVE_CONTEXT_API, 1, 0}, {GLFW_OPENGL_API, GLFW_EGL_CONTEXT_API, 1, 0}});
  look("OpenGL ES",
       {{GLFW_OPENGL_ES_API, GLFW_EGL_CONTEXT_API, 2, 0}, {GLFW_OPENGL_ES_API, GLFW_NATIVE_CONTEXT_API, 2, 0}});
  return names;
}

}  // namespace

bool Window::has_display() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

Result<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height,
                                             std::span<const GlApi> apis) {
  if (!has_display())
    return Error{"no display: DISPLAY and WAYLAND_DISPLAY are not set; a desktop session or xvfb-run sets one"};
#if defined(GLFW_PLATFORM)
  // GLFW 3.4 tries Wayland first, also where no session offers it
  if (!is_set("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() != GLFW_TRUE) {
    const std::string why = glfw_fault();
    const char* const fix = is_set("DISPLAY") || why.starts_with("Wayland")
                                ? "Set DISPLAY (and XAUTHORITY) or WAYLAND_DISPLAY as in the desktop session"
                                : "GLFW needs an X server here. On Debian: apt-get install xwayland, log in again";
    return Error{fmt::format("no window can be opened: {}. {}", why, fix)};
  }
  request_failed = false;
  set_handler("XSetIOErrorHandler", handle_lost_display);
  set_handler("XSetErrorHandler", handle_failed_request);
  for (const GlApi api : apis) {
    for (const ContextKind& kind : context_kinds(api)) {
      GLFWwindow* const window = make_window(title.c_str(), width, height, kind);
      if (window != nullptr) return std::unique_ptr<Window>(new Window(window, api));
    }
  }
  const std::string fault = gl_fault(apis, offered_versions());
  glfwTerminate();
  return Error{fmt::format("no window can be opened: {}", fault)};
}

Result<std::unique_ptr<Window>> Window::open_beside(const Window& first, const std::string& title, int width,
                                                    int height) {
  GLFWmonitor* const taken = screen_of(first.window_);
  GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), nullptr, first.window_);
  if (window == nullptr) return Error{fmt::format("no second window can be opened: {}", glfw_fault())};
  std::unique_ptr<Window> made(new Window(window, first.api_));
  glfwMakeContextCurrent(first.window_);
  int count = 0;
  GLFWmonitor** const screens = glfwGetMonitors(&count);
  GLFWmonitor** const other = std::find_if(screens, screens + count, [&](GLFWmonitor* s) { return s != taken; });
  if (other == screens + count) return made;
  int x = 0;
  int y = 0;
  glfwGetMonitorPos(*other, &x, &y);
  glfwSetWindowPos(window, x + kFromCorner, y + kFromCorner);
  return made;
}

Window::Window(GLFWwindow* window, GlApi api) : window_(window), api_(api) {
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, on_key);
  glfwSetCharCallback(window_, on_letter);
  glfwSetMouseButtonCallback(window_, on_button);
  glfwSetCursorPosCallback(window_, on_move);
  glfwSetScrollCallback(window_, on_scroll);
  glfwSetWindowFocusCallback(window_, on_focus);
  glfwGetCursorPos(window_, &x_, &y_);
}

// GLFW stays: drivers that are unloaded leave memory behind
Window::~Window() { glfwDestroyWindow(window_); }

void Window::on_display_lost(std::function<void()> go_on) { display_lost = std::move(go_on); }

// a modifier's own press and release count, too: letters that come after it are letters again
void Window::on_key(GLFWwindow* window, int key, int, int action, int) {
  if (action == GLFW_REPEAT) return;  // the panel repeats by itself
  InputEvent event{.kind = InputEvent::Kind::key};
  event.key = KeyLayout(printed_on).key(key);
  event.down = action == GLFW_PRESS;
  const auto held = [&](int left, int right) {
    return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
  };
  event.mods = {held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL), held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
                held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT)};
  of(window).events_.push_back(event);
}

void Window::on_letter(GLFWwindow* window, unsigned letter) {
  InputEvent event{.kind = InputEvent::Kind::text};
  event.letter = letter;
  of(window).events_.push_back(event);
}

void Window::on_button(GLFWwindow* window, int button, int action, int mods) {
  InputEvent event{.kind = InputEvent::Kind::button};
  event.button = button;
  event.down = action == GLFW_PRESS;
  event.mods = key_mods(mods);
  of(window).events_.push_back(event);
}

void Window::on_focus(GLFWwindow* window, int focused) {
  InputEvent event{.kind = InputEvent::Kind::focus};
  event.down = focused == GLFW_TRUE;
  of(window).events_.push_back(event);
}

void Window::on_move(GLFWwindow* window, double x, double y) {
  Window& self = of(window);
  const double dx = x - std::exchange(self.x_, x);
  const double dy = y - std::exchange(self.y_, y);
  InputEvent event{.kind = InputEvent::Kind::move};
  // of the picture, which on some screens has more pixels than the window has units
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window, &width, &height);
  event.x = width > 0 ? x * self.width() / width : x;
  event.y = height > 0 ? y * self.height() / height : y;
  self.events_.push_back(event);
  const auto held = [&](int button) { return glfwGetMouseButton(window, button) == GLFW_PRESS; };
  const auto pressed = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
  const bool shift = pressed(GLFW_KEY_LEFT_SHIFT) || pressed(GLFW_KEY_RIGHT_SHIFT);
  if (held(GLFW_MOUSE_BUTTON_LEFT) && !shift) {
    self.mouse_.turn_x += dx;
    self.mouse_.turn_y += dy;
  } else if (held(GLFW_MOUSE_BUTTON_LEFT) || held(GLFW_MOUSE_BUTTON_RIGHT) || held(GLFW_MOUSE_BUTTON_MIDDLE)) {
    self.mouse_.shift_x += dx;
    self.mouse_.shift_y += dy;
  }
}

void Window::on_scroll(GLFWwindow* window, double x, double y) {
  of(window).mouse_.wheel += y;
  InputEvent event{.kind = InputEvent::Kind::wheel};
  event.x = x;
  event.y = y;
  of(window).events_.push_back(event);
}

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

KeyLabels Window::key_labels() const { return KeyLayout(printed_on).labels(); }

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
  GLFWmonitor* const screen = screen_of(window_);
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

void Window::clipboard(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

std::vector<InputEvent> Window::take_events() { return std::exchange(events_, {}); }
MouseMoves Window::take_mouse() { return std::exchange(mouse_, {}); }
void Window::title(const std::string& text) { glfwSetWindowTitle(window_, text.c_str()); }

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
    const bool named = name != nullptr && plain_name(name).find(plain_name(which)) != std::string::npos;
    if (number ? *number == i + 1 : named) found = screens[i];
  }
  const GLFWvidmode* const mode = found == nullptr ? nullptr : glfwGetVideoMode(found);
  if (mode == nullptr)
    return Error{fmt::format("there is no monitor '{}'; there are: {}", printable(which), fmt::join(names, ", "))};
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetMonitorPos(found, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  glfwSetWindowPos(window_, x + std::max(0, mode->width - width) / 2, y + std::max(0, mode->height - height) / 2);
  glfwPollEvents();  // toggle_full_screen() asks where the window is
  return {};
}

void Window::hide_pointer() { glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN); }

void Window::toggle_full_screen() {
  if (is_full_screen()) {
    glfwSetWindowMonitor(window_, nullptr, place_[0], place_[1], place_[2], place_[3], GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* const screen = screen_of(window_);
  const GLFWvidmode* const mode = screen == nullptr ? nullptr : glfwGetVideoMode(screen);
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &place_[0], &place_[1]);
  glfwGetWindowSize(window_, &place_[2], &place_[3]);
  glfwSetWindowMonitor(window_, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::swap() { glfwSwapBuffers(window_); }
void Window::use() { glfwMakeContextCurrent(window_); }
void Window::wait_for_screen(bool waits) { glfwSwapInterval(waits ? 1 : 0); }

}  // namespace limber
