// LogThrottle: how many lines of one source the log writes: ten at once, then one a minute with the number of those
// that were left out in between, and a limit for all sources together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace limber {

/// A token bucket: `burst` at once, then one each `interval`. Times in ns.
class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(int burst, std::int64_t interval) : burst_(burst), interval_(interval), tokens_(burst) {}
  /// Whether one more is within the limit; counts it when so.
  bool spend(std::int64_t now);

 private:
  std::int64_t burst_ = 0;
  std::int64_t interval_ = 1;
  std::int64_t tokens_ = 0;
  std::int64_t filled_ = 0;  // the time of the last token
  bool begun_ = false;
};

/// [no synchronization of its own]
class LogThrottle {
 public:
  static constexpr int kBurst = 10;
  static constexpr std::int64_t kInterval = 60'000'000'000;  ///< ns
  static constexpr int kBurstOfAll = 2000;
  static constexpr std::int64_t kIntervalOfAll = 500'000'000;
  static constexpr std::size_t kSources = 256;  ///< The one that was silent for longest is forgotten.

  /// The number of lines of this source that were left out since the last one that was written; nothing: this one is
  /// left out. `source` is a hash (log_source); `together`: the limit for all sources holds too.
  std::optional<std::uint64_t> ask(std::uint64_t source, std::int64_t now, bool together = true);
  /// Each source begins with its burst again. The limit for all together remains.
  void forget_sources() { count_ = 0; }
  /// Lines left out so far.
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Source {
    std::uint64_t hash = 0;
    std::uint64_t silent = 0;
    std::int64_t last = 0;
    TokenBucket bucket;
  };
  std::array<Source, kSources> sources_{};
  std::size_t count_ = 0;
  TokenBucket all_{kBurstOfAll, kIntervalOfAll};
  std::uint64_t left_out_ = 0;
};

/// The source of a line that names none: its text without measured values, that is, without the numbers outside quotes
/// that follow a space, a bracket, a sign or a point. Names, places and ports remain.
std::uint64_t log_source(std::string_view text);

}  // namespace limber
