// Seldom: a warning of one kind is said once a minute at most, with how often it came in between.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace limber {

/// One kind of warning. [one thread]
class Seldom {
 public:
  static constexpr std::int64_t kPause = 60'000'000'000;  ///< ns

  /// What to add to the text, "" or " (and 17 more since the last warning)"; nothing: be silent. `now` in ns.
  std::optional<std::string> ask(std::int64_t now) {
    if (said_ && now - last_ < kPause) {
      silent_++;
      return std::nullopt;
    }
    std::string more = silent_ > 0 ? fmt::format(" (and {} more since the last warning)", silent_) : "";
    said_ = true;
    last_ = now;
    silent_ = 0;
    return more;
  }

 private:
  bool said_ = false;
  std::int64_t last_ = 0;
  std::uint64_t silent_ = 0;
};

}  // namespace limber
