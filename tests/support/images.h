// PNG and JPEG files for tests.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <stb_image_write.h>

namespace limber::test {

using Rgb = std::array<std::uint8_t, 3>;

inline void append_bytes(void* to, void* data, int size) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

/// The bytes of a PNG file with these pixels, in rows from the top.
inline std::string png(int width, const std::vector<Rgb>& pixels) {
  std::string bytes;
  stbi_write_png_to_func(&append_bytes, &bytes, width, static_cast<int>(pixels.size()) / width, 3, pixels.data(),
                         3 * width);
  return bytes;
}

/// The bytes of a JPEG file in one color.
inline std::string jpeg(int width, int height, const Rgb& color) {
  std::string bytes;
  const std::vector<Rgb> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), color);
  constexpr int kQuality = 95;
  stbi_write_jpg_to_func(&append_bytes, &bytes, width, height, 3, pixels.data(), kQuality);
  return bytes;
}

}  // namespace limber::test
