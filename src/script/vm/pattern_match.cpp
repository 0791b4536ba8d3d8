// The pattern matcher: recursive, as described in Lua's manual; the depth is limited as in LuaJIT.
#include "script/vm/pattern_match.h"

#include <algorithm>
#include <cstring>

namespace limber::script {

namespace {

constexpr int kMaxMatchDepth = 200;
// step budget of one search: about 20 ms, and more for long texts, which must be scanned at least once
constexpr std::int64_t kSteps = 4'000'000;
constexpr std::int64_t kStepsPerByte = 8;
constexpr std::int64_t kPollInterval = 1 << 16;

constexpr bool is_between(unsigned char c, int low, int high) { return c >= low && c <= high; }
constexpr bool is_ascii_letter(unsigned char c) { return is_between(c, 'a', 'z') || is_between(c, 'A', 'Z'); }
constexpr bool is_ascii_digit(unsigned char c) { return is_between(c, '0', '9'); }
constexpr bool is_ascii_space(unsigned char c) { return c == 32 || is_between(c, 9, 13); }
constexpr bool is_ascii_control(unsigned char c) { return c < 32 || c == 127; }
constexpr bool is_hex_digit(unsigned char c) {
  return is_ascii_digit(c) || is_between(c, 'a', 'f') || is_between(c, 'A', 'F');
}

// %a %c %d … in the C locale: only ASCII letters count as letters
bool in_class(unsigned char c, unsigned char wanted) {
  const bool graph = is_between(c, 33, 126);
  const bool letter_or_digit = is_ascii_letter(c) || is_ascii_digit(c);
  bool in = false;
  switch (wanted | 0x20) {
    case 'a':
      in = is_ascii_letter(c);
      break;
    case 'c':
      in = is_ascii_control(c);
      break;
    case 'd':
      in = is_ascii_digit(c);
      break;
    case 'g':
      in = graph;
      break;
    case 'l':
      in = is_between(c, 'a', 'z');
      break;
    case 'p':
      in = graph && !letter_or_digit;
      break;
    case 's':
      in = is_ascii_space(c);
      break;
    case 'u':
      in = is_between(c, 'A', 'Z');
      break;
    case 'w':
      in = letter_or_digit;
      break;
    case 'x':
      in = is_hex_digit(c);
      break;
    case 'z':
      in = c == 0;
      break;
    default:
      return wanted == c;
  }
  // an uppercase class is the complement
  return in == (wanted >= 'a');
}

unsigned char byte(const char* p) { return static_cast<unsigned char>(*p); }

}  // namespace

const char* PatternMatcher::set_fault(const char* fault) {
  if (fault_ == nullptr) fault_ = fault;
  return nullptr;
}

// returns false when the search must end
bool PatternMatcher::count_steps(std::ptrdiff_t steps) {
  steps_left_ -= steps;
  if (steps_left_ > next_poll_) return true;
  next_poll_ = steps_left_ - kPollInterval;
  if (steps_left_ <= 0 || stop_()) exhausted_ = true;
  return !exhausted_;
}

SearchResult PatternMatcher::find(std::string_view text, std::string_view pattern, std::size_t from, bool anchors) {
  begin_ = text.data();
  end_ = begin_ + text.size();
  // as in Lua, a zero byte ends a pattern
  const char* p = pattern.data();
  pattern_end_ = p + std::min(pattern.find('\0'), pattern.size());
  fault_ = nullptr;
  exhausted_ = false;
  steps_left_ = kSteps + kStepsPerByte * static_cast<std::int64_t>(text.size());
  next_poll_ = steps_left_ - kPollInterval;
  const bool anchored = anchors && p != pattern_end_ && *p == '^';
  if (anchored) p++;
  for (const char* s = begin_ + from; s <= end_; s++) {
    match_.count = 0;
    depth_ = 0;
    if (!count_steps(1)) return SearchResult::too_long;
    const char* const e = match(s, p);
    if (fault_ != nullptr) return SearchResult::bad_pattern;
    if (exhausted_) return SearchResult::too_long;
    if (e != nullptr) {
      match_.start = static_cast<std::int32_t>(s - begin_);
      match_.end = static_cast<std::int32_t>(e - begin_);
      return SearchResult::found;
    }
    if (anchored) break;
  }
  return SearchResult::not_found;
}

std::size_t PatternMatcher::find_plain(std::string_view text, std::string_view wanted, std::size_t from) {
  // in blocks, to poll `stop` between them
  constexpr std::size_t kBlockSize = std::size_t{1} << 16u;
  const std::size_t block_size = std::max(kBlockSize, 4 * wanted.size());
  while (from + wanted.size() <= text.size()) {
    const std::size_t size = std::min(block_size + wanted.size(), text.size() - from);
    const void* const found = memmem(text.data() + from, size, wanted.data(), wanted.size());
    if (found != nullptr) return static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
    from += size < block_size + wanted.size() ? size : block_size;
    if (stop_()) break;
  }
  return std::string_view::npos;
}

const char* PatternMatcher::match(const char* s, const char* p) {
  if (++depth_ > kMaxMatchDepth) return set_fault("pattern too complex");
  const char* const e = match_here(s, p);
  depth_--;
  return e;
}

// Consumes %bxy, %f[set] or %1 at p; s becomes null if it does not match. False: the escape is part of a single item.
bool PatternMatcher::consume_escape(const char*& s, const char*& p) {
  const char kind = p + 1 == pattern_end_ ? '\0' : p[1];
  if (kind == 'b') {
    s = balance(s, p + 2);
    p += 4;
  } else if (kind == 'f') {
    p += 2;
    if (!frontier(s, p)) s = nullptr;
  } else if (kind >= '0' && kind <= '9') {
    s = back_reference(s, kind);
    p += 2;
  } else {
    return false;
  }
  return true;
}

// Returns the end of the match of pattern p at s; null: no match, or ended().
const char* PatternMatcher::match_here(const char* s, const char* p) {
  while (p != pattern_end_) {
    if (ended()) return nullptr;
    switch (*p) {
      case '(':
        if (p + 1 != pattern_end_ && p[1] == ')') return start_capture(s, p + 2, Match::kPosition);
        return start_capture(s, p + 1, Match::kUnfinished);
      case ')':
        return end_capture(s, p + 1);
      case '$':
        if (p + 1 == pattern_end_) return s == end_ ? s : nullptr;
        break;
      case '%':
        if (consume_escape(s, p)) {
          if (s == nullptr) return nullptr;
          continue;
        }
        break;
      default:
        break;
    }
    bool advanced = false;
    const char* const e = match_item(s, p, advanced);
    if (!advanced) return e;
  }
  return s;
}

// matches one character or class with its suffix (* + - ?); `advanced`: s and p have
// advanced, so the caller continues with the next item
const char* PatternMatcher::match_item(const char*& s, const char*& p, bool& advanced) {
  const char* const ep = class_end(p);
  if (ep == nullptr) return nullptr;
  const bool fits = s < end_ && matches_single(s, p, ep);
  switch (ep == pattern_end_ ? '\0' : *ep) {
    case '?':
      if (fits) {
        if (const char* const e = match(s + 1, ep + 1)) return e;
      }
      p = ep + 1;
      advanced = true;
      return nullptr;
    case '*':
      return max_expand(s, p, ep);
    case '+':
      return fits ? max_expand(s + 1, p, ep) : nullptr;
    case '-':
      return min_expand(s, p, ep);
    default:
      if (!fits) return nullptr;
      s++;
      p = ep;
      advanced = true;
      return nullptr;
  }
}

const char* PatternMatcher::max_expand(const char* s, const char* p, const char* ep) {
  std::ptrdiff_t i = 0;
  while (s + i < end_ && matches_single(s + i, p, ep)) i++;
  for (; i >= 0 && !ended(); i--) {
    if (!count_steps(1)) return nullptr;
    if (const char* const e = match(s + i, ep + 1)) return e;
  }
  return nullptr;
}

const char* PatternMatcher::min_expand(const char* s, const char* p, const char* ep) {
  while (!ended()) {
    if (const char* const e = match(s, ep + 1)) return e;
    if (s >= end_ || !matches_single(s, p, ep)) return nullptr;
    s++;
  }
  return nullptr;
}

const char* PatternMatcher::start_capture(const char* s, const char* p, std::int32_t length) {
  if (match_.count >= Match::kMaxCaptures) return set_fault("too many captures");
  const auto at = static_cast<std::size_t>(match_.count++);
  match_.from[at] = static_cast<std::int32_t>(s - begin_);
  match_.length[at] = length;
  const char* const e = match(s, p);
  if (e == nullptr) match_.count--;
  return e;
}

const char* PatternMatcher::end_capture(const char* s, const char* p) {
  std::int32_t open = match_.count - 1;
  while (open >= 0 && match_.length[static_cast<std::size_t>(open)] != Match::kUnfinished) open--;
  if (open < 0) return set_fault("invalid pattern capture");
  const auto at = static_cast<std::size_t>(open);
  match_.length[at] = static_cast<std::int32_t>(s - begin_) - match_.from[at];
  const char* const e = match(s, p);
  if (e == nullptr) match_.length[at] = Match::kUnfinished;
  return e;
}

const char* PatternMatcher::back_reference(const char* s, char digit) {
  const int wanted = digit - '1';
  const auto at = static_cast<std::size_t>(wanted);
  if (wanted < 0 || wanted >= match_.count || match_.length[at] == Match::kUnfinished) {
    return set_fault("invalid capture index");
  }
  // a position capture has no text; its marker is not a length
  const auto length = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(match_.length[at]));
  if (static_cast<std::size_t>(end_ - s) < length) return nullptr;
  if (!count_steps(1 + static_cast<std::ptrdiff_t>(length) / 16)) return nullptr;
  return std::memcmp(begin_ + match_.from[at], s, length) == 0 ? s + length : nullptr;
}

const char* PatternMatcher::balance(const char* s, const char* p) {
  if (pattern_end_ - p < 2) return set_fault("unbalanced pattern");
  if (s >= end_ || *s != *p) return nullptr;
  int open = 1;
  for (s++; s < end_; s++) {
    if (!count_steps(1)) return nullptr;
    if (*s == p[1]) {
      if (--open == 0) return s + 1;
    } else if (*s == p[0]) {
      open++;
    }
  }
  return nullptr;
}

// p points to the set and is advanced past it
bool PatternMatcher::frontier(const char* s, const char*& p) {
  if (p == pattern_end_ || *p != '[') return set_fault("missing '[' after '%f' in pattern") != nullptr;
  const char* const ep = class_end(p);
  if (ep == nullptr) return false;
  const unsigned char before = s == begin_ ? 0 : byte(s - 1);
  const unsigned char here = s == end_ ? 0 : byte(s);
  if (!count_steps(ep - p)) return false;
  const bool at = !in_set(before, p, ep - 1) && in_set(here, p, ep - 1);
  p = ep;
  return at;
}

const char* PatternMatcher::class_end(const char* p) {
  const char first = *p++;
  if (first == '%') {
    if (p == pattern_end_) return set_fault("malformed pattern (ends with '%')");
    return p + 1;
  }
  if (first != '[') return p;
  if (p != pattern_end_ && *p == '^') p++;
  do {
    if (p == pattern_end_) return set_fault("malformed pattern (missing ']')");
    if (*p++ == '%' && p != pattern_end_) p++;
  } while (p == pattern_end_ || *p != ']');
  return p + 1;
}

bool PatternMatcher::matches_single(const char* s, const char* p, const char* ep) {
  if (!count_steps(ep - p)) return false;
  switch (*p) {
    case '.':
      return true;
    case '%':
      return in_class(byte(s), byte(p + 1));
    case '[':
      return in_set(byte(s), p, ep - 1);
    default:
      return *p == *s;
  }
}

// last: points to the ]
bool PatternMatcher::in_set(unsigned char c, const char* p, const char* last) {
  const bool wanted = p[1] != '^';
  if (!wanted) p++;
  while (++p < last) {
    if (*p == '%') {
      p++;
      if (in_class(c, byte(p))) return wanted;
    } else if (p[1] == '-' && p + 2 < last) {
      p += 2;
      if (byte(p - 2) <= c && c <= byte(p)) return wanted;
    } else if (byte(p) == c) {
      return wanted;
    }
  }
  return !wanted;
}

}  // namespace limber::script
