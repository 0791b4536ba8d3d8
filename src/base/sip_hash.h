// SipHash-2-4 (Aumasson, Bernstein 2012), a keyed hash: without the key, its values can't be predicted.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace limber {

/// Returns the hash of two words as 16 little-endian bytes, like the reference implementation.
constexpr std::uint64_t sip_hash(const std::array<std::uint64_t, 2>& key, std::uint64_t first, std::uint64_t second) {
  std::uint64_t v0 = key[0] ^ 0x736f6d6570736575u;
  std::uint64_t v1 = key[1] ^ 0x646f72616e646f6du;
  std::uint64_t v2 = key[0] ^ 0x6c7967656e657261u;
  std::uint64_t v3 = key[1] ^ 0x7465646279746573u;
  const auto rounds = [&](int count) {
    for (int i = 0; i < count; i++) {
      v0 += v1, v1 = std::rotl(v1, 13) ^ v0, v0 = std::rotl(v0, 32);
      v2 += v3, v3 = std::rotl(v3, 16) ^ v2;
      v0 += v3, v3 = std::rotl(v3, 21) ^ v0;
      v2 += v1, v1 = std::rotl(v1, 17) ^ v2, v2 = std::rotl(v2, 32);
    }
  };
  for (const std::uint64_t word : {first, second, std::uint64_t{16} << 56}) {
    v3 ^= word;
    rounds(2);
    v0 ^= word;
  }
  v2 ^= 0xff;
  rounds(4);
  return v0 ^ v1 ^ v2 ^ v3;
}

}  // namespace limber
