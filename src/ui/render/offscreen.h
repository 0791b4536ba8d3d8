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
  /// Makes the context current again after another one was. False: the driver reports an error. [main]
  bool make_current() const;

 private:
  OffscreenContext(void* display, void* context, GlApi api) : display_(display), context_(context), api_(api) {}

  void* display_;
  void* context_;
  GlApi api_;
};

/// Restores at its end which EGL context is current on this thread, for programs that have contexts of their own. [any]
class CurrentContextGuard {
 public:
  CurrentContextGuard();
  ~CurrentContextGuard();
  CurrentContextGuard(const CurrentContextGuard&) = delete;
  CurrentContextGuard& operator=(const CurrentContextGuard&) = delete;

 private:
  bool loaded_;
  unsigned api_ = 0;
  void* display_ = nullptr;
  void* context_ = nullptr;
  void* drawn_ = nullptr;  // surfaces
  void* read_ = nullptr;
};

}  // namespace limber::render
