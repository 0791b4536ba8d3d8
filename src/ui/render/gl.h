// RAII wrappers for OpenGL objects, and the supported OpenGL versions with the features that each of them has.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limber::render {

/// Kinds of OpenGL objects.
enum class GlKind : std::uint8_t { buffer, vertex_array, texture, renderbuffer, framebuffer, program };

/// Creates an OpenGL object and returns its name. [main]
std::uint32_t make_gl_object(GlKind kind);
/// Deletes an OpenGL object; its context must be current. [main]
void delete_gl_object(GlKind kind, std::uint32_t name);

/// Owns an OpenGL object and deletes it. Must not outlive its context. [main]
template <GlKind Kind>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(std::uint32_t name) : name_(name) {}
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlHandle() {
    if (name_ != 0) delete_gl_object(Kind, name_);
  }
  static GlHandle make() { return GlHandle(make_gl_object(Kind)); }
  std::uint32_t operator*() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  std::uint32_t name_ = 0;
};

using GlBuffer = GlHandle<GlKind::buffer>;
using GlVertexArray = GlHandle<GlKind::vertex_array>;
using GlTexture = GlHandle<GlKind::texture>;
using GlRenderbuffer = GlHandle<GlKind::renderbuffer>;
using GlFramebuffer = GlHandle<GlKind::framebuffer>;
using GlProgram = GlHandle<GlKind::program>;

/// The supported versions of OpenGL, in the order in which they are tried: 3.3 core, ES 3.0, 3.1.
enum class GlApi : std::uint8_t { core, es, gl31 };

/// An OpenGL version and its features.
struct GlApiInfo {
  GlApi api;
  const char* option;  ///< Value of the option `--gl`: "core", "es", "3.1".
  const char* name;    ///< "OpenGL 3.3", "OpenGL ES 3.0", "OpenGL 3.1".
  int major, minor;
  const char* glsl;  ///< The #version line of its shaders.
  int line_offset;   ///< The line after `#line n` has number n + line_offset.
  // features; the renderer and the shaders have a fallback for each missing one
  bool srgb_switch;     ///< GL_FRAMEBUFFER_SRGB; without it, sRGB framebuffers always convert.
  bool clip_distance;   ///< gl_ClipDistance.
  bool depth_clamp;     ///< GL_DEPTH_CLAMP.
  bool depth_filter;    ///< Depth textures can be read with linear filtering and without comparison.
  bool attribute_slot;  ///< Shaders declare the locations of attributes without an extension.
};
const GlApiInfo& gl_api_info(GlApi api);

/// The versions to try, in order. `choice`: a GlApiInfo::option, or "auto" or empty for all. [any]
std::vector<GlApi> gl_apis(std::string_view choice);
/// A list for messages: "OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1". [any]
std::string gl_names(std::span<const GlApi> apis);

/// True if the library with this version's functions can be loaded. Check this first, because the function loader
/// (libepoxy) aborts the program if it is missing. [any]
bool gl_can_load(GlApi api);
/// Error message for when no context of `apis` can be created, with the fix. `offered`: the versions that the driver
/// supports, such as "OpenGL 2.1"; empty: no context of any version. [any]
std::string gl_context_error(std::span<const GlApi> apis, const std::vector<std::string>& offered);

/// The driver's name for the hardware: "llvmpipe (LLVM 15.0.6, 256 bits)". [main]
std::string gl_driver();
/// True if the driver renders in software. [main]
bool gl_is_software();

}  // namespace limber::render
