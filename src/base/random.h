// Random: a seeded generator. Each node has its own, from the world's seed and the node's name, so that runs repeat.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/hash.h"
#include "base/vec.h"

namespace limber {

/// xoshiro256** (Blackman, Vigna 2018).
class Random {
 public:
  explicit Random(std::uint64_t seed = 1, std::string_view name = {}) {
    std::uint64_t s = seed ^ hash_bytes(name);
    for (std::uint64_t& word : state_) word = splitmix64(s);
  }

  std::uint64_t next() {
    used_ = 1;
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double a, double b) { return a + uniform() * (b - a); }
  /// Standard normal distribution (Box, Muller 1958; uses one of the pair).
  double normal() {
    const double u = 1 - uniform();
    return std::sqrt(-2 * fixed::log(u)) * fixed::cos(2 * kPi * uniform());
  }
  /// Uniform on the unit sphere (Archimedes: z is uniform).
  Vec3 direction() {
    const double z = uniform(-1, 1);
    const double angle = uniform(0, 2 * kPi);
    const double r = std::sqrt(1 - z * z);
    return {r * fixed::cos(angle), r * fixed::sin(angle), z};
  }

  /// The generator's state, for the state hash.
  const std::array<std::uint64_t, 4>& state() const { return state_; }
  /// True if next() was called since the seeding; until then the generator is not part of the state hash.
  bool used() const { return used_ != 0; }

 private:
  std::array<std::uint64_t, 4> state_{};
  std::uint64_t used_ = 0;  // 64 bits to avoid padding: checkpoints copy the bytes
};

}  // namespace limber
