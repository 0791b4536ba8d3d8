// An image of an engine that is ticked by hand.
#pragma once

#include <memory>

#include "engine/show.h"

namespace limber::engine_test {

/// Ticks until there is one of this moment: images take a hundredth of the time, so it may be some hundred ticks.
inline std::shared_ptr<const Image> image_of(Show& show) {
  const std::uint64_t ask = show.link.ask_image();
  std::shared_ptr<const Image> image;
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    image = show.link.images.read();
    if (image != nullptr && image->asks >= ask) return image;
  }
  ADD_FAILURE() << "no image is made";
  return image;
}

}  // namespace limber::engine_test
