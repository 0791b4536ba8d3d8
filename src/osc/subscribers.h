// Subscribers: who asked by /subscribe to be told of a path's changes or to be streamed to, until they let it lapse;
// within a budget (osc/send_budget.h). Paths of one sender that overlap are merged: each value comes once, at the
// highest of their rates. Work is done in slices, so that input gets its turn.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/feed.h"
#include "engine/link.h"
#include "osc/clock.h"
#include "osc/send_budget.h"
#include "osc/sender.h"

namespace limber {

/// [net]
class Subscribers {
 public:
  static constexpr std::int64_t kLasts = 30'000'000'000;  ///< ns without renewal.
  static constexpr std::size_t kMost = 64;                ///< Senders.
  static constexpr std::size_t kMostEach = 256;           ///< Paths and streams of one.

  static constexpr int kSlice = 128;                  ///< Values that are sent in one call of work().
  static constexpr std::size_t kComparedForOne = 64;  ///< Values that are compared for the price of one that is sent.

  /// What is told goes by `send`; false: it may not be sent now.
  Subscribers(EngineLink& link, const NetClock& clock, std::function<bool(const Outgoing&)> send,
              SendLimits each = SendBudget::kEach, SendLimits all = SendBudget::kAll);

  static bool is_one(const Message& message) {
    return message.address == "/subscribe" || message.address == "/unsubscribe";
  }
  /// `/subscribe <stream|path> [rate]` (path or pattern; stream: pos, rot, relrot, relpos or its address; rate 0.1 to
  /// 1000 a second, 60 when left out), `/unsubscribe [stream|path]` (without: all). The error says what it takes.
  Result<void> take(const Message& message, const Origin& origin);
  /// Whether what this sender sets is to be noted.
  bool follows(const Origin& origin) const { return !list_.empty() && find(origin) != nullptr; }

  /// To be called at each bell and when wait() is over: lets lapse, hears images, tells what is due. At most a slice:
  /// wait() is 0 while there is more.
  void work();
  /// Whether a subscriber's budget has room for a datagram; counts it when so. Others have none.
  bool spend(const Endpoint& end, std::size_t bytes, std::size_t datagrams);
  std::optional<std::int64_t> wait() const;

  /// Whom streams go to beside the plan's targets; whether that has changed since the last call.
  bool take_news() { return std::exchange(news_, false); }
  std::vector<Target> targets() const;
  /// Everyone, for events.
  std::vector<Endpoint> ends() const;

 private:
  struct Subscription {
    std::string what;
    std::optional<StreamTarget> stream;  // else values
    std::int64_t period = 0;             // ns
    std::int64_t due = 0;
    std::int64_t lapses = 0;
    bool looked_at = false;  // it was said if there is no such path
  };
  struct Subscriber {
    Origin origin;
    std::vector<std::unique_ptr<Subscription>> subscriptions;
    SendBudget::Account* account = nullptr;
    Feed feed;
    std::uint64_t heard = 0;      // image
    bool said_truncated = false;  // that it asks for too many values
  };

  Subscriber* find(const Origin& origin) const;
  Result<void> subscribe(const Origin& origin, const std::string& what, double rate);
  void unsubscribe(const Origin& origin, const std::string* what);
  void lapse(std::int64_t now);
  void forget_idle();
  void begin_round();
  bool go_round(std::int64_t now);
  bool serve(Subscriber& who, std::int64_t now, int& left);
  void look_at(Subscriber& who);
  bool tell(Subscriber& who, const Subscription& s, int& left);
  void report(std::int64_t now);

  EngineLink& link_;
  const NetClock& clock_;
  std::function<bool(const Outgoing&)> send_;
  SendBudget budget_;
  std::vector<std::unique_ptr<Subscriber>> list_;
  std::shared_ptr<const Image> image_;  // that is heard, and told
  std::uint64_t heard_ = 0;
  bool in_round_ = false;    // some of list_ have not heard it
  bool tells_ = false;       // it is fresh: what is due is told
  std::size_t served_ = 0;   // how many have
  std::size_t first_ = 0;    // who is served first
  std::uint64_t asked_ = 0;  // 0: none is on its way
  bool news_ = false;
};

}  // namespace limber
