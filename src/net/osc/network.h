// The network thread: polls the listening sockets and the engine's wake-up descriptor, handles incoming packets, and
// sends answers, events and streams.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/result.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/osc/amplification_limit.h"
#include "net/osc/clock.h"
#include "net/osc/host_resolver.h"
#include "net/osc/options.h"
#include "net/osc/receiver.h"
#include "net/osc/sender.h"
#include "net/osc/streams.h"
#include "net/osc/subscribers.h"
#include "net/osc/targets/target_edits.h"
#include "net/osc/targets/unreachable_targets.h"
#include "net/osc/tcp/tcp_peers.h"

namespace limber::osc {

/// The open ports, for display. [any]
class NetworkStatus {
 public:
  void set(std::vector<Endpoint> bound, std::vector<Endpoint> bound_tcp, const std::vector<ResolvedTarget>& targets);
  void clear();
  std::vector<std::string> lines() const;
  std::vector<Endpoint> bound() const;
  std::vector<Endpoint> bound_tcp() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  std::vector<Endpoint> bound_, bound_tcp_;
};

/// Packets of other transports. [net], unless noted otherwise.
class PacketQueue {
 public:
  struct Packet {
    CommandOrigin origin;
    std::string bytes;
    Receiver::ScanResult scanned;
    friend std::size_t weight_of(const Packet& p) { return sizeof p + p.bytes.capacity(); }
  };
  /// Returns false if the queue is full. [any]
  bool push(Packet packet) { return queue_.push(std::move(packet)); }
  /// Returns the queued packets; valid until the next call.
  std::span<const Packet> drain() {
    queue_.drain(batch_);
    return batch_;
  }

 private:
  BoundedQueue<Packet> queue_{8192, std::size_t{16} << 20};
  std::vector<Packet> batch_;
};

/// The engine's messages, which are sent in parts so that input is not delayed. [net]
class Outbox {
 public:
  explicit Outbox(engine::EngineLink& link) : link_(link) {}
  void send(Sender& sender, std::size_t max_messages);
  /// True if a part of the messages is unsent.
  bool has_unsent() const { return next_ < messages_.size(); }

 private:
  engine::EngineLink& link_;
  std::vector<engine::Outgoing> messages_;
  std::size_t next_ = 0;  // index of the first unsent message
};

/// OSC input and output of one engine. Create it before the engine starts: the constructor sets `link.wake_network`,
/// which stays callable after the Network is destroyed. Call start() after the scene has run once, so that the scene's
/// OSC configuration is applied. `link` must outlive the Network.
class Network {
 public:
  Network(engine::EngineLink& link, OscOptions options, const engine::TransientOffsets& offsets, NetClock clock = {},
          ResolveFunction look_up = resolve);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Opens the ports and starts the thread. The error names each port that can't be opened and the option that changes
  /// it. With `--osc-optional` such errors are only logged as warnings and the other ports are opened. [main]
  Result<void> start();
  /// Stops the thread immediately and closes all sockets. Idempotent. [main]
  void stop();

  /// Queues a packet that did not arrive by UDP (OSCQuery's WebSocket) to be handled like a datagram. Answers are sent
  /// through EngineLink::push_out. Returns false if the queue is full; the packet's urgent requests have reached the
  /// engine even then. [any]
  bool enqueue(const CommandOrigin& origin, std::string packet);

  /// Describes the open ports: "OSC in 127.0.0.1:9003", "OSC out 127.0.0.1:9005 (pos+rot+relrot at 60 Hz)". [any]
  std::vector<std::string> status_lines() const { return status_.lines(); }
  /// The bound listening endpoints, with the port that the system chose for port 0. [any]
  std::vector<Endpoint> bound() const { return status_.bound(); }
  /// The same of TCP. [any]
  std::vector<Endpoint> bound_tcp() const { return status_.bound_tcp(); }

 private:
  void run(const std::stop_token& stop);
  void wait_for_events();
  std::vector<std::string> apply(const OscConfig& config);
  std::vector<std::string> resolve_targets(std::chrono::milliseconds wait = {});
  void update_status_lines();
  TcpCallbacks tcp_callbacks();
  void apply_new_config();
  bool process_target_requests();
  OscConfig edited_config() const;
  Result<void> handle_target_request(const TargetEdits::Request& request);
  void retry_listen();
  void retry_look_ups();
  void update_subscribers();
  void update_streams();
  void pong(const CommandOrigin& to);
  void process_packets();
  void update_own_endpoints();
  void record_received(const Endpoint& from, std::size_t bytes);
  void handle_token(const Message& message, const CommandOrigin& origin);
  Result<void> subscribe(const Message& message, const CommandOrigin& origin);
  SendGate subscription_gate();
  void challenge(const Endpoint& peer, bool is_subscribing);
  void publish_health();

  engine::EngineLink& link_;
  const OscOptions options_;
  const NetClock clock_;
  std::shared_ptr<system::Wake> wake_;
  Receiver receiver_;
  TcpPeers tcp_;
  Sender sender_;
  TargetResolver targets_;
  UnreachableTargets unreachable_;
  Streams streams_;
  Subscribers subscribers_;
  PacketQueue packets_;
  Outbox outbox_;
  struct {
    std::shared_ptr<const OscConfig> scene;
    OscConfig current;
    TargetEdits edits;
  } config_;
  AmplificationLimit amplification_;
  NetworkStatus status_;
  std::jthread thread_;
};

}  // namespace limber::osc
