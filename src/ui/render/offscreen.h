// OffscreenContext: an OpenGL context without a window or display, created with EGL.
#pragma once

#include <memory>
#include <string_view>

#include "base/result.h"
#include "ui/render/gl.h"

namespace limber::render {

/// Owns the context. [main]
class OffscreenContext {
 public:
  /// Creates a context and makes it current on this thread until it is destroyed. `choice`: see gl_apis(). The error
  /// names the missing library or driver. [main]
  static Result<std::unique_ptr<OffscreenContext>> make(std::string_view choice = "auto");
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  GlApi api() const { return api_; }
  /// Makes the context current again after another one was. [main]
  void make_current() const;

 private:
  OffscreenContext(void* display, void* context, GlApi api) : display_(display), context_(context), api_(api) {}

  void* display_;
  void* context_;
  GlApi api_;
};

}  // namespace limber::render
