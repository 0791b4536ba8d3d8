// LightStream: decides which packets a target gets, and when; ArmLatch: decides whether values may be sent. Both are
// independent of threads and sockets.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/snapshot.h"
#include "net/lighting/options.h"
#include "net/lighting/packets.h"

namespace limber::lighting {

/// Whether values are sent. `armed` of a frame alone is not enough: a take that is replayed, or a rewind to an earlier
/// moment, must not start lights. Live, a controller has to arm the output while the show plays. [one thread]
class ArmLatch {
 public:
  ArmLatch(bool lights, bool in_real_time) : lights_(lights), in_real_time_(in_real_time) {}
  /// Returns true if the values of this moment are sent.
  bool update(bool armed, bool replayed, std::uint64_t tick);

 private:
  bool lights_, in_real_time_;
  bool first_ = true;
  bool last_armed_ = false, last_replayed_ = false;
  std::uint64_t last_tick_ = 0;
  bool permitted_ = false;
};

/// The packets of one target. Values that have changed are sent as soon as the rate allows, and three times more;
/// values that stay, every 0.9 s. [one thread]
class LightStream {
 public:
  using Send = std::function<void(const system::Endpoint& to, const std::string& packet)>;
  static constexpr std::int64_t kKeepAlive = 900'000'000;  ///< ns
  static constexpr int kRepeats = 3;

  LightStream(LightTarget target, const Cid& cid, Send send);

  /// Sends the packets that are due at `now` (ns). Returns when the next ones are, if no value changes.
  std::optional<std::int64_t> update(const sim::DmxFrame& frame, std::int64_t now);
  /// Ends output: sends dark values, or none, as the target's settings say, and declares the end of each universe to
  /// receivers of sACN.
  void end();
  const LightTarget& target() const { return target_; }

 private:
  struct Universe {
    std::uint16_t number = 0;
    std::uint16_t length = 0;
    std::array<std::uint8_t, sim::kDmxChannels> values{};
    std::array<std::uint8_t, sim::kDmxChannels> dark{};
    std::uint8_t sequence = 0;
    std::int64_t sent = 0;  // ns
    int repeats = 0;        // number of packets with these values still to be sent at the full rate
    bool is_new = true;
    bool present = false;  // in the latest frame
  };
  Universe& universe(std::uint16_t number);
  bool sends(std::uint16_t universe) const;
  static void assign(Universe& to, const sim::DmxUniverse& from, bool dark);
  void send(Universe& universe, const std::array<std::uint8_t, sim::kDmxChannels>& values, bool terminated = false);
  void end(Universe& universe);
  void send_sync();

  LightTarget target_;
  Cid cid_;
  Send send_;
  std::int64_t interval_;  // ns
  std::vector<Universe> universes_;
  std::map<std::uint16_t, std::uint8_t> sequences_;  // of universes that have ended, so that they go on from there
  std::uint8_t sync_sequence_ = 0;
  std::string packet_;  // scratch
};

}  // namespace limber::lighting
