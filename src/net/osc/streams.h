// Streams: sends frames of the latest snapshot to each target at its own rate, in real time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/output/engine_link.h"
#include "net/osc/clock.h"
#include "net/osc/sender.h"
#include "net/osc/stream_frame.h"
#include "net/osc/templates/template_frame.h"
#include "net/osc/warning_throttle.h"

namespace limber::osc {

/// Schedules stream frames without drift: frame n of a target is due n periods after its first. Frames more than a
/// period late are skipped. [net]
class Streams {
 public:
  /// Bytes sent to subscribers per call, except for the last frame.
  static constexpr std::size_t kSliceBytes = 131072;

  /// `may_serve` is asked for each frame to a subscriber; a rejected frame is skipped.
  Streams(
      engine::EngineLink& link, const engine::TransientOffsets& offsets, const NetClock& clock,
      SendGate may_serve = [](const Endpoint&, std::size_t, std::size_t) { return true; });

  /// Sets the clients that receive by their connection instead of by UDP.
  void set_tcp(TcpPeers& tcp) { tcp_ = &tcp; }
  /// Targets that are also in the old list keep their schedule.
  void set_targets(const std::vector<ResolvedTarget>& targets);
  /// Sends the frames that are due; those to subscribers in slices, so that input is not delayed. The snapshot of a
  /// paused world is sent repeatedly.
  void send_due(system::UdpSender& sender);
  /// Nanoseconds until the next frame is due; empty if there are no streams.
  std::optional<std::int64_t> timeout() const;

 private:
  struct Stream {
    Stream(const ResolvedTarget& t, const engine::TransientOffsets& offsets, std::int64_t now)
        : target(t), next_due(now), frame(offsets) {}
    ResolvedTarget target;
    std::int64_t next_due;
    StreamFrame frame;
    TemplateFrame templates;
    std::vector<std::string> reported;  // problems of templates
    std::shared_ptr<const engine::BodyList>
        reported_too_large;    // the body list for which a too large message was reported
    bool segmentation = true;  // cleared if the route does not support segmentation offload
  };

  std::size_t send_frame(system::UdpSender& sender, Stream& stream, const engine::Snapshot& snapshot);
  void send_templates(system::UdpSender& sender, Stream& stream);
  template <class Frame>
  void send(system::UdpSender& sender, Stream& stream, const Frame& frame);
  system::BatchResult send_by_tcp(const Endpoint& to, std::span<const char> bytes,
                                  std::span<const std::uint32_t> sizes);
  void log_frame(const Stream& stream, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                 std::size_t datagrams);

  engine::EngineLink& link_;
  const engine::TransientOffsets offsets_;
  const NetClock& clock_;
  const SendGate may_serve_;
  TcpPeers* tcp_ = nullptr;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::size_t first_ = 0;  // index of the stream to check first
  WarningThrottle lost_log_;
};

}  // namespace limber::osc
