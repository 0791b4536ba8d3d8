// Name comparison, OSC pattern matching, edit distance, escaping, numbers.
#include "base/text.h"
#include "base/utf8.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limber {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

constexpr int kMaxSteps = 20000;
constexpr int kMaxDepth = 200;  // recursion depth of stars and braces, which bounds the stack

struct Matcher {
  int steps = 0;
  int depth = 0;

  bool out_of_steps() { return ++steps > kMaxSteps; }

  // True if c is in the character class at p[i]; moves i behind it. A class without ']' matches nothing.
  bool in_class(std::string_view p, std::size_t& i, char c) {
    const std::size_t end = p.find(']', i + 1);
    if (end == std::string_view::npos) return false;
    std::size_t k = i + 1;
    const bool negated = k < end && p[k] == '!';
    if (negated) k++;
    bool in = false;
    while (k < end && !out_of_steps()) {
      const bool range = k + 2 < end && p[k + 1] == '-';
      in = in || (range ? p[k] <= c && c <= p[k + 2] : p[k] == c);
      k += range ? 3 : 1;
    }
    i = end + 1;
    return in != negated;
  }

  bool match(std::string_view p, std::string_view s) {
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < p.size()) {
      if (out_of_steps()) return false;
      if (p[i] == '*') return star(p.substr(i), s.substr(k));
      if (p[i] == '{') return braces(p.substr(i + 1), s.substr(k));
      if (k >= s.size()) return false;
      if (p[i] == '[') {
        if (!in_class(p, i, s[k])) return false;
      } else {
        if (p[i] != '?' && p[i] != s[k]) return false;
        i++;
      }
      k++;
    }
    return k == s.size();
  }

  bool match_nested(std::string_view p, std::string_view s) {
    if (depth >= kMaxDepth) return false;
    depth++;
    const bool hit = match(p, s);
    depth--;
    return hit;
  }

  bool star(std::string_view p, std::string_view s) {
    const std::string_view rest = p.substr(std::min(p.find_first_not_of('*'), p.size()));
    if (rest.empty()) return true;
    for (std::size_t k = 0; k <= s.size() && !out_of_steps(); k++) {
      if (match_nested(rest, s.substr(k))) return true;
    }
    return false;
  }

  // p: the pattern after the opening brace
  bool braces(std::string_view p, std::string_view s) {
    const std::size_t end = p.find('}');
    if (end == std::string_view::npos) return false;
    for (std::size_t start = 0; start <= end && !out_of_steps();) {
      const std::size_t comma = std::min(p.find(',', start), end);
      const std::string_view choice = p.substr(start, comma - start);
      if (s.starts_with(choice) && match_nested(p.substr(end + 1), s.substr(choice.size()))) return true;
      start = comma + 1;
    }
    return false;
  }
};

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbors; ignores case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [&](std::size_t i, std::size_t k) { return lower(a[i]) == lower(b[k]); };
  std::vector<std::size_t> older(b.size() + 1);
  std::vector<std::size_t> old(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); i++) {
    older.swap(old);
    old.swap(row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); k++) {
      row[k] = std::min({old[k] + 1, row[k - 1] + 1, old[k - 1] + (same(i - 1, k - 1) ? 0 : 1)});
      const bool swapped = i > 1 && k > 1 && same(i - 1, k - 2) && same(i - 2, k - 1);
      if (swapped) row[k] = std::min(row[k], older[k - 2] + 1);
    }
  }
  return row[b.size()];
}

// Maximum number of character comparisons of nearest_name(), a few milliseconds, for any number of names.
constexpr std::size_t kMaxComparisons = 1'000'000;

constexpr std::string_view kForbidden = " #*,/?[]{}%";

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char l = lower(c);
  return l >= 'a' && l <= 'f' ? l - 'a' + 10 : -1;
}

}  // namespace

std::string normalized_name(std::string_view name) {
  std::string normalized;
  normalized.reserve(name.size());
  for (const char c : name) {
    if (c != '_') normalized.push_back(lower(c));
  }
  return normalized;
}

bool same_in_any_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char c, char d) { return lower(c) == lower(d); });
}

std::pair<std::string, std::string> split_fix(const std::string& error, std::string_view default_fix) {
  const std::size_t end = error.rfind(". ");
  if (end == std::string::npos) return {error, std::string(default_fix)};
  return {error.substr(0, end), error.substr(end + 2)};
}

bool same_name(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t k = 0;
  while (true) {
    while (i < a.size() && a[i] == '_') i++;
    while (k < b.size() && b[k] == '_') k++;
    if (i == a.size() || k == b.size()) return i == a.size() && k == b.size();
    if (lower(a[i++]) != lower(b[k++])) return false;
  }
}

bool same_address(std::string_view received, std::string_view address) {
  if (received.size() > 1 && received.back() == '/') received.remove_suffix(1);
  return same_name(received, address);
}

bool is_pattern(std::string_view name) { return name.find_first_of("?*[{") != std::string_view::npos; }

bool pattern_match(std::string_view pattern, std::string_view name, int* steps) {
  if (!is_pattern(pattern) || pattern == name) return pattern == name;
  Matcher matcher;
  const bool hit = matcher.match(pattern, name);
  if (steps != nullptr) *steps += matcher.steps;
  return hit;
}

std::string_view nearest_name(std::string_view written, std::span<const std::string_view> names) {
  if (written.size() > 256) return {};
  const std::size_t allowed = std::max<std::size_t>(1, written.size() / 3);
  std::string_view best;
  std::size_t best_distance = allowed + 1;
  std::size_t work = 0;
  for (const std::string_view name : names) {
    if (name.size() > written.size() + allowed || written.size() > name.size() + allowed) continue;
    work += written.size() * name.size();
    if (work > kMaxComparisons) break;
    const std::size_t distance = edit_distance(written, name);
    if (distance < best_distance) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

std::string name_hint(std::string_view written, std::span<const std::string_view> names) {
  if (names.empty()) return "; none exist";
  const std::string_view near = nearest_name(written, names);
  if (!near.empty()) return fmt::format("; did you mean '{}'?", near);
  const std::size_t shown = std::min<std::size_t>(names.size(), 8);
  return fmt::format("; there are: {}{}",
                     fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     shown < names.size() ? " …" : "");
}

std::string name_hint(std::string_view written, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return name_hint(written, std::span<const std::string_view>(views));
}

std::size_t utf8_length(std::string_view text) {
  // The valid ranges of the first two bytes (Unicode, table 3-7): no overlong forms, surrogates or values above 10FFFF.
  struct Form {
    unsigned char first, last;  // of the first byte
    std::size_t length;
    unsigned char second_first, second_last;
  };
  static constexpr Form kForms[] = {
      {0x00, 0x7f, 1, 0x00, 0x00}, {0xc2, 0xdf, 2, 0x80, 0xbf}, {0xe0, 0xe0, 3, 0xa0, 0xbf},
      {0xe1, 0xec, 3, 0x80, 0xbf}, {0xed, 0xed, 3, 0x80, 0x9f}, {0xee, 0xef, 3, 0x80, 0xbf},
      {0xf0, 0xf0, 4, 0x90, 0xbf}, {0xf1, 0xf3, 4, 0x80, 0xbf}, {0xf4, 0xf4, 4, 0x80, 0x8f}};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (const Form& form : kForms) {
    if (byte(0) < form.first || byte(0) > form.last) continue;
    if (form.length == 1) return 1;
    if (text.size() < form.length || byte(1) < form.second_first || byte(1) > form.second_last) return 0;
    for (std::size_t i = 2; i < form.length; i++) {
      if ((byte(i) & 0xc0) != 0x80) return 0;
    }
    return form.length;
  }
  return 0;
}

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t n = utf8_length(text.substr(i));
    const bool control = (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f ||
                         (n == 2 && byte == 0xc2 && static_cast<unsigned char>(text[i + 1]) < 0xa0);
    if (n == 0 || control) {
      shown += fmt::format("\\x{:02x}", byte);
      i++;
    } else {
      shown.append(text.substr(i, n));
      i += n;
    }
  }
  return shown;
}

std::string shortened(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return std::string(text);
  constexpr std::string_view kCut = " … ";
  const std::size_t available = max_bytes - std::min(max_bytes, kCut.size());
  std::size_t tail = text.size() - (available - available / 2);
  while (tail < text.size() && continues_utf8(text[tail])) tail++;
  return fmt::format("{}{}{}", utf8_prefix(text, available / 2), kCut, text.substr(tail));
}

std::optional<double> parse_number(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::string number_text(double value) { return fmt::format("{}", value); }

std::string escape_name(std::string_view name) {
  std::string part;
  for (const char c : name) {
    if (kForbidden.find(c) != std::string_view::npos) {
      part += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    } else {
      part.push_back(c);
    }
  }
  return part;
}

std::string unescape_name(std::string_view part) {
  std::string name;
  for (std::size_t i = 0; i < part.size(); i++) {
    const int high = part[i] == '%' && i + 2 < part.size() ? hex_digit(part[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(part[i + 2]) : -1;
    if (low >= 0) {
      name.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      name.push_back(part[i]);
    }
  }
  return name;
}

std::optional<std::string> name_error(std::string_view name) {
  if (name.empty()) return "a name must not be empty";
  if (name.size() > 128) return fmt::format("a name may have at most 128 bytes, not {}", name.size());
  if (printable(name) != name || name.find_first_of("\n\t") != std::string_view::npos) {
    return fmt::format("the name '{}' contains unprintable characters", printable(name));
  }
  return {};
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= text.size(); i++) {
    if (i == text.size() || text[i] == separator) {
      pieces.push_back(text.substr(start, i - start));
      start = i + 1;
    }
  }
  return pieces;
}

}  // namespace limber
