// RenderTarget: the framebuffers for one image, and copying the image to a window or to memory.
#pragma once

#include <cstdint>
#include <functional>

#include "base/result.h"
#include "ui/render/gl.h"
#include "ui/render/pixels.h"
#include "ui/render/shaders.h"

namespace limber::render {

/// The scene is drawn in linear light into a multisampled sRGB framebuffer. resolve() converts it to the final bytes in
/// `finished_`.
///
/// The panel and windows need framebuffers without sRGB conversion, but OpenGL ES can't switch it off. There,
/// `finished_` is an RGBA framebuffer that a shader fills from an intermediate sRGB texture.
class RenderTarget {
 public:
  explicit RenderTarget(GlApi api) : api_(gl_api_info(api)) {}

  /// Allocates the framebuffers. `samples`: per pixel; 0 and 1 disable multisampling. Errors if memory is insufficient.
  /// [main]
  Result<void> resize(int width, int height, int samples);
  /// Binds and clears the framebuffer. [main]
  void begin() const;
  /// Finishes the image that was drawn since begin(). [main]
  void resolve(const Shaders& shaders) const;

  int width() const { return width_; }
  int height() const { return height_; }

  /// Reads back the finished image. [main]
  Pixels read() const;
  /// Calls `draw` with the finished image bound as the framebuffer, without sRGB conversion. [main]
  void draw_over(const std::function<void()>& draw) const;
  /// Copies the finished image to the window's default framebuffer, scaled to that size. [main]
  void present(int width, int height) const;
  /// Like present(), but called with another context current, which shares objects with the first. `frame` is a
  /// framebuffer of that other context. [main]
  void present_shared(const GlFramebuffer& frame, int width, int height) const;

 private:
  void copy_to_window(std::uint32_t from, int width, int height) const;

  const GlApiInfo& api_;
  GlFramebuffer multisampled_framebuffer_ = GlFramebuffer::make();
  GlFramebuffer resolved_ = GlFramebuffer::make();  // only used without srgb_switch
  GlFramebuffer finished_ = GlFramebuffer::make();
  GlRenderbuffer color_ = GlRenderbuffer::make();
  GlRenderbuffer depth_ = GlRenderbuffer::make();
  GlRenderbuffer finished_color_ = GlRenderbuffer::make();  // color buffer of finished_
  GlTexture resolved_color_;                                // color buffer of resolved_
  GlVertexArray no_attributes_ = GlVertexArray::make();
  int width_ = 0;
  int height_ = 0;
  bool multisampled_ = false;
};

/// Enables or disables the conversion of sRGB framebuffers, if the API has a switch for it. [main]
void set_srgb_conversion(const GlApiInfo& api, bool enabled);

}  // namespace limber::render
