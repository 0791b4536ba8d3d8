// QueryClient: protocol state of one WebSocket connection: the paths it listens to and the frames sent to it. It does
// no I/O itself. [query]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/commands/command.h"
#include "engine/output/feed.h"
#include "net/oscquery/host.h"

namespace limber::oscquery {

/// The sending side of a client's connection.
class ClientSink {
 public:
  virtual ~ClientSink() = default;
  /// Queues a text or binary frame. Closes the connection if the queue exceeds its limit.
  virtual void send(bool text, std::string frame) = 0;
  /// Number of queued bytes.
  virtual std::size_t queued_bytes() const = 0;
};

/// One WebSocket client.
class QueryClient {
 public:
  /// Values are sent only while fewer bytes are queued.
  static constexpr std::size_t kMaxQueuedForValues = std::size_t{64} << 10;
  static constexpr int kMaxErrors = 10;  ///< Per second.

  /// `sink` must outlive the client.
  QueryClient(const CommandOrigin& origin, ClientSink& sink, const QueryHost& host);

  /// Handles a text frame: `{"COMMAND":"LISTEN","DATA":"/path"}`, IGNORE or LIMBER_LOG (`DATA` true or false). Ignores
  /// unknown frames. Returns true if the client waits for the first value of a path.
  bool on_text(std::string_view frame);
  /// Handles a binary frame: an OSC packet, processed as if it had arrived by UDP.
  void on_binary(std::string_view frame);

  /// Sends path events and changed values from a new value snapshot.
  void on_snapshot(const std::shared_ptr<const engine::ValueSnapshot>& snapshot, std::span<const std::string> events);
  /// Sends the reply to one of the client's messages; errors at most ten per second. `now` in s.
  void send_reply(const engine::Outgoing& out, double now);
  /// Sends new log lines if the client has requested them.
  void send_log();

  bool is_listening() const { return !feed_.empty(); }
  const CommandOrigin& origin() const { return origin_; }

 private:
  CommandOrigin origin_;
  ClientSink& sink_;
  const QueryHost& host_;
  engine::Feed feed_;
  bool wants_log_ = false;
  std::uint64_t seen_line_ = 0;
  double error_window_start_ = 0;  // start of the current second, s
  int errors_ = 0;
};

}  // namespace limber::oscquery
