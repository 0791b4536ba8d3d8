// What travels between the outside and the simulation: commands in, answers and events out, and the plan of ports.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"

namespace limber {

/// Messages that belong together (one datagram, one line of the console): applied as one, in one tick.
struct Command {
  std::vector<Message> messages;
  Origin origin;
};

/// A message on its way out.
struct Outgoing {
  enum class To : std::uint8_t {
    sender,   ///< An answer, to `origin`.
    error,    ///< An answer to `origin`, and to targets that ask for errors.
    targets,  ///< A scene's osc:send: every target.
    event,    ///< Contacts, transport, script errors: every target (and later subscribers).
    direct,   ///< To `origin` as an address that the scene named.
  };
  To to = To::targets;
  Origin origin;
  Message message;
};

/// What the receiver and the dispatch have counted; readouts under /osc. Any thread adds. [any]
struct Counters {
  std::atomic<std::uint64_t> received{0};        ///< Messages that came in whole.
  std::atomic<std::uint64_t> malformed{0};       ///< Datagrams that are no OSC.
  std::atomic<std::uint64_t> unknown{0};         ///< Messages with an address that nobody answers.
  std::atomic<std::uint64_t> refused{0};         ///< Known address, wrong arguments or names.
  std::atomic<std::uint64_t> clamped{0};         ///< Values outside their range.
  std::atomic<std::uint64_t> dropped{0};         ///< Lost here: the inbox was full.
  std::atomic<std::uint64_t> dropped_kernel{0};  ///< Lost by the kernel: the socket's buffer was full.
  std::atomic<std::uint64_t> sent{0};            ///< Datagrams sent.
};

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
