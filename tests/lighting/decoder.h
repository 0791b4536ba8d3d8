// Independent decoders of Art-Net and sACN, written from the specifications (Art-Net 4, "ArtDmx"; ANSI E1.31-2018,
// tables 4-1, 6-5 and 6-7). Each returns nothing if a byte differs from the specification.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace limber::lighting::test {

struct ArtDmx {
  int sequence = 0;
  int universe = 0;
  std::vector<int> values;
};

inline int octet(const std::string& packet, std::size_t at) { return static_cast<unsigned char>(packet.at(at)); }
inline int word_at(const std::string& packet, std::size_t at) {
  return octet(packet, at) * 256 + octet(packet, at + 1);
}
inline std::uint32_t long_at(const std::string& packet, std::size_t at) {
  return static_cast<std::uint32_t>(word_at(packet, at)) << 16U | static_cast<std::uint32_t>(word_at(packet, at + 2));
}

inline std::optional<ArtDmx> decode_art_dmx(const std::string& packet) {
  if (packet.size() < 20 || std::memcmp(packet.data(), "Art-Net\0", 8) != 0) return std::nullopt;
  if (octet(packet, 8) != 0x00 || octet(packet, 9) != 0x50) return std::nullopt;  // OpDmx, low byte first
  if (word_at(packet, 10) != 14 || octet(packet, 13) != 0) return std::nullopt;
  const int length = word_at(packet, 16);
  if (length < 2 || length > 512 || length % 2 != 0 || packet.size() != 18U + static_cast<unsigned>(length))
    return std::nullopt;
  ArtDmx out{octet(packet, 12), octet(packet, 15) * 256 + octet(packet, 14), {}};
  for (std::size_t i = 18; i < packet.size(); i++) out.values.push_back(octet(packet, i));
  return out;
}

struct Sacn {
  bool sync = false;
  std::string cid, source;
  int priority = 0, sync_universe = 0, sequence = 0, options = 0, universe = 0;
  std::vector<int> values;
};

inline std::optional<Sacn> decode_sacn(const std::string& packet) {
  const auto length_ok = [&](std::size_t at) {
    return word_at(packet, at) == 0x7000 + static_cast<int>(packet.size() - at);
  };
  if (packet.size() < 49 || word_at(packet, 0) != 16 || word_at(packet, 2) != 0) return std::nullopt;
  if (std::memcmp(packet.data() + 4, "ASC-E1.17\0\0\0", 12) != 0 || !length_ok(16) || !length_ok(38))
    return std::nullopt;
  Sacn out;
  out.cid = packet.substr(22, 16);
  if (long_at(packet, 18) == 8) {
    if (packet.size() != 49 || long_at(packet, 40) != 1 || word_at(packet, 47) != 0) return std::nullopt;
    out.sync = true;
    out.sequence = octet(packet, 44);
    out.sync_universe = word_at(packet, 45);
    return out;
  }
  if (long_at(packet, 18) != 4 || packet.size() < 126 || long_at(packet, 40) != 2) return std::nullopt;
  out.source = packet.substr(44, 64).c_str();
  const std::string padding = packet.substr(44 + out.source.size(), 64 - out.source.size());
  if (padding.find_first_not_of('\0') != std::string::npos || padding.empty()) return std::nullopt;
  out.priority = octet(packet, 108);
  out.sync_universe = word_at(packet, 109);
  out.sequence = octet(packet, 111);
  out.options = octet(packet, 112);
  out.universe = word_at(packet, 113);
  if (!length_ok(115) || octet(packet, 117) != 2 || octet(packet, 118) != 0xa1) return std::nullopt;
  if (word_at(packet, 119) != 0 || word_at(packet, 121) != 1 || octet(packet, 125) != 0) return std::nullopt;
  if (word_at(packet, 123) != static_cast<int>(packet.size()) - 125) return std::nullopt;
  for (std::size_t i = 126; i < packet.size(); i++) out.values.push_back(octet(packet, i));
  return out;
}

/// Values of a whole universe that begin with these; sACN sends all 512.
inline std::vector<int> padded(std::vector<int> values) {
  values.resize(512);
  return values;
}

}  // namespace limber::lighting::test
