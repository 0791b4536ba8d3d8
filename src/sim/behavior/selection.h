// Selection: a list of names, patterns or "all" that selects objects, such as the parts of a body. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::sim {

class Selection {
 public:
  /// Unspecified: selects all.
  Selection() = default;
  /// Names, OSC patterns, "all". An empty list selects nothing.
  explicit Selection(std::vector<std::string> words) : is_default_(false), words_(std::move(words)) {}

  bool is_default() const { return is_default_; }
  /// True if all objects are selected, by "all" or because the selection is unspecified.
  bool selects_all() const;
  const std::vector<std::string>& words() const { return words_; }

  /// True if an object of this name is selected; `by_all`: whether "all" selects it.
  bool selects(std::string_view name, bool by_all = true) const;
  /// Returns the first literal name that is not in `names`, for the caller's error message; empty if there is none.
  std::string_view first_missing(const std::vector<std::string_view>& names) const;
  /// True if it contains a literal name, which has to exist; patterns and "all" may match nothing.
  bool has_names() const;

  bool operator==(const Selection&) const = default;

 private:
  bool is_default_ = true;
  std::vector<std::string> words_;
};

}  // namespace limber::sim
