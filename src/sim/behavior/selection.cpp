// Selection: matches names.
#include "sim/behavior/selection.h"

#include <algorithm>

#include "base/text.h"

namespace limber::sim {

namespace {
constexpr std::string_view kAll = "all";
bool is_name(std::string_view word) { return word != kAll && !is_pattern(word); }
}  // namespace

bool Selection::selects_all() const {
  return is_default_ || std::find(words_.begin(), words_.end(), kAll) != words_.end();
}

bool Selection::selects(std::string_view name, bool by_all) const {
  if (by_all && selects_all()) return true;
  return std::any_of(words_.begin(), words_.end(), [&](const std::string& word) {
    return word == name || (word != kAll && is_pattern(word) && pattern_match(word, name));
  });
}

std::string_view Selection::first_missing(const std::vector<std::string_view>& names) const {
  for (const std::string& word : words_) {
    if (is_name(word) && std::find(names.begin(), names.end(), word) == names.end()) return word;
  }
  return {};
}

bool Selection::has_names() const { return std::any_of(words_.begin(), words_.end(), is_name); }

}  // namespace limber::sim
