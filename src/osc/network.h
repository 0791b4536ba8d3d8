// The network thread: polls the listening sockets and the engine's bell, answers, sends and streams.
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
#include "engine/link.h"
#include "osc/clock.h"
#include "osc/names.h"
#include "osc/options.h"
#include "osc/receiver.h"
#include "osc/refusals.h"
#include "osc/sender.h"
#include "osc/source_limit.h"
#include "osc/streams.h"
#include "osc/subscribers.h"

namespace limber {

/// OSC in and out of one engine. Make it before the engine starts (it sets `link.wake_network`, which stays usable when
/// the Network is gone); start it when the scene has run once, so that the scene's plan counts. `link` outlives it.
class Network {
 public:
  Network(EngineLink& link, OscOptions options, const LiveOffsets& offsets, NetClock clock = {},
          LookUp look_up = resolve);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Opens the ports and starts the thread. The error names what can't be had and the option that changes it; with
  /// `--osc-optional` it is a warning, and what can be had is open. [main]
  Result<void> start();
  /// Ends the thread at once and closes everything. Idempotent. [main]
  void stop();

  /// A packet that came by another way than UDP: looked at and carried out like one that did. Answers go by
  /// EngineLink::push_out. False: too many wait; its urgent requests are with the engine all the same. [any]
  bool take(const Origin& origin, std::string packet);

  /// "OSC in 127.0.0.1:9003", "OSC out 127.0.0.1:9005 (pos+rot+relrot at 60 Hz)": what is open now. [any]
  std::vector<std::string> lines() const;
  /// The listening ends as bound, with the port that the system chose where 0 was asked for. [any]
  std::vector<Endpoint> bound() const;

 private:
  void run();
  void wait_for_something();
  std::vector<std::string> apply(const OscPlan& plan);
  std::vector<std::string> aim(std::chrono::milliseconds wait = {});
  void renew_lines();
  void apply_new_plan();
  void listen_again();
  void look_up_again();
  void aim_at_subscribers();
  void aim_streams();
  void pong(const Origin& to);
  void take_packets();
  void send_outbox(std::size_t most);
  void set_own();
  void note_received(const Endpoint& from, std::size_t bytes);
  void take_token(const Message& message, const Origin& origin);
  Result<void> subscribe(const Message& message, const Origin& origin);
  SendGate serves();
  bool may_send(const Endpoint& to, std::size_t bytes);
  void challenge(const Endpoint& end, bool wants_more);
  void tell_health();

  struct Packet {
    Origin origin;
    std::string bytes;
    Receiver::Scanned scanned;
    friend std::size_t weight_of(const Packet& p) { return sizeof p + p.bytes.capacity(); }
  };

  EngineLink& link_;
  const OscOptions options_;
  const NetClock clock_;
  std::shared_ptr<system::Wake> wake_;
  Receiver receiver_;
  Sender sender_;
  HostNames names_;
  Refusals refusals_;
  Streams streams_;
  Subscribers subscribers_;
  Inbox<Packet> packets_{8192, std::size_t{16} << 20};
  std::vector<Packet> taken_;
  std::shared_ptr<const OscPlan> seen_plan_;
  OscPlan plan_;
  std::vector<Target> targets_;
  std::vector<std::string> said_;  // faults of this plan's targets
  std::vector<Outgoing> outgoing_;
  std::size_t next_outgoing_ = 0;  // the first that is not sent
  SourceLimit sources_;
  Seldom limited_;
  std::vector<int> descriptors_;
  std::optional<std::int64_t> listen_at_;  // when ports that could not be had are tried again, ns
  std::optional<std::int64_t> names_at_;   // when names that were not found are, ns
  std::thread thread_;
  std::atomic<bool> stop_{false};

  mutable std::mutex status_mutex_;  // guards what other threads ask for
  std::vector<std::string> lines_;
  std::vector<Endpoint> bound_;
};

}  // namespace limber
