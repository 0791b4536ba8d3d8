// GLFW, and Xlib's way of ending programs kept from it.
#include "app/window.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

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

// by name: GLFW links Xlib, its Wayland form does not
template <class Handler>
void set_handler(const char* setter, Handler handler) {
  using Setter = Handler (*)(Handler);
  if (const auto set = reinterpret_cast<Setter>(dlsym(RTLD_DEFAULT, setter))) set(handler);
}

std::string glfw_fault() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "GLFW does not say why" : text;
}

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

}  // namespace

bool Window::has_display() { return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr; }

Result<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height) {
  if (!has_display()) return Error{"there is no display"};
  if (glfwInit() != GLFW_TRUE) return Error{fmt::format("no window can be opened: {}", glfw_fault())};
  request_failed = false;
  set_handler("XSetIOErrorHandler", handle_lost_display);
  set_handler("XSetErrorHandler", handle_failed_request);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "limber");
  GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    const std::string why = glfw_fault();
    glfwTerminate();
    return Error{fmt::format("no window with OpenGL 3.3 can be opened: {}", why)};
  }
  return std::unique_ptr<Window>(new Window(window));
}

Window::Window(GLFWwindow* window) : window_(window) {
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, on_key);
  glfwSetCursorPosCallback(window_, on_move);
  glfwSetScrollCallback(window_, on_scroll);
  glfwGetCursorPos(window_, &x_, &y_);
}

// GLFW stays: drivers that are unloaded leave memory behind
Window::~Window() { glfwDestroyWindow(window_); }

void Window::on_display_lost(std::function<void()> go_on) { display_lost = std::move(go_on); }

void Window::on_key(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  std::vector<Key>& keys = of(window).keys_;
  if (key == GLFW_KEY_SPACE) keys.push_back(Key::space);
  if (key == GLFW_KEY_PERIOD) keys.push_back(Key::period);
  if (key == GLFW_KEY_HOME) keys.push_back(Key::home);
  if (key == GLFW_KEY_F11) keys.push_back(Key::full_screen);
}

void Window::on_move(GLFWwindow* window, double x, double y) {
  Window& self = of(window);
  const double dx = x - std::exchange(self.x_, x);
  const double dy = y - std::exchange(self.y_, y);
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

void Window::on_scroll(GLFWwindow* window, double, double y) { of(window).mouse_.wheel += y; }

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

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

std::vector<Key> Window::take_keys() { return std::exchange(keys_, {}); }
MouseMoves Window::take_mouse() { return std::exchange(mouse_, {}); }
void Window::title(const std::string& text) { glfwSetWindowTitle(window_, text.c_str()); }

void Window::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
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

}  // namespace limber
