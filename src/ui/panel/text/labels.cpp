// Searches the longest texts that fit.
#include "ui/panel/text/labels.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "base/utf8.h"

namespace limber::panel {

namespace {

constexpr std::string_view kEllipsis = "…";

// Returns the beginnings of the characters, and the end of the text.
std::vector<std::size_t> boundaries(std::string_view text) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < text.size(); i++) {
    if (!continues_utf8(text[i])) at.push_back(i);
  }
  at.push_back(text.size());
  return at;
}

// Returns the largest n of 0 .. max for which fits(n) holds, 0 if none does. fits(n) implies fits(n - 1).
template <class Fits>
std::size_t largest(std::size_t max, const Fits& fits) {
  std::size_t low = 0;
  std::size_t high = max;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (fits(middle)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// The beginning and the end, together `kept` characters.
std::string without_middle(std::string_view text, const std::vector<std::size_t>& at, std::size_t kept) {
  const std::size_t count = at.size() - 1;
  const std::size_t head = kept - kept / 2;
  return fmt::format("{}{}{}", text.substr(0, at[head]), kEllipsis, text.substr(at[count - kept / 2]));
}

// The first character and those from `from` on that fit: "l…upper…".
std::string around(std::string_view text, std::size_t from, float width, const TextWidth& width_of) {
  const std::vector<std::size_t> at = boundaries(text);
  const std::size_t count = at.size() - 1;
  std::size_t first = 0;
  while (first < count && at[first + 1] <= from) first++;
  const auto shown = [&](std::size_t length) {
    const std::size_t end = std::min(first + length, count);
    return fmt::format("{}{}{}{}", text.substr(0, at[std::min<std::size_t>(1, count)]), kEllipsis,
                       text.substr(at[first], at[end] - at[first]), end < count ? kEllipsis : std::string_view());
  };
  return shown(largest(count - first, [&](std::size_t n) { return width_of(shown(n)) <= width; }));
}

// Returns the first place where the name differs from the most similar one of the others.
std::size_t first_difference(const std::string& name, const std::vector<const std::string*>& others) {
  std::size_t at = 0;
  for (const std::string* const other : others) {
    if (*other == name) continue;
    const auto [a, b] = std::mismatch(name.begin(), name.end(), other->begin(), other->end());
    at = std::max(at, static_cast<std::size_t>(a - name.begin()));
  }
  return at;
}

// Groups the indexes of names that are shown by the same text.
std::map<std::string, std::vector<std::size_t>> by_text(const std::vector<std::string>& texts) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < texts.size(); i++) groups[texts[i]].push_back(i);
  return groups;
}

// Numbers the texts that still stand for different names.
void number_equal_texts(std::span<const std::string> names, float width, const TextWidth& width_of,
                        std::vector<std::string>& texts) {
  std::map<std::string_view, std::size_t> known;  // the first index of each name
  std::set<std::string> used;
  for (std::size_t i = 0; i < names.size(); i++) {
    const auto [first, is_new] = known.try_emplace(names[i], i);
    if (!is_new) {
      texts[i] = texts[first->second];
      continue;
    }
    for (int number = 2; !used.insert(texts[i]).second; number++) {
      const std::string suffix = fmt::format("#{}", number);
      texts[i] = elided(names[i], width - width_of(suffix), width_of) + suffix;
    }
  }
}

}  // namespace

std::string elided(std::string_view text, float width, const TextWidth& width_of) {
  if (width_of(text) <= width) return std::string(text);
  const std::vector<std::size_t> at = boundaries(text);
  const std::size_t kept =
      largest(at.size() - 1, [&](std::size_t n) { return width_of(without_middle(text, at, n)) <= width; });
  return without_middle(text, at, kept);
}

std::vector<std::string> elided_apart(std::span<const std::string> names, float width, const TextWidth& width_of) {
  std::vector<std::string> texts;
  texts.reserve(names.size());
  bool shortened = false;
  for (const std::string& name : names) {
    texts.push_back(elided(name, width, width_of));
    shortened = shortened || texts.back() != name;
  }
  if (!shortened) return texts;
  for (const auto& [text, members] : by_text(texts)) {
    std::vector<const std::string*> others;
    for (const std::size_t i : members) others.push_back(&names[i]);
    for (const std::size_t i : members) {
      if (const std::size_t at = first_difference(names[i], others); at > 0)
        texts[i] = around(names[i], at, width, width_of);
    }
  }
  number_equal_texts(names, width, width_of, texts);
  return texts;
}

std::vector<std::string> wrapped(std::string_view text, float width, const TextWidth& width_of) {
  std::vector<std::string> lines;
  while (width_of(text) > width) {
    const std::vector<std::size_t> at = boundaries(text);
    const std::size_t fitting =
        largest(at.size() - 1, [&](std::size_t n) { return width_of(text.substr(0, at[n])) <= width; });
    std::size_t end = at[std::clamp<std::size_t>(fitting, 1, at.size() - 1)];
    const std::size_t good = text.find_last_of("/ _-", end - 1);
    if (good != std::string_view::npos && good > 0 && good + 1 > end / 3) end = good + 1;
    if (end >= text.size()) break;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  lines.emplace_back(text);
  return lines;
}

}  // namespace limber::panel
