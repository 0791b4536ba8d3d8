// Offscreen: an OpenGL context without any window or display, through EGL.
#pragma once

#include <memory>
#include <string_view>

#include "base/result.h"
#include "view/gl.h"

namespace limber {

class Offscreen {
 public:
  /// Current on this thread until it goes. `choice`: of the kinds of OpenGL, see gl_apis(). An error says what the
  /// machine lacks. [main]
  static Result<std::unique_ptr<Offscreen>> make(std::string_view choice = "auto");
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  GlApi api() const { return api_; }
  /// Makes it current again, after another one was. [main]
  void use() const;

 private:
  Offscreen(void* display, void* context, GlApi api) : display_(display), context_(context), api_(api) {}

  void* display_;
  void* context_;
  GlApi api_;
};

}  // namespace limber
