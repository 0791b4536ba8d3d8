// Hash functions for text, files and simulation state. The results are the same on all machines.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace limber {

/// One step of the generator splitmix64 (Steele, Lea, Flood 2014): advances the state and returns 64 mixed bits.
constexpr std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Returns the 64-bit FNV-1a hash of the bytes. To hash several strings, pass the hash of the previous one as `start`.
constexpr std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t start = 0xcbf29ce484222325u) {
  for (const char c : bytes) start = (start ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return start;
}

/// Hashes the bits of many numbers, about fifteen times as fast as hash_bytes(): four independent states are updated in
/// turn, so that multiplications overlap. Each step is invertible, so a single different number always changes the
/// hash.
class NumberHash {
 public:
  /// `start`: seed, such as the value of a previous hash.
  explicit constexpr NumberHash(std::uint64_t start)
      : a_(splitmix64(start)), b_(splitmix64(start)), c_(splitmix64(start)), d_(splitmix64(start)) {}

  /// Adds the numbers in order, beginning with the first state.
  constexpr void add(std::span<const double> numbers) {
    std::size_t i = 0;
    for (; i + 4 <= numbers.size(); i += 4) {
      mix(a_, numbers[i]);
      mix(b_, numbers[i + 1]);
      mix(c_, numbers[i + 2]);
      mix(d_, numbers[i + 3]);
    }
    if (i < numbers.size()) mix(a_, numbers[i++]);
    if (i < numbers.size()) mix(b_, numbers[i++]);
    if (i < numbers.size()) mix(c_, numbers[i]);
  }
  constexpr void add(double a, double b, double c) {
    mix(a_, a);
    mix(b_, b);
    mix(c_, c);
  }
  /// Adds a word, such as another hash.
  constexpr void add_word(std::uint64_t word) { mix(d_, word); }
  constexpr void add(const std::array<std::uint64_t, 4>& words) {
    mix(a_, words[0]);
    mix(b_, words[1]);
    mix(c_, words[2]);
    mix(d_, words[3]);
  }

  constexpr std::uint64_t value() const {
    std::uint64_t hash = 0;
    for (const std::uint64_t state : {a_, b_, c_, d_}) {
      hash ^= state;
      hash = splitmix64(hash);
    }
    return hash;
  }

 private:
  static constexpr void mix(std::uint64_t& state, std::uint64_t word) {
    state = (state ^ word) * 0x9fb21c651e98df25u;
    state ^= state >> 32;
  }
  static constexpr void mix(std::uint64_t& state, double number) { mix(state, std::bit_cast<std::uint64_t>(number)); }

  std::uint64_t a_, b_, c_, d_;  // an array would be stored in memory instead of registers
};

}  // namespace limber
