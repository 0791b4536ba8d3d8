// Selection: which of several things are meant, by name, pattern or "all"; and how a body's things are found by it.
// [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber {

class Selection {
 public:
  /// Left out: all are meant.
  Selection() = default;
  /// Names, OSC patterns, "all". An empty list means none.
  explicit Selection(std::vector<std::string> words) : left_out_(false), words_(std::move(words)) {}

  bool left_out() const { return left_out_; }
  /// Whether all are meant, by "all" or by leaving it out.
  bool all() const;
  const std::vector<std::string>& words() const { return words_; }

  /// Whether a thing of that name is meant; `by_all` answers for "all".
  bool means(std::string_view name, bool by_all = true) const;
  /// A name of it that is none of `names`: "there is …" texts are the caller's. Empty: each name exists.
  std::string_view missing(const std::vector<std::string_view>& names) const;
  /// Whether a name stands in it as such, which then must exist; patterns and "all" may match nothing.
  bool has_names() const;

  bool operator==(const Selection&) const = default;

 private:
  bool left_out_ = true;
  std::vector<std::string> words_;
};

}  // namespace limber
