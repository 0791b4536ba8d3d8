// WarningThrottle: logs one kind of warning at most once a minute, with the number of suppressed ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace limber::osc {

/// Throttles one kind of warning. [one thread]
class WarningThrottle {
 public:
  static constexpr std::int64_t kInterval = 60'000'000'000;  ///< ns

  /// Returns nullopt if the warning must be suppressed, otherwise the suffix to append: "" or " (and 17 more since the
  /// last warning)". `now` in ns.
  std::optional<std::string> admit(std::int64_t now) {
    if (logged_ && now - last_ < kInterval) {
      suppressed_++;
      return std::nullopt;
    }
    std::string suffix = suppressed_ > 0 ? fmt::format(" (and {} more since the last warning)", suppressed_) : "";
    logged_ = true;
    last_ = now;
    suppressed_ = 0;
    return suffix;
  }

 private:
  bool logged_ = false;
  std::int64_t last_ = 0;
  std::uint64_t suppressed_ = 0;
};

}  // namespace limber::osc
