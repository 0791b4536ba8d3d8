// The network thread: polls the listening sockets and the engine's wake-up descriptor, handles incoming packets, and
// sends answers, events and streams.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
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
#include "net/osc/unreachable_targets.h"

namespace limber {

/// OSC input and output of one engine. Create it before the engine starts: the constructor sets `link.wake_network`,
/// which stays callable after the Network is destroyed. Call start() after the scene has run once, so that the scene's
/// OSC plan is applied. `link` must outlive the Network.
class Network {
 public:
  Network(EngineLink& link, OscOptions options, const TransientOffsets& offsets, NetClock clock = {},
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
  std::vector<std::string> status_lines() const;
  /// The bound listening endpoints, with the port that the system chose for port 0. [any]
  std::vector<Endpoint> bound() const;

 private:
  void run();
  void wait_for_events();
  std::vector<std::string> apply(const OscConfig& plan);
  std::vector<std::string> resolve_targets(std::chrono::milliseconds wait = {});
  void update_status_lines();
  void apply_new_config();
  void retry_listen();
  void retry_look_ups();
  void update_subscribers();
  void update_streams();
  void pong(const CommandOrigin& to);
  void process_packets();
  void send_outbox(std::size_t max_messages);
  void update_own_endpoints();
  void record_received(const Endpoint& from, std::size_t bytes);
  void handle_token(const Message& message, const CommandOrigin& origin);
  Result<void> subscribe(const Message& message, const CommandOrigin& origin);
  SendGate subscription_gate();
  bool may_send(const Endpoint& to, std::size_t bytes);
  void challenge(const Endpoint& end, bool wants_more);
  void publish_health();

  struct Packet {
    CommandOrigin origin;
    std::string bytes;
    Receiver::ScanResult scanned;
    friend std::size_t weight_of(const Packet& p) { return sizeof p + p.bytes.capacity(); }
  };

  EngineLink& link_;
  const OscOptions options_;
  const NetClock clock_;
  std::shared_ptr<system::Wake> wake_;
  Receiver receiver_;
  Sender sender_;
  HostResolver host_names_;
  UnreachableTargets unreachable_;
  Streams streams_;
  Subscribers subscribers_;
  BoundedQueue<Packet> packets_{8192, std::size_t{16} << 20};
  std::vector<Packet> packet_batch_;
  std::shared_ptr<const OscConfig> last_config_;
  OscConfig config_;
  std::vector<ResolvedTarget> targets_;
  std::vector<std::string> reported_faults_;  // errors already logged for this plan's targets
  std::vector<Outgoing> outgoing_;
  std::size_t next_outgoing_ = 0;  // index of the first unsent message
  AmplificationLimit amplification_;
  WarningThrottle limited_log_;
  std::vector<int> descriptors_;
  std::optional<std::int64_t> retry_listen_at_;    // ns; next attempt to open the ports that could not be opened
  std::optional<std::int64_t> retry_look_ups_at_;  // ns; next look-up of the host names that were not found
  std::thread thread_;
  std::atomic<bool> stop_{false};

  mutable std::mutex status_mutex_;  // guards the members below, which other threads read
  std::vector<std::string> status_lines_;
  std::vector<Endpoint> bound_;
};

}  // namespace limber
