// A packet is a chunk that contains chunks. All numbers are little-endian.
// Reference: VYV Corporation, PosiStageNet protocol description v2.03, 2019.
#include "net/osc/psn/psn_packet.h"

#include <bit>

#include <fmt/format.h>

namespace limber::osc {

namespace {

constexpr std::uint16_t kDataPacket = 0x6755;
constexpr std::uint16_t kInfoPacket = 0x6756;
constexpr std::uint16_t kHeader = 0;  // in both packets
constexpr std::uint16_t kDataTrackers = 1;
constexpr std::uint16_t kInfoTrackers = 2;
constexpr std::uint16_t kName = 0;  // of a tracker in an info packet
constexpr std::uint16_t kPosition = 0;
constexpr std::uint16_t kRotation = 2;
constexpr std::uint16_t kStatus = 3;

constexpr std::size_t kChunkHeader = 4;
constexpr std::size_t kHeaderSize = 12;  // time stamp, version, number of the frame, packets of the frame
constexpr std::size_t kMajorVersionAt = 8;
constexpr int kMajorVersion = 2;
constexpr const char* kTooShort = "a chunk is shorter than its values";

// Reads an unsigned number of `count` bytes.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

float float_at(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(number_at(bytes, at, 4)));
}

struct Chunk {
  std::uint16_t id = 0;
  std::string_view data;
};

// Calls `visit` with each chunk until it returns an error.
template <class Visit>
Result<void> for_each_chunk(std::string_view bytes, const Visit& visit) {
  while (!bytes.empty()) {
    if (bytes.size() < kChunkHeader) return Error{"the header of a chunk is incomplete"};
    const auto header = static_cast<std::uint32_t>(number_at(bytes, 0, kChunkHeader));
    const std::size_t length = header >> 16U & 0x7fffU;
    bytes.remove_prefix(kChunkHeader);
    if (length > bytes.size())
      return Error{fmt::format("a chunk has {} bytes, but {} are left in the packet", length, bytes.size())};
    if (Result<void> visited = visit(Chunk{static_cast<std::uint16_t>(header & 0xffffU), bytes.substr(0, length)});
        !visited)
      return visited;
    bytes.remove_prefix(length);
  }
  return {};
}

Result<void> read_vector(std::string_view data, std::optional<Vec3>& to) {
  if (data.size() < 12) return Error{kTooShort};
  to = Vec3(float_at(data, 0), float_at(data, 4), float_at(data, 8));
  return {};
}

Result<void> read_value(const Chunk& chunk, PsnTracker& tracker) {
  switch (chunk.id) {
    case kPosition:
      return read_vector(chunk.data, tracker.position);
    case kRotation:
      return read_vector(chunk.data, tracker.rotation);
    case kStatus:
      if (chunk.data.size() < 4) return Error{kTooShort};
      tracker.validity = float_at(chunk.data, 0);
      return {};
    default:
      return {};  // speed, acceleration, target, time stamp
  }
}

Result<void> read_trackers(std::string_view list, PsnPacket& packet) {
  return for_each_chunk(list, [&](const Chunk& chunk) {
    PsnTracker& tracker = packet.trackers.emplace_back();
    tracker.id = chunk.id;
    return for_each_chunk(chunk.data, [&](const Chunk& value) -> Result<void> {
      if (packet.kind == PsnPacket::Kind::data) return read_value(value, tracker);
      if (value.id == kName) tracker.name = value.data.substr(0, value.data.find('\0'));
      return {};
    });
  });
}

Result<void> read_header(std::string_view data, PsnPacket& packet) {
  if (data.size() < kHeaderSize) return Error{kTooShort};
  const int version = static_cast<unsigned char>(data[kMajorVersionAt]);
  if (version != kMajorVersion) return Error{fmt::format("it has version {}, expected {}", version, kMajorVersion)};
  packet.timestamp = number_at(data, 0, 8);
  return {};
}

}  // namespace

bool is_psn(std::string_view bytes) {
  if (bytes.size() < kChunkHeader) return false;
  const std::uint64_t id = number_at(bytes, 0, 2);
  return id == kDataPacket || id == kInfoPacket;
}

Result<PsnPacket> parse_psn(std::string_view bytes) {
  if (!is_psn(bytes)) return Error{"it is no packet of PosiStageNet 2"};
  PsnPacket packet;
  bool has_header = false;
  int roots = 0;
  const Result<void> read = for_each_chunk(bytes, [&](const Chunk& root) -> Result<void> {
    if (roots++ > 0) return Error{"there are bytes after the packet"};
    packet.kind = root.id == kDataPacket ? PsnPacket::Kind::data : PsnPacket::Kind::info;
    const std::uint16_t trackers = packet.kind == PsnPacket::Kind::data ? kDataTrackers : kInfoTrackers;
    return for_each_chunk(root.data, [&](const Chunk& chunk) -> Result<void> {
      if (chunk.id == kHeader) {
        has_header = true;
        return read_header(chunk.data, packet);
      }
      return chunk.id == trackers ? read_trackers(chunk.data, packet) : Result<void>();
    });
  });
  if (!read) return Error{read.error()};
  if (!has_header) return Error{"its header is missing"};
  return packet;
}

}  // namespace limber::osc
