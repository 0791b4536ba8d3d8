// Subscribers: who asked by /subscribe to be told of a path's changes or to be streamed to, until they let it lapse.
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
#include "osc/sender.h"

namespace limber {

/// [net]
class Subscribers {
 public:
  static constexpr std::int64_t kLasts = 30'000'000'000;  ///< ns without renewal.
  static constexpr std::size_t kMost = 64;                ///< Senders.
  static constexpr std::size_t kMostEach = 256;           ///< Paths and streams of one.

  /// What is told goes by `send`.
  Subscribers(EngineLink& link, const NetClock& clock, std::function<void(const Outgoing&)> send);

  static bool is_one(const Message& message) {
    return message.address == "/subscribe" || message.address == "/unsubscribe";
  }
  /// `/subscribe <stream|path> [rate]` (path or pattern; stream: pos, rot, relrot, relpos or its address; rate 0.1 to
  /// 1000 a second, 60 when left out), `/unsubscribe [stream|path]` (without: all). The error says what it takes.
  Result<void> take(const Message& message, const Origin& origin);
  /// Whether what this sender sets is to be noted.
  bool follows(const Origin& origin) const { return !list_.empty() && find(origin) != nullptr; }

  /// To be called at each bell and when wait() is over: lets lapse, hears images, tells what is due.
  void work();
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
    Feed feed;
    bool looked_at = false;  // it was said if there is no such path
  };
  struct Subscriber {
    Origin origin;
    std::vector<std::unique_ptr<Subscription>> subscriptions;
  };

  Subscriber* find(const Origin& origin) const;
  Result<void> subscribe(const Origin& origin, const std::string& what, double rate);
  void unsubscribe(const Origin& origin, const std::string* what);
  void lapse(std::int64_t now);
  void hear(const std::shared_ptr<const Image>& image);
  void look_at(const Subscriber& who, Subscription& s, const Image& image);
  void tell(const Subscriber& who, Subscription& s);

  EngineLink& link_;
  const NetClock& clock_;
  std::function<void(const Outgoing&)> send_;
  std::vector<std::unique_ptr<Subscriber>> list_;
  std::uint64_t heard_ = 0;  // image
  std::uint64_t asked_ = 0;  // 0: none is on its way
  bool news_ = false;
};

}  // namespace limber
