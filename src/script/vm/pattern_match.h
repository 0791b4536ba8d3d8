// PatternMatcher: Lua patterns with a step limit. Lua's own matcher is C code that can't be interrupted, and some
// patterns take it exponential time; this one gives the same results, counts its steps and can be stopped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace limber::script {

struct Match {
  static constexpr int kMaxCaptures = 32;
  static constexpr std::int32_t kPosition = -2;    ///< Length of a position capture `()`.
  static constexpr std::int32_t kUnfinished = -1;  ///< Length of a capture without its `)`.

  std::int32_t start = 0;  ///< Offset of the match, from 0.
  std::int32_t end = 0;    ///< Offset after its last byte.
  std::int32_t count = 0;  ///< Number of captures.
  std::array<std::int32_t, kMaxCaptures> from{};
  std::array<std::int32_t, kMaxCaptures> length{};
};

enum class SearchResult : std::uint8_t {
  found,
  not_found,
  bad_pattern,  ///< Malformed pattern; see PatternMatcher::fault().
  too_long      ///< Too many steps, or stopped by `stop`.
};

class PatternMatcher {
 public:
  /// `stop` is polled regularly; true ends the search early.
  explicit PatternMatcher(std::function<bool()> stop) : stop_(std::move(stop)) {}

  /// Finds the first match at or after `from`. `anchors`: a ^ at the start of the pattern anchors it at `from`, as in
  /// find, match and gsub, but not in gmatch.
  SearchResult find(std::string_view text, std::string_view pattern, std::size_t from, bool anchors);
  /// The last match that was found, at a constant address.
  const Match& last_match() const { return match_; }
  /// Returns the first offset of `wanted` as plain text, or npos. Linear in the length of the text.
  std::size_t find_plain(std::string_view text, std::string_view wanted, std::size_t from);
  /// The fault of the pattern, with Lua's wording.
  const char* fault() const { return fault_; }

 private:
  const char* match(const char* s, const char* p);
  const char* match_here(const char* s, const char* p);
  const char* match_item(const char*& s, const char*& p, bool& advanced);
  const char* max_expand(const char* s, const char* p, const char* ep);
  const char* min_expand(const char* s, const char* p, const char* ep);
  const char* start_capture(const char* s, const char* p, std::int32_t length);
  const char* end_capture(const char* s, const char* p);
  const char* back_reference(const char* s, char digit);
  const char* balance(const char* s, const char* p);
  bool frontier(const char* s, const char*& p);
  bool consume_escape(const char*& s, const char*& p);
  const char* class_end(const char* p);
  bool matches_single(const char* s, const char* p, const char* ep);
  bool in_set(unsigned char c, const char* p, const char* last);
  const char* set_fault(const char* fault);
  bool count_steps(std::ptrdiff_t steps);
  bool ended() const { return fault_ != nullptr || exhausted_; }

  std::function<bool()> stop_;
  const char* begin_ = nullptr;  // of the text
  const char* end_ = nullptr;
  const char* pattern_end_ = nullptr;
  const char* fault_ = nullptr;
  std::int64_t steps_left_ = 0;
  std::int64_t next_poll_ = 0;  // value of `steps_left_` at which `stop` is polled next
  int depth_ = 0;
  bool exhausted_ = false;
  Match match_;
};

}  // namespace limber::script
