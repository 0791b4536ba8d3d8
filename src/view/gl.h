// The few OpenGL objects that the picture needs, each of which goes with its owner; the kinds of OpenGL that it can be
// drawn with, and what each of them lacks.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
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

/// The kinds of OpenGL that the picture can be drawn with, in the order in which they are tried: 3.3 core, ES 3.0, 3.1.
enum class GlApi : std::uint8_t { core, es, gl31 };

struct GlApiInfo {
  GlApi api;
  const char* option;  ///< As `--gl` has it: "core", "es", "3.1".
  const char* name;    ///< "OpenGL 3.3", "OpenGL ES 3.0", "OpenGL 3.1".
  int major, minor;
  const char* glsl;  ///< The first line of its shaders.
  int line_offset;   ///< The line behind `#line n` is counted as n plus this.
  // features; the renderer and the shaders replace a missing one
  bool srgb_switch;     ///< GL_FRAMEBUFFER_SRGB; without it, sRGB framebuffers always convert.
  bool clip_distance;   ///< gl_ClipDistance.
  bool depth_clamp;     ///< GL_DEPTH_CLAMP.
  bool depth_filter;    ///< Depth textures can be read with linear filtering and without comparison.
  bool attribute_slot;  ///< Shaders declare the locations of attributes without an extension.
};
const GlApiInfo& gl_api_info(GlApi api);

/// The kinds to try, in order. `choice`: an `option`, or "auto" or nothing for all. [any]
std::vector<GlApi> gl_apis(std::string_view choice);
/// "OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1". [any]
std::string gl_names(std::span<const GlApi> apis);

/// Whether the library of this kind's functions can be loaded. The function loader ends the program without it. [any]
bool gl_can_load(GlApi api);
/// Why no context of `apis` can be made, and the fix. `offered`: the versions that the driver has, such as
/// "OpenGL 2.1"; empty: no context of any version. [any]
std::string gl_fault(std::span<const GlApi> apis, const std::vector<std::string>& offered);

/// The driver's name for the hardware: "llvmpipe (LLVM 15.0.6, 256 bits)". [main]
std::string gl_driver();
/// Whether that is software. [main]
bool gl_is_software();

}  // namespace limber
