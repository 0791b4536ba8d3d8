// Framebuffers: multisampled, resolved and finished.
#include "ui/render/render_target.h"

#include <epoxy/gl.h>

#include <algorithm>

#include <fmt/format.h>

namespace limber::render {

void set_srgb_conversion(const GlApiInfo& api, bool enabled) {
  if (!api.srgb_switch) return;
  if (enabled) {
    glEnable(GL_FRAMEBUFFER_SRGB);
  } else {
    glDisable(GL_FRAMEBUFFER_SRGB);
  }
}

Result<void> RenderTarget::resize(int width, int height, int samples) {
  if (width == width_ && height == height_) return {};
  const auto store = [&](const GlRenderbuffer& buffer, GLenum format, int count) {
    glBindRenderbuffer(GL_RENDERBUFFER, *buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, count, format, width, height);
  };
  // clears errors left by others, such as the panel's renderer, which makes calls that ES does not support
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; i++) continue;
  GLint max_samples = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
  samples = std::min(samples, max_samples);
  // without srgb_switch, the resolve target is a texture; with one sample per pixel, it is drawn into directly
  multisampled_ = api_.srgb_switch || samples > 1;
  store(depth_, GL_DEPTH_COMPONENT24, samples);
  if (multisampled_) store(color_, GL_SRGB8_ALPHA8, samples);
  store(finished_color_, api_.srgb_switch ? GL_SRGB8_ALPHA8 : GL_RGBA8, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, *multisampled_framebuffer_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, *depth_);
  if (multisampled_) glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, *color_);
  if (!api_.srgb_switch) {
    resolved_color_ = GlTexture::make();
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, *resolved_color_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, multisampled_ ? *resolved_ : *multisampled_framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *resolved_color_, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, *multisampled_framebuffer_);
  }
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, *finished_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, *finished_color_);
  if (!complete || glGetError() == GL_OUT_OF_MEMORY)
    return Error{fmt::format("OpenGL has too little memory for an image of {} × {}", width, height)};
  width_ = width;
  height_ = height;
  return {};
}

void RenderTarget::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, *multisampled_framebuffer_);
  glViewport(0, 0, width_, height_);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void RenderTarget::resolve(const Shaders& shaders) const {
  if (multisampled_) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, *multisampled_framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, api_.srgb_switch ? *finished_ : *resolved_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  if (api_.srgb_switch) return;
  glBindFramebuffer(GL_FRAMEBUFFER, *finished_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, *resolved_color_);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(shaders.program("encode"));
  glBindVertexArray(*no_attributes_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Pixels RenderTarget::read() const {
  Pixels pixels{width_, height_, {}};
  const std::size_t row = 4 * static_cast<std::size_t>(width_);
  pixels.bytes.resize(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *finished_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.bytes.data());
  // OpenGL's first row is the lowest
  for (std::size_t low = 0, high = static_cast<std::size_t>(height_) - 1; low < high; low++, high--)
    std::swap_ranges(pixels.bytes.begin() + static_cast<std::ptrdiff_t>(low * row),
                     pixels.bytes.begin() + static_cast<std::ptrdiff_t>((low + 1) * row),
                     pixels.bytes.begin() + static_cast<std::ptrdiff_t>(high * row));
  for (std::size_t i = 3; i < pixels.bytes.size(); i += 4) pixels.bytes[i] = 255;
  return pixels;
}

void RenderTarget::draw_over(const std::function<void()>& draw) const {
  set_srgb_conversion(api_, false);
  glBindFramebuffer(GL_FRAMEBUFFER, *finished_);
  glViewport(0, 0, width_, height_);
  draw();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void RenderTarget::copy_to_window(GLuint from, int width, int height) const {
  set_srgb_conversion(api_, false);  // copy the bytes unchanged
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  const bool fits = width == width_ && height == height_;
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT, fits ? GL_NEAREST : GL_LINEAR);
}

void RenderTarget::present(int width, int height) const { copy_to_window(*finished_, width, height); }

void RenderTarget::present_shared(const GlFramebuffer& frame, int width, int height) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *frame);
  // attached each time: changes made in another context become visible when the object is attached
  glFramebufferRenderbuffer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, *finished_color_);
  copy_to_window(*frame, width, height);
}

}  // namespace limber::render
