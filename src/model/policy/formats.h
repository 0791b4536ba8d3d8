// The readers of the formats of policies, and conversions that they share. Included in this folder only.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include "base/result.h"
#include "model/policy/policy_network.h"

namespace limber::model::policy {

// Errors have no place; parse_policy() adds the file.
Result<std::shared_ptr<PolicyNetwork>> read_safetensors(std::string_view bytes);
Result<std::shared_ptr<PolicyNetwork>> read_onnx(std::string_view bytes);

/// Reads a number that is stored with the lowest byte first, at any address.
template <class T>
T little_endian(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The value of an IEEE 754 half-precision number.
inline float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
  const std::uint32_t exponent = half >> 10 & 0x1fu;
  const std::uint32_t mantissa = half & 0x3ffu;
  if (exponent == 0) {
    const float small = static_cast<float>(mantissa) * 0x1p-24f;
    return sign == 0 ? small : -small;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23 | mantissa << 13);
}

}  // namespace limber::model::policy
