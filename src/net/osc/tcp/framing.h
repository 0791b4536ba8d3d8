// OSC packets in a stream of bytes: with SLIP (RFC 1055, as OSC 1.1 prescribes), or each after its length (OSC 1.0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"

namespace limber::osc {

enum class Framing : std::uint8_t { unknown, slip, length };

/// Takes packets out of received bytes. The first byte selects the framing: 0, the first of a length; else SLIP.
/// [one thread]
class PacketSplitter {
 public:
  static constexpr std::size_t kMaxPacket = 65536;  ///< bytes

  void append(std::string_view bytes) { bytes_.append(bytes); }
  /// Returns the next complete packet, or nothing. After an error (a packet that is too large, a wrong byte) the rest
  /// of the stream has no meaning.
  Result<std::optional<std::string>> next();
  Framing framing() const { return framing_; }

 private:
  Result<std::optional<std::string>> next_with_length();
  Result<std::optional<std::string>> next_of_slip();

  Framing framing_ = Framing::unknown;
  std::string bytes_;      // received
  std::size_t begin_ = 0;  // of the bytes that were not processed
  std::string packet_;     // of SLIP: its beginning
  bool escaped_ = false;   // of SLIP: the next byte belongs to an escape sequence
};

/// Appends a packet to `out`; an unknown framing counts as a length.
void append_framed(Framing framing, std::span<const char> packet, std::string& out);

}  // namespace limber::osc
