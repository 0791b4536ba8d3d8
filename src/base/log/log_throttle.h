// LogThrottle: rate limits of the log. Each source may write ten lines at once, then one a minute with the number of
// suppressed lines; another limit applies to all sources together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace limber {

/// A token bucket: `burst` tokens at once, then one per `interval` (ns).
class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(int burst, std::int64_t interval) : burst_(burst), interval_(interval), tokens_(burst) {}
  /// Takes a token. False if there is none: the limit is reached. `now` in ns.
  bool try_consume(std::int64_t now);

 private:
  std::int64_t burst_ = 0;
  std::int64_t interval_ = 1;
  std::int64_t tokens_ = 0;
  std::int64_t filled_ = 0;  // the time of the last token
  bool started_ = false;
};

/// Decides which lines are written. Not thread-safe.
class LogThrottle {
 public:
  static constexpr int kBurst = 10;
  static constexpr std::int64_t kInterval = 60'000'000'000;  ///< ns
  static constexpr int kTotalBurst = 2000;
  static constexpr std::int64_t kTotalInterval = 500'000'000;
  static constexpr std::size_t kSources = 256;  ///< If there are more, the least recent one is replaced.

  /// If the line may be written, returns how many lines of its source were suppressed since the last written one;
  /// returns nullopt if this line is suppressed. `source`: a hash (log_source()). `count_in_total`: apply the limit of
  /// all sources too.
  std::optional<std::uint64_t> admit(std::uint64_t source, std::int64_t now, bool count_in_total = true);
  /// Resets the limits of all sources. The limit for all sources together remains.
  void forget_sources() { count_ = 0; }
  /// Number of suppressed lines so far.
  std::uint64_t suppressed() const { return suppressed_; }

 private:
  struct Source {
    std::uint64_t hash = 0;
    std::uint64_t suppressed = 0;
    std::int64_t last = 0;
    TokenBucket bucket;
  };
  std::array<Source, kSources> sources_{};
  std::size_t count_ = 0;
  TokenBucket total_{kTotalBurst, kTotalInterval};
  std::uint64_t suppressed_ = 0;
};

/// Returns the source of a line without an explicit source: a hash of its text without measured values, which are the
/// numbers outside quotes that follow a space, bracket, sign or point. Names, places and ports are part of the hash.
std::uint64_t log_source(std::string_view text);

}  // namespace limber
