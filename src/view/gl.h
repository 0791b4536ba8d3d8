// The few OpenGL objects that the picture needs, each of which goes with its owner; and the bytes of a picture.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limber {

enum class GlKind : std::uint8_t { buffer, vertex_array, texture, renderbuffer, framebuffer, program };

/// A name of OpenGL's, deleted with its owner. Lives no longer than its context. [main]
template <GlKind Kind>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ == 0) return;
    if constexpr (Kind == GlKind::buffer) glDeleteBuffers(1, &name_);
    if constexpr (Kind == GlKind::vertex_array) glDeleteVertexArrays(1, &name_);
    if constexpr (Kind == GlKind::texture) glDeleteTextures(1, &name_);
    if constexpr (Kind == GlKind::renderbuffer) glDeleteRenderbuffers(1, &name_);
    if constexpr (Kind == GlKind::framebuffer) glDeleteFramebuffers(1, &name_);
    if constexpr (Kind == GlKind::program) glDeleteProgram(name_);
  }
  static GlName make() {
    GLuint name = 0;
    if constexpr (Kind == GlKind::buffer) glGenBuffers(1, &name);
    if constexpr (Kind == GlKind::vertex_array) glGenVertexArrays(1, &name);
    if constexpr (Kind == GlKind::texture) glGenTextures(1, &name);
    if constexpr (Kind == GlKind::renderbuffer) glGenRenderbuffers(1, &name);
    if constexpr (Kind == GlKind::framebuffer) glGenFramebuffers(1, &name);
    return GlName(name);
  }
  GLuint operator*() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

using GlBuffer = GlName<GlKind::buffer>;
using GlVertexArray = GlName<GlKind::vertex_array>;
using GlTexture = GlName<GlKind::texture>;
using GlRenderbuffer = GlName<GlKind::renderbuffer>;
using GlFramebuffer = GlName<GlKind::framebuffer>;
using GlProgram = GlName<GlKind::program>;

/// What draws, in the driver's words: "llvmpipe (LLVM 15.0.6, 256 bits)". [main]
std::string gl_driver();
/// Whether that is software. [main]
bool gl_is_software();

}  // namespace limber
