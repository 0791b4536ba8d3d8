// Receiver: owns the listening sockets. A datagram is checked against the allow list, validated and decoded; then it
// is pushed into the engine's command queue as one command with all its messages, at once or at its time tag; so are
// packets of PosiStageNet, which any of the sockets may receive. Sockets
// are read ahead of decoding, so that urgent requests (engine/commands/urgent.h) reach the engine even when many
// datagrams are queued before them.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/net/udp_socket.h"
#include "engine/output/engine_link.h"
#include "net/osc/clock.h"
#include "net/osc/endpoint.h"
#include "net/osc/options.h"
#include "net/osc/packets/decode.h"
#include "net/osc/psn/psn_input.h"
#include "net/osc/scheduled_commands.h"
#include "net/osc/warning_throttle.h"

namespace limber::osc {

/// Callbacks for everything that the receiver does not push into the engine's command queue.
struct ReceiverCallbacks {
  /// Sends an /error message to the sender of a rejected message.
  std::function<void(const engine::Outgoing&)> error = [](const engine::Outgoing&) {};
  /// Answers a /ping.
  std::function<void(const CommandOrigin&)> pong = [](const CommandOrigin&) {};
  /// Handles /subscribe and /unsubscribe.
  std::function<Result<void>(const Message&, const CommandOrigin&)> subscribe =
      [](const Message&, const CommandOrigin&) { return Result<void>(); };
  /// True if the sender has subscriptions, so that the values it sets must be tracked.
  std::function<bool(const CommandOrigin&)> is_subscriber = [](const CommandOrigin&) { return false; };
  /// Called for each datagram that a socket receives.
  std::function<void(const Endpoint&, std::size_t bytes)> received = [](const Endpoint&, std::size_t) {};
  /// Called for each `/token` message.
  std::function<void(const Message&, const CommandOrigin&)> token = [](const Message&, const CommandOrigin&) {};
  /// Called for each message that looks like an answer to an /error.
  std::function<void(const CommandOrigin&)> error_answered = [](const CommandOrigin&) {};
};

/// Receives and decodes OSC input. [net], unless noted otherwise.
class Receiver {
 public:
  Receiver(engine::EngineLink& link, std::vector<Cidr> allow, ReceiverCallbacks callbacks, const NetClock& clock);
  ~Receiver();

  /// Closes sockets that are not in the list, opens the missing ones and leaves the others alone. Returns an error text
  /// for each address that could not be opened.
  std::vector<std::string> listen(const std::vector<ListenAddress>& addresses);
  /// Every second, tries to open the missing ones of the same list again. Returns true if one was opened.
  bool retry_listen(const std::vector<ListenAddress>& addresses);
  void close();

  /// The sockets to poll, and their bound endpoints in the same order.
  std::vector<int> descriptors() const;
  std::vector<Endpoint> bound() const;

  /// Result of scanning a packet before it is decoded.
  struct ScanResult {
    std::uint64_t arrival = 0;  ///< As Command::arrival; 0: the command queue assigns the number.
    bool urgent = false;        ///< Its urgent requests were pushed to the engine.
  };
  static constexpr std::size_t kMaxQueued = 16384;  ///< Maximum number of datagrams queued for decoding.
  static constexpr std::size_t kMaxQueuedBytes = std::size_t{16} << 20;
  /// Decoding budget of one process_pending() call.
  static constexpr std::size_t kDecodeSliceBytes = std::size_t{256} << 10;

  /// Reads all waiting datagrams of the socket into the queue, at most 1024, so that streams are not delayed. Call
  /// process_pending() afterwards.
  void receive(int fd);
  /// Pushes a packet's urgent requests to the engine, unless the sender is not allowed, the packet is invalid or its
  /// time tag is in the future. [any]
  ScanResult scan(const char* data, std::size_t size, const CommandOrigin& origin) const;
  /// Processes one datagram as if a socket had received it; entry point of the fuzz target.
  void process(const char* data, std::size_t size, const Endpoint& from) {
    process(data, size, {CommandSource::osc, from.ip, from.port});
  }
  /// Processes a packet that arrived by another transport.
  void process(const char* data, std::size_t size, CommandOrigin origin) { process(data, size, origin, {}); }
  void process(const char* data, std::size_t size, CommandOrigin origin, ScanResult scanned);
  /// Decodes a slice of the queued datagrams, pushes the scheduled bundles that are due, and wakes the engine if
  /// anything was pushed since the last call.
  void process_pending();
  /// Nanoseconds until process_pending() or retry_listen() has work; empty if none is expected.
  std::optional<std::int64_t> timeout() const;

  /// Returns the listening socket that received this sender's last message, so that the answer has the source address
  /// that the sender expects; -1 if it is no longer known.
  int socket_of(const Endpoint& sender) const;

 private:
  struct ListenSocket;
  struct KnownSender {
    Endpoint sender;
    int fd = -1;
  };
  static constexpr std::size_t kKnownSlots = 256;  // a power of two

  std::optional<std::string> open(const ListenAddress& address);
  bool can_retry(const std::vector<ListenAddress>& addresses) const;
  void enqueue(ListenSocket& socket, const char* data, std::size_t size, const Endpoint& from);
  void decode_slice();
  void process_psn(std::string_view bytes, const CommandOrigin& origin, ScanResult scanned);
  void log_messages(const CommandOrigin& origin, const Decoded& packet);
  void deliver_later(const Decoded& packet, std::vector<engine::Command> commands, const CommandOrigin& origin);
  void deliver(std::uint64_t time_tag, engine::Command command, bool urgent_pushed);
  void push(engine::Command command, bool urgent_pushed = false);
  void reject(const CommandOrigin& origin, const std::string& address, const std::string& text);
  void record_kernel_drops(ListenSocket& socket, std::uint32_t count);
  bool allowed(const IpAddress& ip) const;
  template <class Text>
  void warn_throttled(WarningThrottle& throttle, const Text& text);

  engine::EngineLink& link_;
  std::vector<Cidr> allow_;
  ReceiverCallbacks callbacks_;
  const NetClock& clock_;
  ScheduledCommands scheduled_;
  std::vector<std::unique_ptr<ListenSocket>> sockets_;
  std::optional<std::int64_t> retry_at_;  // ns; next attempt to open the missing sockets
  std::vector<ListenAddress> unopened_;   // optional ones that were reported
  system::DatagramReader reader_;
  struct QueuedDatagram {
    std::string bytes;
    Endpoint from;
    ScanResult scanned;
  };
  std::deque<QueuedDatagram> queue_;  // datagrams read but not yet decoded
  std::size_t queued_bytes_ = 0;
  std::array<KnownSender, kKnownSlots> known_senders_{};
  bool wake_pending_ = false;  // since the engine was last woken
  bool reported_buffer_ = false;
  PsnInput psn_;
  WarningThrottle malformed_log_, denied_log_, queue_full_log_, kernel_drops_log_, far_future_log_, schedule_full_log_;
};

}  // namespace limber::osc
