// Textures of meshes on the GPU.
#pragma once

#include "model/look/image.h"
#include "ui/render/gl.h"
#include "ui/render/pixels.h"

namespace limber::render {

/// Uploads an image as a repeating sRGB texture with mipmaps; halves it until it is at most `max_side` wide and high.
/// [main]
GlTexture make_texture(const model::Image& image, int max_side);

/// Replaces a texture by an image whose bytes are shown as they are, without mipmaps. [main]
void update_texture(GlTexture& texture, const Pixels& pixels);

/// An image of half the size, at least 1 × 1: each pixel is the mean of up to four, in linear light. [any]
model::Image halved(const model::Image& image);

}  // namespace limber::render
