// OscPlan: where OSC comes in and where frames go, as a scene or the command line wishes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limber {

/// Where frames are streamed to, and how.
struct StreamTarget {
  std::string host = "127.0.0.1";
  std::uint16_t port = 9005;
  double rate = 60;  ///< Frames per second of real time, 0.1 .. 1000.
  bool pos = true, rot = true, relrot = true, relpos = false;
  std::string bodies = "*";  ///< Name or OSC pattern.
  int bundle = -1;           ///< Bytes 1472, 8192, 65504; 0: off; -1: off up to 20 bodies, else 1472.
  bool errors = false;       ///< Wants /error messages too.

  bool operator==(const StreamTarget&) const = default;
};

struct ListenAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 9003;

  bool operator==(const ListenAddress&) const = default;
};

/// Where OSC comes in and goes out. The command line wins over the scene, the scene over the default.
struct OscPlan {
  std::vector<ListenAddress> listen;
  std::vector<StreamTarget> targets;

  bool operator==(const OscPlan&) const = default;
};

}  // namespace limber
