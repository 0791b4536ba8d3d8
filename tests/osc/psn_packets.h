// Builds packets of PosiStageNet 2, as the protocol's description lays them out.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limber::osc::test {

inline std::string little_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; i++) out += static_cast<char>(value >> (8 * i) & 0xffU);
  return out;
}
inline std::string floats(const std::vector<float>& values) {
  std::string out;
  for (const float value : values) out += little_endian(std::bit_cast<std::uint32_t>(value), 4);
  return out;
}
inline std::string psn_chunk(unsigned id, std::string_view data, bool has_chunks = false) {
  return little_endian(id | data.size() << 16U | (has_chunks ? 1ULL << 31U : 0), 4) + std::string(data);
}
inline std::string psn_header(std::uint64_t timestamp, int version = 2) {
  return psn_chunk(0, little_endian(timestamp, 8) + static_cast<char>(version) + std::string("\x03\x07\x01", 3));
}
/// A tracker of a data packet: position, speed, orientation, validity.
inline std::string psn_data_tracker(unsigned id, const std::vector<float>& position, const std::vector<float>& turn,
                                    float validity = 1) {
  return psn_chunk(id,
                   psn_chunk(0, floats(position)) + psn_chunk(1, floats({9, 9, 9})) + psn_chunk(2, floats(turn)) +
                       psn_chunk(3, floats({validity})) + psn_chunk(6, little_endian(77, 8)),
                   true);
}
inline std::string psn_info_tracker(unsigned id, std::string_view name) {
  return psn_chunk(id, psn_chunk(0, name), true);
}
inline std::string psn_data(std::uint64_t timestamp, std::string_view trackers) {
  return psn_chunk(0x6755, psn_header(timestamp) + psn_chunk(1, trackers, true), true);
}
inline std::string psn_info(std::string_view trackers) {
  return psn_chunk(0x6756, psn_header(1) + psn_chunk(1, "stage") + psn_chunk(2, trackers, true), true);
}

}  // namespace limber::osc::test
