// Matches the components of address and pattern in parallel, with backtracking for `//`.
#include "base/osc_pattern.h"

#include <span>
#include <vector>

#include "base/text.h"

namespace limber {

namespace {

constexpr int kMaxAttempts = 2000;

// An empty component of the pattern (`//`) matches any number of components.
bool pieces_match(std::span<const std::string_view> pattern, std::span<const std::string_view> address, int& budget) {
  if (--budget < 0) return false;
  if (pattern.empty()) return address.empty();
  if (pattern.front().empty()) {
    for (std::size_t skip = 0; skip <= address.size(); skip++) {
      if (pieces_match(pattern.subspan(1), address.subspan(skip), budget)) return true;
    }
    return false;
  }
  return !address.empty() && pattern_match(pattern.front(), address.front()) &&
         pieces_match(pattern.subspan(1), address.subspan(1), budget);
}

}  // namespace

bool address_matches(std::string_view pattern, std::string_view address) {
  if (pattern.empty() || address.empty()) return false;
  const auto pattern_pieces = split(pattern.substr(1), '/');
  const auto address_pieces = split(address.substr(1), '/');
  int budget = kMaxAttempts;
  return pieces_match(pattern_pieces, address_pieces, budget);
}

}  // namespace limber
