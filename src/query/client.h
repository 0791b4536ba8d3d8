// Client: one WebSocket's conversation: what it listens to, what it is told. Knows no sockets. [query]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/command.h"
#include "engine/feed.h"
#include "query/doors.h"

namespace limber {

/// The way to a client.
class ClientLine {
 public:
  virtual ~ClientLine() = default;
  /// Queues a frame: text, else binary. More than it can hold ends the connection.
  virtual void send(bool text, std::string frame) = 0;
  /// Bytes that wait to be taken.
  virtual std::size_t waiting() const = 0;
};

class Client {
 public:
  static constexpr std::size_t kRoom = std::size_t{64} << 10;  ///< Values are told while less than this waits.
  static constexpr int kMostErrors = 10;                       ///< In a second.

  /// `line` outlives it.
  Client(const Origin& origin, ClientLine& line, const QueryDoors& doors);

  /// A text frame: `{"COMMAND":"LISTEN","DATA":"/path"}`, IGNORE, LIMBER_LOG (`DATA` true or false). What is none is
  /// left alone. True: it waits for a first value.
  bool text(std::string_view frame);
  /// A binary frame: an OSC packet, handed on as if it had come by UDP.
  void binary(std::string_view frame);

  /// A new image, and the notices of what came and went since the one before.
  void image(const std::shared_ptr<const Image>& image, std::span<const std::string> notices);
  /// An answer to something that it has sent; errors at most ten a second. `now` in s.
  void answer(const Outgoing& out, double now);
  /// New lines of the log, where it has asked for them.
  void log();

  bool listens() const { return !feed_.empty(); }
  const Origin& origin() const { return origin_; }

 private:
  Origin origin_;
  ClientLine& line_;
  const QueryDoors& doors_;
  Feed feed_;
  bool wants_log_ = false;
  std::uint64_t seen_line_ = 0;
  double errors_since_ = 0;  // s
  int errors_ = 0;
};

}  // namespace limber
