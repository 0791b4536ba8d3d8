// Bytes of a TCP connection: any division into pieces gives the same packets, and these survive being framed again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "net/osc/tcp/framing.h"

namespace {

using limber::osc::Framing;
using limber::osc::PacketSplitter;

// Appends the packets to `packets`. Returns false after an error.
bool take_packets(PacketSplitter& splitter, std::vector<std::string>& packets) {
  for (;;) {
    auto next = splitter.next();
    if (!next) return false;
    if (!*next) return true;
    if ((*next)->size() > PacketSplitter::kMaxPacket) std::abort();
    packets.push_back(std::move(**next));
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  PacketSplitter whole;
  whole.append(bytes);
  std::vector<std::string> expected;
  const bool valid = take_packets(whole, expected);

  PacketSplitter pieces;
  std::vector<std::string> packets;
  const std::size_t step = 1 + data[0];
  bool still_valid = true;
  for (std::size_t i = 0; i < bytes.size() && still_valid; i += step) {
    pieces.append(bytes.substr(i, step));
    still_valid = take_packets(pieces, packets);
  }
  if (still_valid != valid || packets != expected) std::abort();

  for (const Framing framing : {Framing::slip, Framing::length}) {
    std::string framed;
    for (const std::string& packet : expected) append_framed(framing, packet, framed);
    PacketSplitter again;
    again.append(framed);
    packets.clear();
    const bool read = take_packets(again, packets);
    // SLIP has no empty packets
    std::erase_if(expected, [&](const std::string& packet) { return framing == Framing::slip && packet.empty(); });
    if (!read || packets != expected) std::abort();
  }
  return 0;
}
