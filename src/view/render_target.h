// RenderTarget: the framebuffers that one picture is drawn into, and the way from there to a window or into memory.
#pragma once

#include <functional>

#include "base/result.h"
#include "view/gl.h"
#include "view/pixels.h"
#include "view/shaders.h"

namespace limber {

/// Shapes are drawn in linear light into `samples_`, an sRGB framebuffer with several samples a pixel. resolve() leaves
/// the finished bytes in `finished_`.
///
/// OpenGL ES can't switch the conversion of sRGB framebuffers off, as the panel and windows need it. There, `finished_`
/// is an RGBA framebuffer, which a shader converts to; in between is an sRGB texture.
class RenderTarget {
 public:
  explicit RenderTarget(GlApi api) : api_(gl_api_info(api)) {}

  /// `samples` of a pixel: 0 and 1 are one. An error: too large for the memory. [main]
  Result<void> resize(int width, int height, int samples);
  /// Binds it and clears it. [main]
  void begin() const;
  /// Finishes the picture that was drawn since begin(). [main]
  void resolve(const Shaders& shaders) const;

  int width() const { return width_; }
  int height() const { return height_; }

  /// The finished picture. [main]
  Pixels read() const;
  /// Calls what draws over the finished picture, which is bound, its colors as they are. [main]
  void draw_over(const std::function<void()>& draw) const;
  /// Copies the finished picture into the window's own framebuffer, stretched to that size. [main]
  void show(int width, int height) const;
  /// The same in another context that shares objects with this one and is current there. `frame` is a framebuffer of
  /// that context. [main]
  void show_shared(const GlFramebuffer& frame, int width, int height) const;

 private:
  void copy_to_window(GLuint from, int width, int height) const;

  const GlApiInfo& api_;
  GlFramebuffer samples_ = GlFramebuffer::make();
  GlFramebuffer resolved_ = GlFramebuffer::make();  // without srgb_switch
  GlFramebuffer finished_ = GlFramebuffer::make();
  GlRenderbuffer color_ = GlRenderbuffer::make();
  GlRenderbuffer depth_ = GlRenderbuffer::make();
  GlRenderbuffer picture_ = GlRenderbuffer::make();  // of finished_
  GlTexture light_;                                  // of resolved_
  GlVertexArray nothing_ = GlVertexArray::make();
  int width_ = 0;
  int height_ = 0;
  bool multisampled_ = false;
};

/// Switches the conversion of sRGB framebuffers, where it can be switched. [main]
void convert_srgb(const GlApiInfo& api, bool converts);

}  // namespace limber
