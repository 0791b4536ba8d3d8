// Checks on tokens of Lua, skipping strings and comments.
#include "script/vm/text_check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace limber::script {

namespace {

// for each new jump LuaJIT's compiler scans all open ones, and a hook can't stop it
constexpr std::size_t kMaxJumps = 2000;

std::size_t jumps_in(std::string_view text) {
  std::size_t count = 0;
  for (const std::string_view word : {"break", "goto", "elseif"}) {
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + word.size())) count++;
  }
  return count;
}

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}

  /// Returns a word or a single character; for a string its quote; empty at the end.
  std::string_view next() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (text_.compare(at_, 2, "--") == 0) {
        at_ += 2;
        if (!skip_long()) at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v') {
        at_++;
      } else {
        return token();
      }
    }
    return {};
  }
  int line() const { return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + begin_, '\n')); }

 private:
  std::string_view token() {
    begin_ = static_cast<std::ptrdiff_t>(at_);
    const std::size_t from = at_;
    const char c = text_[from];
    if (is_word(c)) {
      while (at_ < text_.size() && is_word(text_[at_])) at_++;
      return text_.substr(from, at_ - from);
    }
    if (c == '[' && skip_long()) return text_.substr(from, 1);
    at_++;
    if (c == '"' || c == '\'') {
      while (at_ < text_.size() && text_[at_] != c && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
      at_ = std::min(at_ + 1, text_.size());
    }
    return text_.substr(from, 1);
  }

  // skips [[ … ]] or [==[ … ]==], if one begins here
  bool skip_long() {
    std::size_t open = at_;
    if (open >= text_.size() || text_[open] != '[') return false;
    open++;
    while (open < text_.size() && text_[open] == '=') open++;
    if (open >= text_.size() || text_[open] != '[') return false;
    const std::string close = "]" + std::string(open - at_ - 1, '=') + "]";
    const std::size_t end = text_.find(close, open + 1);
    at_ = end == text_.npos ? text_.size() : end + close.size();
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::ptrdiff_t begin_ = 0;
};

// `local a` followed by `for _ in (nil):f() do` makes LuaJIT 2.1.0-beta3 read an instruction that it has not written:
// it assumes that the first value of an iterator loop emits one, but nil only extends the previous one.
std::optional<int> find_nil_loop(std::string_view text) {
  if (text.find("nil") == text.npos) return std::nullopt;
  enum class Where : std::uint8_t { elsewhere, names, values };
  Where where = Where::elsewhere;
  Tokens tokens(text);
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
    if (token == "for") {
      where = Where::names;
    } else if (where == Where::names) {
      if (token == "in") {
        where = Where::values;
      } else if (token != "," && !is_word(token[0])) {
        where = Where::elsewhere;
      }
    } else if (where == Where::values && token != "(") {
      if (token == "nil") return tokens.line();
      where = Where::elsewhere;
    }
  }
  return std::nullopt;
}

// 1LL, 0x1ULL and 2i are numbers of LuaJIT's FFI, which scripts can't use otherwise
bool is_ffi_number(std::string_view token) {
  if (token[0] < '0' || token[0] > '9') return false;
  const auto ends_with = [&](std::string_view suffix) {
    return token.size() > suffix.size() &&
           std::equal(suffix.rbegin(), suffix.rend(), token.rbegin(), [](char a, char b) { return a == (b | 0x20); });
  };
  return ends_with("ll") || ends_with("i");
}

std::optional<int> find_ffi_number(std::string_view text) {
  Tokens tokens(text);
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
    if (is_ffi_number(token)) return tokens.line();
  }
  return std::nullopt;
}

}  // namespace

std::optional<TextFault> text_fault(std::string_view text) {
  if (jumps_in(text) > kMaxJumps)
    return TextFault{1, fmt::format("a text can have at most {} break, goto and elseif; split it", kMaxJumps)};
  if (const std::optional<int> line = find_nil_loop(text))
    return TextFault{*line, "the values of a loop can't begin with nil; put them into a local variable before it"};
  if (const std::optional<int> line = find_ffi_number(text))
    return TextFault{*line, "numbers can't end in LL, ULL or i; Lua numbers represent integers up to 2^53 exactly"};
  return std::nullopt;
}

}  // namespace limber::script
