// Options of the output to lights, as typed. [any]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/net/socket.h"

namespace limber::lighting {

enum class Protocol : std::uint8_t { art_net, sacn, enttec };

/// A receiver of all universes, or of one by a serial port.
struct LightTarget {
  Protocol protocol = Protocol::sacn;
  system::Endpoint to;          ///< An ip of 0: the multicast group of each universe (sACN).
  double rate = 44;             ///< Largest number of packets per second and universe.
  std::uint8_t priority = 100;  ///< sACN: 0 .. 200.
  std::uint16_t sync = 0;       ///< sACN: universe of the synchronization packets; 0: none.
  std::uint32_t interface = 0;  ///< Address of this machine to send from; 0: the system chooses.
  std::string name = "Limber";  ///< sACN: name of the source.
  std::string device;           ///< enttec: name of the serial port.
  std::uint16_t universe = 1;   ///< enttec: the one that it sends.
  bool dark_at_end = true;      ///< Sends dark values when output ends; else the lights keep the last ones.
  bool dark_in_panic = false;   ///< Sends dark values during a panic.
};

struct LightingOptions {
  std::vector<LightTarget> targets;
  bool lights = false;       ///< `--lights`: replays and --fast send, too.
  bool in_real_time = true;  ///< False with --fast.
};

/// Parses one value of --lights-out: "artnet:10.0.0.5,rate=30", "sacn,priority=120,sync=1",
/// "enttec:/dev/ttyUSB0,universe=2"; "off": no target.
Result<std::vector<LightTarget>> parse_lights_out(std::string_view text);
/// Describes a target: "sACN multicast, priority 100, at most 44 Hz".
std::string target_text(const LightTarget& target);

}  // namespace limber::lighting
