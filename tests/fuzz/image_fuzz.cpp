// Fuzzes the decoding of images. Input: a PNG or JPEG file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "model/look/image.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto image = limber::model::image_from_bytes({reinterpret_cast<const char*>(data), size}, "fuzz.png");
  if (!image) {
    limber::must(!image.error().empty());
    return 0;
  }
  const limber::model::Image& i = **image;
  limber::must(i.width > 0 && i.height > 0 && i.width <= limber::model::kMaxImageSide &&
               i.height <= limber::model::kMaxImageSide);
  limber::must(i.pixels.size() == 4 * static_cast<std::size_t>(i.width) * static_cast<std::size_t>(i.height));
  return 0;
}
