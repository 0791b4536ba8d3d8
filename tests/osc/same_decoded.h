// Decodes packets, and compares the results of two decoders bit by bit.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>

#include "net/osc/packets/decode.h"

namespace limber::osc::test {

/// Decodes from an allocation of exact size, so that the address sanitizer reports reads past the end.
inline Result<Decoded> exact_decoded(const std::string& bytes) {
  const auto exact = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  return decode_packet(exact.get(), bytes.size());
}

inline bool same(const Arg& a, const Arg& b) {
  return a.kind == b.kind && std::bit_cast<std::uint64_t>(a.number) == std::bit_cast<std::uint64_t>(b.number) &&
         a.text == b.text;
}

inline bool same(const Message& a, const Message& b) {
  return a.address == b.address &&
         std::ranges::equal(a.args, b.args, [](const Arg& x, const Arg& y) { return same(x, y); });
}

/// Except for the reasons of rejected messages.
inline bool same(const Decoded& a, const Decoded& b) {
  const auto equal = [](const Message& x, const Message& y) { return same(x, y); };
  const auto rejected = [](const RejectedMessage& x, const RejectedMessage& y) { return x.address == y.address; };
  return a.time_tag == b.time_tag && std::ranges::equal(a.messages, b.messages, equal) &&
         std::ranges::equal(a.rejected, b.rejected, rejected);
}

}  // namespace limber::osc::test
