// Lanes: four numbers that are added together, the same on every processor, whatever its vectors are. [any]
#pragma once

#include <cstring>

namespace limber {

using Lanes [[gnu::vector_size(16)]] = float;

inline Lanes load(const float* v) {
  Lanes lanes;
  std::memcpy(&lanes, v, sizeof lanes);
  return lanes;
}

inline void store(float* v, Lanes lanes) { std::memcpy(v, &lanes, sizeof lanes); }

}  // namespace limber
