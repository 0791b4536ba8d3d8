// Writes and reads the bytes of OSC packets according to the specification, independently of the tested code.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limber::osc::test {

inline std::string text_of(std::span<const char> packet) { return {packet.begin(), packet.end()}; }

class Bytes {
 public:
  Bytes& text(std::string_view s) {
    bytes_ += s;
    do bytes_ += '\0';
    while (bytes_.size() % 4 != 0);
    return *this;
  }
  Bytes& u32(std::uint32_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes_ += static_cast<char>(v >> shift & 255u);
    return *this;
  }
  Bytes& u64(std::uint64_t v) {
    return u32(static_cast<std::uint32_t>(v >> 32)).u32(static_cast<std::uint32_t>(v & 0xffffffffu));
  }
  Bytes& f(float v) { return u32(std::bit_cast<std::uint32_t>(v)); }
  Bytes& d(double v) { return u64(std::bit_cast<std::uint64_t>(v)); }
  Bytes& raw(std::string_view s) {
    bytes_ += s;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

inline std::string bundle(std::uint64_t time_tag, const std::vector<std::string>& elements) {
  Bytes b;
  b.text("#bundle").u64(time_tag);
  for (const std::string& e : elements) b.u32(static_cast<std::uint32_t>(e.size())).raw(e);
  return b.str();
}

/// `/n ,i number`
inline std::string numbered(std::uint32_t number) { return Bytes().text("/n").text(",i").u32(number).str(); }

/// A message with one float.
inline std::string one_float(std::string_view address, float value) {
  return Bytes().text(address).text(",f").f(value).str();
}

}  // namespace limber::osc::test
