// Token buckets, a table of at most 256 sources (searched linearly), and the hash of a line without its numbers.
#include "base/log/log_throttle.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>

#include "base/hash.h"

namespace limber {

bool TokenBucket::try_consume(std::int64_t now) {
  if (!started_ || tokens_ == burst_) filled_ = now;
  started_ = true;
  const std::int64_t added = std::max<std::int64_t>(0, (now - filled_) / interval_);
  tokens_ = std::min(burst_, tokens_ + added);
  filled_ += added * interval_;
  if (tokens_ == 0) return false;
  tokens_--;
  return true;
}

std::optional<std::uint64_t> LogThrottle::admit(std::uint64_t source, std::int64_t now, bool count_in_total) {
  const std::span<Source> known(sources_.data(), count_);
  auto found = std::ranges::find(known, source, &Source::hash);
  if (found == known.end()) {
    Source& slot = count_ < kSources ? sources_[count_++] : *std::ranges::min_element(known, {}, &Source::last);
    slot = {source, 0, now, TokenBucket(kBurst, kInterval)};
    found = known.begin() + (&slot - sources_.data());
  }
  Source& entry = *found;
  entry.last = now;
  if (!entry.bucket.try_consume(now) || (count_in_total && !total_.try_consume(now))) {
    entry.suppressed++;
    suppressed_++;
    return std::nullopt;
  }
  return std::exchange(entry.suppressed, 0);
}

std::uint64_t log_source(std::string_view text) {
  const auto is = [&](std::size_t at, int (*kind)(int)) {
    return at < text.size() && kind(static_cast<unsigned char>(text[at])) != 0;
  };
  std::uint64_t hash = hash_bytes("");
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); i++) {
    const bool after_word = i > 0 && is(i - 1, std::isalnum);
    if (text[i] == '\'') quoted = quoted ? is(i + 1, std::isalnum) : !after_word;
    constexpr std::string_view kBefore = " ([{-+=.,\n\t";
    const bool measured = !quoted && is(i, std::isdigit) && (i == 0 || kBefore.find(text[i - 1]) != kBefore.npos);
    if (measured) {
      while (is(i + 1, std::isalnum) || (i + 1 < text.size() && text[i + 1] == '.' && is(i + 2, std::isdigit))) i++;
    }
    hash = hash_bytes(measured ? "#" : text.substr(i, 1), hash);
  }
  return hash;
}

}  // namespace limber
