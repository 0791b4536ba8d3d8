// Packets of Art-Net 4, of sACN (ANSI E1.31-2018) and of the Enttec DMX USB Pro with the values of a DMX universe.
// [any]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace limber::lighting {

inline constexpr std::uint16_t kArtNetPort = 6454;
inline constexpr std::uint16_t kSacnPort = 5568;
inline constexpr std::size_t kSourceNameBytes = 64;  ///< Of sACN, with the terminating 0.

/// Writes an ArtDmx packet to `out`. `universe`: the Port-Address. `sequence`: 1 .. 255. The number of values is padded
/// to an even one.
void write_art_dmx(std::uint16_t universe, std::uint8_t sequence, std::span<const std::uint8_t> values,
                   std::string& out);

using Cid = std::array<std::uint8_t, 16>;  ///< Identifies a source of sACN.

/// The fields of a data packet of sACN besides its values.
struct SacnHeader {
  Cid cid{};
  std::string_view source_name;  ///< At most 63 bytes are used.
  std::uint16_t universe = 1;
  std::uint8_t priority = 100;      ///< 0 .. 200
  std::uint16_t sync_universe = 0;  ///< Universe of the synchronization packets; 0: none.
  std::uint8_t sequence = 0;
  bool terminated = false;  ///< The source stops sending this universe.
};

/// Writes a data packet of sACN to `out`: start code 0 and the values.
void write_sacn_data(const SacnHeader& header, std::span<const std::uint8_t> values, std::string& out);
/// Writes a synchronization packet of sACN to `out`.
void write_sacn_sync(const Cid& cid, std::uint16_t universe, std::uint8_t sequence, std::string& out);
/// Writes a packet for the Enttec DMX USB Pro to `out`: "Output Only Send DMX" of its API, with at least 24 values.
void write_enttec(std::span<const std::uint8_t> values, std::string& out);

/// Returns the multicast address of a universe in host byte order: 239.255.high.low.
constexpr std::uint32_t sacn_multicast(std::uint16_t universe) { return 0xefff0000U | universe; }

}  // namespace limber::lighting
