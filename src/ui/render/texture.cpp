// Upload of images, and their reduction.
#include "ui/render/texture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace limber::render {

model::Image halved(const model::Image& image) {
  model::Image out;
  out.width = std::max(image.width / 2, 1);
  out.height = std::max(image.height / 2, 1);
  out.pixels.reserve(4 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  const auto at = [&](int x, int y, int channel) {
    const auto column = static_cast<std::size_t>(std::min(x, image.width - 1));
    const auto row = static_cast<std::size_t>(std::min(y, image.height - 1));
    return image
               .pixels[4 * (row * static_cast<std::size_t>(image.width) + column) + static_cast<std::size_t>(channel)] /
           255.0;
  };
  for (int y = 0; y < out.height; y++) {
    for (int x = 0; x < out.width; x++) {
      for (int channel = 0; channel < 4; channel++) {
        const bool is_alpha = channel == 3;
        double sum = 0;
        for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
          const double value = at(2 * x + dx, 2 * y + dy, channel);
          sum += is_alpha ? value : linear_light_of(value);
        }
        const double mean = is_alpha ? sum / 4 : encoded_of(sum / 4);
        out.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * mean)));
      }
    }
  }
  return out;
}

namespace {

// Binds the texture and replaces its image.
void upload(const GlTexture& texture, int format, int width, int height, const std::uint8_t* pixels, int wrap) {
  glBindTexture(GL_TEXTURE_2D, *texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
}

}  // namespace

GlTexture make_texture(const model::Image& image, int max_side) {
  if (image.width > max_side || image.height > max_side) return make_texture(halved(image), max_side);
  GlTexture texture = GlTexture::make();
  upload(texture, GL_SRGB8_ALPHA8, image.width, image.height, image.pixels.data(), GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  constexpr float kAnisotropy = 4;
  // where texture coordinates are constant, llvmpipe of Mesa 25 would sample black
  if (!gl_is_software() && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, kAnisotropy);
  glGenerateMipmap(GL_TEXTURE_2D);
  return texture;
}

void update_texture(GlTexture& texture, const Pixels& pixels) {
  if (!texture) texture = GlTexture::make();
  upload(texture, GL_RGBA8, pixels.width, pixels.height, pixels.bytes.data(), GL_CLAMP_TO_EDGE);
}

}  // namespace limber::render
