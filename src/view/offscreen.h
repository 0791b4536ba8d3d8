// Offscreen: an OpenGL context without any window or display, through EGL.
#pragma once

#include <memory>

#include "base/result.h"

namespace limber {

class Offscreen {
 public:
  /// Current on this thread until it goes. An error says what the machine lacks. [main]
  static Result<std::unique_ptr<Offscreen>> make();
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

 private:
  Offscreen(void* display, void* context) : display_(display), context_(context) {}

  void* display_;
  void* context_;
};

}  // namespace limber
