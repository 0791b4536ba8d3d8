// PsnInput: translates packets of PosiStageNet to messages, which motion capture of a scene receives like OSC, so that
// takes record them. A message names the tracker: /psn/tracker name x y z qw qx qy qz confidence. [net]
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"
#include "net/osc/psn/psn_packet.h"

namespace limber::osc {

class PsnInput {
 public:
  static constexpr const char* kAddress = "/psn/tracker";
  static constexpr std::size_t kMaxSenders = 8;
  static constexpr std::size_t kMaxNames = 1024;               ///< Of a sender.
  static constexpr std::int64_t kNameTimeout = 2'000'000'000;  ///< ns that data wait for the first names.
  static constexpr std::uint64_t kMaxReordering = 1'000'000;   ///< Microseconds; an older packet is a restart.

  /// Returns the messages of a packet from the address `ip` at the time `now` (ns). None for an info packet, for one
  /// that is older than its predecessor, for trackers without values, and until the names of the sender's trackers are
  /// known. Error: parse_psn().
  Result<std::vector<Message>> translate(std::string_view bytes, const system::IpAddress& ip, std::int64_t now);

 private:
  struct Sender {
    system::IpAddress ip;
    std::int64_t first_seen = 0;  // ns
    std::int64_t last_seen = 0;
    std::uint64_t timestamp = 0;  // of the newest data packet
    bool has_data = false;
    std::map<std::uint16_t, std::string> names;
    std::set<std::string> used_names;
  };

  Sender& sender_of(const system::IpAddress& ip, std::int64_t now);
  static void learn(Sender& sender, const std::vector<PsnTracker>& trackers);
  static bool is_late(Sender& sender, std::uint64_t timestamp);

  std::vector<Sender> senders_;
};

}  // namespace limber::osc
