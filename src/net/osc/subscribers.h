// Subscribers: peers that asked with /subscribe for a path's changes or a stream. A subscription expires unless it is
// renewed, and its traffic is limited by a budget (net/osc/send_budget.h). If several paths of one subscriber match the
// same value, the value is sent once, at the highest of their rates. Work is done in slices, so that input is not
// delayed.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/engine_link.h"
#include "engine/output/feed.h"
#include "net/osc/clock.h"
#include "net/osc/send_budget.h"
#include "net/osc/sender.h"

namespace limber::osc {

/// The subscriptions of all peers. [net]
class Subscribers {
 public:
  static constexpr std::int64_t kLifetime = 30'000'000'000;  ///< ns without renewal until a subscription expires.
  static constexpr std::size_t kMaxSubscribers = 64;         ///< Maximum number of subscribed peers.
  static constexpr std::size_t kMaxSubscriptions = 256;      ///< Maximum number of paths and streams per peer.

  static constexpr int kValuesPerSlice = 128;  ///< Values sent per call of work().
  /// In the budget of a slice, one sent value counts as much as this number of compared values.
  static constexpr std::size_t kComparisonsPerValue = 64;

  /// `send` sends values, events and errors; it returns false if a value may not be sent now.
  Subscribers(engine::EngineLink& link, const NetClock& clock, std::function<bool(const engine::Outgoing&)> send,
              SendLimits per_subscriber = SendBudget::kPerSubscriber, SendLimits total = SendBudget::kTotal);

  static bool handles(const Message& message) {
    return message.address == "/subscribe" || message.address == "/unsubscribe";
  }
  /// Handles `/subscribe <stream|path> [rate]` (a path, a pattern or a stream: pos, rot, relrot, relpos or its address;
  /// rate 0.1 to 1000 per second, default 60) and `/unsubscribe [stream|path]` (default: all). The error describes the
  /// expected arguments.
  Result<void> handle(const Message& message, const CommandOrigin& origin);
  /// True if `origin` has subscriptions, so that the values it sets must be tracked.
  bool is_subscriber(const CommandOrigin& origin) const { return !subscribers_.empty() && find(origin) != nullptr; }

  /// Expires subscriptions, reads new value snapshots and sends the values that are due. Call it on each wake-up and
  /// when timeout() has elapsed. Does at most one slice of work; timeout() is 0 while there is more.
  void work();
  /// Charges a datagram to a subscriber's budget. Returns false if the budget is exhausted or `peer` has no
  /// subscription.
  bool try_consume(const Endpoint& peer, std::size_t bytes, std::size_t datagrams);
  std::optional<std::int64_t> timeout() const;

  /// True if targets() or endpoints() changed since the last call.
  bool consume_changed() { return std::exchange(changed_, false); }
  std::vector<ResolvedTarget> targets() const;
  /// All subscribers, as receivers of events.
  std::vector<Endpoint> endpoints() const;

 private:
  struct Subscription {
    std::string path;
    std::optional<StreamTarget> stream;  // empty: a subscription to values
    std::int64_t period = 0;             // ns
    std::int64_t next_due = 0;
    std::int64_t expires_at = 0;
    bool checked = false;  // the path was checked, and reported if nothing matches it
  };
  struct Subscriber {
    CommandOrigin origin;
    std::vector<std::unique_ptr<Subscription>> subscriptions;
    SendBudget::Account* account = nullptr;
    engine::Feed feed;
    std::uint64_t snapshot_number = 0;  // number of the last snapshot
    bool reported_truncated = false;    // an error about too many matching values was sent
  };

  Subscriber* find(const CommandOrigin& origin) const;
  Result<void> handle_unsubscribe(const std::vector<Arg>& args, const CommandOrigin& origin);
  Result<void> subscribe(const CommandOrigin& origin, const std::string& path, double rate);
  void unsubscribe(const CommandOrigin& origin, const std::string* path);
  void expire(std::int64_t now);
  void remove_idle();
  void begin_round();
  bool continue_round(std::int64_t now);
  bool serve(Subscriber& subscriber, std::int64_t now, int& left);
  void check_paths(Subscriber& subscriber);
  bool send_values(Subscriber& subscriber, const Subscription& s, int& left);
  void report_throttling(std::int64_t now);

  engine::EngineLink& link_;
  const NetClock& clock_;
  std::function<bool(const engine::Outgoing&)> send_;
  SendBudget budget_;
  std::vector<std::unique_ptr<Subscriber>> subscribers_;
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;  // the snapshot being compared and sent
  std::uint64_t snapshot_number_ = 0;
  bool in_round_ = false;               // some subscribers have not been served with snapshot_
  bool sends_values_ = false;           // this round sends values; false: it only updates the feeds
  std::size_t served_count_ = 0;        // number of subscribers served in this round
  std::size_t round_offset_ = 0;        // offset of the round's first subscriber; it rotates for fairness
  std::uint64_t snapshot_request_ = 0;  // number of the snapshot request; 0: none is pending
  bool changed_ = false;
};

}  // namespace limber::osc
