// Images of textures: PNG and JPEG files, decoded to 8 bits per channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::model {

inline constexpr std::size_t kMaxImageBytes = 32u << 20;   ///< Largest file.
inline constexpr int kMaxImageSide = 8192;                 ///< Largest width and height, pixels.
inline constexpr std::size_t kMaxImagePixels = 32u << 20;  ///< Largest product of the two.

struct Image {
  std::string file;  ///< Path, for messages.
  int width = 0;
  int height = 0;
  std::uint64_t content_hash = 0;  ///< hash_bytes() of the file.
  /// Red, green, blue, alpha of each pixel, in rows from the top; sRGB-encoded, alpha not premultiplied.
  std::vector<std::uint8_t> pixels;
};

/// True if the file's name ends like that of a PNG or JPEG file, in any case. [any]
bool is_image_name(std::string_view path);

/// Decodes a PNG or JPEG file; its contents decide which. Files beyond the limits above are rejected before they are
/// decoded; 16 bits per channel are reduced to 8. The error describes the fault and its fix, without the file's name.
/// [any]
Result<std::shared_ptr<const Image>> image_from_bytes(std::string_view bytes, std::string file);

}  // namespace limber::model
