// The streams: frames of the newest snapshot to each target, at its own rate of real time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/link.h"
#include "osc/clock.h"
#include "osc/seldom.h"
#include "osc/sender.h"
#include "osc/stream_frame.h"

namespace limber {

/// Deadlines do not drift: frame n of a target is due n periods after its first. Frames that were missed by more than
/// a period are left out, not sent late. [net]
class Streams {
 public:
  static constexpr std::size_t kSlice = 131072;  ///< Bytes to subscribers, but for the last frame.

  /// `may_serve`: of frames to subscribers; a frame that may not be sent is left out.
  Streams(
      EngineLink& link, const LiveOffsets& offsets, const NetClock& clock,
      SendGate may_serve = [](const Endpoint&, std::size_t, std::size_t) { return true; });

  /// Targets that stand in the old list too keep their beat.
  void set_targets(const std::vector<Target>& targets);
  /// Sends what is due, to subscribers at most a slice, so that input gets its turn. A paused world's snapshot is sent
  /// again and again.
  void send_due(system::UdpSender& sender);
  /// Nanoseconds until the next frame; nothing without streams.
  std::optional<std::int64_t> wait() const;

 private:
  struct Stream {
    Stream(const Target& t, const LiveOffsets& offsets, std::int64_t now) : target(t), due(now), frame(offsets) {}
    Target target;
    std::int64_t due;
    StreamFrame frame;
    std::shared_ptr<const Roster> said_too_large;  // the roster about which it was said
    bool segmentation = true;
  };

  std::size_t send_frame(system::UdpSender& sender, Stream& stream, const Snapshot& snapshot);
  void note_frame(const Stream& stream, std::size_t datagrams);

  EngineLink& link_;
  const LiveOffsets offsets_;
  const NetClock& clock_;
  const SendGate may_serve_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::size_t next_ = 0;  // the first one to look at
  Seldom lost_;
};

}  // namespace limber
