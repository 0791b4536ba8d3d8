// Match: Lua's patterns, with an end. Lua's own matcher runs in C, where no script can be stopped, and some patterns
// take it longer than anybody lives; this one gives the same answers, counts its steps and listens.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace limber {

struct Match {
  static constexpr int kMostCaptures = 32;
  static constexpr std::int32_t kPosition = -2;    ///< Length of a capture `()`: it tells where, not what.
  static constexpr std::int32_t kUnfinished = -1;  ///< Of one whose `)` is missing.

  std::int32_t start = 0;  ///< Of the whole match, from 0.
  std::int32_t end = 0;    ///< Behind its last byte.
  std::int32_t count = 0;  ///< Captures.
  std::array<std::int32_t, kMostCaptures> from{};
  std::array<std::int32_t, kMostCaptures> length{};
};

enum class Found : std::uint8_t {
  yes,
  no,
  fault,    ///< The pattern is none: MatchSearch::fault() tells.
  too_long  ///< It took too many steps, or `stop` asked for an end.
};

class MatchSearch {
 public:
  /// `stop` is asked now and then whether to end early.
  explicit MatchSearch(std::function<bool()> stop) : stop_(std::move(stop)) {}

  /// The first match at or after `from`. `anchors`: whether a ^ at the start of the pattern ties it to `from`, as in
  /// find, match and gsub; gmatch knows none.
  Found find(std::string_view text, std::string_view pattern, std::size_t from, bool anchors, Match& out);
  /// The first place of `wanted` as it stands, or npos; in a time that grows with the text alone.
  std::size_t find_plain(std::string_view text, std::string_view wanted, std::size_t from);
  /// What is wrong with the pattern, in Lua's words.
  const char* fault() const { return fault_; }

 private:
  const char* match(const char* s, const char* p);
  const char* match_here(const char* s, const char* p);
  const char* item(const char*& s, const char*& p, bool& on);
  const char* max_expand(const char* s, const char* p, const char* ep);
  const char* min_expand(const char* s, const char* p, const char* ep);
  const char* start_capture(const char* s, const char* p, std::int32_t what);
  const char* end_capture(const char* s, const char* p);
  const char* back_reference(const char* s, char digit);
  const char* balance(const char* s, const char* p);
  bool frontier(const char* s, const char*& p);
  const char* class_end(const char* p);
  bool single(const char* s, const char* p, const char* ep);
  bool in_set(unsigned char c, const char* p, const char* last);
  const char* wrong(const char* fault);
  bool spend(std::ptrdiff_t steps);
  bool over() const { return fault_ != nullptr || spent_; }

  std::function<bool()> stop_;
  const char* begin_ = nullptr;  // of the text
  const char* end_ = nullptr;
  const char* pattern_end_ = nullptr;
  const char* fault_ = nullptr;
  std::int64_t left_ = 0;      // steps
  std::int64_t next_ask_ = 0;  // so many are left when `stop` is asked next
  int depth_ = 0;
  bool spent_ = false;
  Match* out_ = nullptr;
};

}  // namespace limber
