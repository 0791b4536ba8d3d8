// Pixels: a finished picture, and its way into a PNG file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

namespace limber {

/// Rows from the top down, four bytes a pixel: red, green, blue (sRGB), 255.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;

  const std::uint8_t* at(int x, int y) const {
    return bytes.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Writes it whole or not at all: beside the file first, then in its place. [any]
Result<void> write_png(const Pixels& pixels, const std::string& file);

}  // namespace limber
