// OscConfig: the OSC ports to listen on and the targets to stream to, as a scene or the command line configures them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limber {

/// A template of messages: the values of each object, or of all objects of a body.
struct StreamMessage {
  std::string address;  ///< With {name}, {body} and {index} for those of the object.
  std::string objects;  ///< Address or pattern of objects.
  /// Properties, such as "position", "position.x" or "-position.y", in the order of the arguments; or texts with
  /// {name}, {body} or {index}.
  std::vector<std::string> values;
  double scale = 1;       ///< Factor of the numbers.
  bool per_body = false;  ///< One message for all objects of a body, instead of one for each object.

  bool operator==(const StreamMessage&) const = default;
};

/// A host that receives frames, and the contents of its frames.
struct StreamTarget {
  std::string host = "127.0.0.1";
  std::uint16_t port = 9005;
  double rate = 60;  ///< Frames per second of real time, 0.1 .. 1000.
  bool pos = true, rot = true, relrot = true, relpos = false;
  std::string bodies = "*";  ///< Body name or OSC pattern.
  int bundle = -1;  ///< Bundle size in bytes: 1472, 8192 or 65504; 0: no bundles; -1: none up to 20 bodies, else 1472.
  bool errors = false;                       ///< Send /error messages too.
  std::vector<StreamMessage> messages = {};  ///< More messages, described by templates.

  bool operator==(const StreamTarget&) const = default;
};

/// A local address and a port to listen on.
struct ListenAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 9003;
  bool optional = false;  ///< If it can't be opened, this is a warning, and opening it is tried again.
  bool shared = false;    ///< Other programs may open the UDP port, too.

  bool operator==(const ListenAddress&) const = default;
};

/// The OSC inputs and outputs. The command line overrides the scene, which overrides the default.
struct OscConfig {
  std::vector<ListenAddress> listen;
  std::vector<StreamTarget> targets;
  std::vector<ListenAddress> trackers = {};  ///< Inputs of motion capture, in addition to `listen`.

  bool operator==(const OscConfig&) const = default;
};

}  // namespace limber
