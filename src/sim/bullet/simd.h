// Float4: a SIMD vector of four floats. Results are the same on every processor, whatever its vector width. [any]
#pragma once

#include <cstring>

namespace limber::sim::bullet {

using Float4 [[gnu::vector_size(16)]] = float;

inline Float4 load(const float* v) {
  Float4 vector;
  std::memcpy(&vector, v, sizeof vector);
  return vector;
}

inline void store(float* v, Float4 vector) { std::memcpy(v, &vector, sizeof vector); }

}  // namespace limber::sim::bullet
