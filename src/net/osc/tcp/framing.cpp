// Both framings.
#include "net/osc/tcp/framing.h"

#include <utility>

#include <fmt/format.h>

namespace limber::osc {

namespace {

constexpr char kEnd = '\xc0';
constexpr char kEscape = '\xdb';
constexpr char kEscapedEnd = '\xdc';
constexpr char kEscapedEscape = '\xdd';
constexpr std::size_t kLengthBytes = 4;

Error too_large(std::size_t bytes) {
  return Error{fmt::format("a packet of {} bytes or more; at most {} are accepted", bytes, PacketSplitter::kMaxPacket)};
}

}  // namespace

Result<std::optional<std::string>> PacketSplitter::next() {
  if (framing_ == Framing::unknown && !bytes_.empty())
    framing_ = bytes_.front() == '\0' ? Framing::length : Framing::slip;
  Result<std::optional<std::string>> packet = framing_ == Framing::length ? next_with_length() : next_of_slip();
  if (!packet || !*packet) {
    bytes_.erase(0, std::exchange(begin_, 0));
  }
  return packet;
}

Result<std::optional<std::string>> PacketSplitter::next_with_length() {
  const std::size_t available = bytes_.size() - begin_;
  if (available < kLengthBytes) return std::optional<std::string>();
  std::size_t length = 0;
  for (std::size_t i = 0; i < kLengthBytes; i++) length = length << 8U | static_cast<unsigned char>(bytes_[begin_ + i]);
  if (length > kMaxPacket) return too_large(length);
  if (available < kLengthBytes + length) return std::optional<std::string>();
  std::string packet = bytes_.substr(begin_ + kLengthBytes, length);
  begin_ += kLengthBytes + length;
  return std::optional(std::move(packet));
}

Result<std::optional<std::string>> PacketSplitter::next_of_slip() {
  while (begin_ < bytes_.size()) {
    const char byte = bytes_[begin_++];
    if (std::exchange(escaped_, false)) {
      if (byte != kEscapedEnd && byte != kEscapedEscape)
        return Error{fmt::format("a wrong escape sequence of SLIP, byte {}", static_cast<unsigned char>(byte))};
      packet_ += byte == kEscapedEnd ? kEnd : kEscape;
    } else if (byte == kEscape) {
      escaped_ = true;
    } else if (byte != kEnd) {
      packet_ += byte;
    } else if (!packet_.empty()) {
      return std::optional(std::exchange(packet_, {}));
    }
    if (packet_.size() > kMaxPacket) return too_large(packet_.size());
  }
  return std::optional<std::string>();
}

void append_framed(Framing framing, std::span<const char> packet, std::string& out) {
  if (framing != Framing::slip) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(packet.size() >> shift & 255U);
    out.append(packet.data(), packet.size());
    return;
  }
  out += kEnd;
  for (const char byte : packet) {
    if (byte == kEnd || byte == kEscape) {
      out += kEscape;
      out += byte == kEnd ? kEscapedEnd : kEscapedEscape;
    } else {
      out += byte;
    }
  }
  out += kEnd;
}

}  // namespace limber::osc
