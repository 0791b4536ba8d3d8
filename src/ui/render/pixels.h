// Pixels: an image in memory, and writing it to a PNG file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

namespace limber::render {

/// Rows from top to bottom, four bytes per pixel: red, green, blue (sRGB), 255.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;

  /// The four bytes of a pixel; (0, 0) is the top left one.
  const std::uint8_t* at(int x, int y) const {
    return bytes.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Writes a PNG file atomically: into a temporary file, which is then renamed. [any]
Result<void> write_png(const Pixels& pixels, const std::string& file);

}  // namespace limber::render
