// Packets of PosiStageNet 2, the protocol of tracking systems on stages (posistage.net): data packets with the places
// of trackers, about 60 times a second, and info packets with their names, about once a second. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber::osc {

/// A tracker in a packet, in the protocol's axes: x to the right, y up, z into the depth of the stage.
struct PsnTracker {
  std::uint16_t id = 0;
  std::string_view name;          ///< In info packets.
  std::optional<Vec3> position;   ///< m
  std::optional<Vec3> rotation;   ///< Along the axis, with the angle in rad as its length.
  std::optional<float> validity;  ///< 0: it isn't seen.
};

struct PsnPacket {
  enum class Kind : std::uint8_t { data, info };
  Kind kind = Kind::data;
  std::uint64_t timestamp = 0;  ///< Of the frame, microseconds since the start of the sender.
  std::vector<PsnTracker> trackers;
};

/// True if the bytes begin like a packet of PosiStageNet 2, as no OSC packet does.
bool is_psn(std::string_view bytes);

/// Decodes a packet. Texts point into `bytes`. Unknown chunks, also those of later versions, are skipped. Errors: a
/// chunk is longer than the packet or shorter than its values, the header is missing, another major version.
Result<PsnPacket> parse_psn(std::string_view bytes);

}  // namespace limber::osc
