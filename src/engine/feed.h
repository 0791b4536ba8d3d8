// Feed: what one client is told of changes: the newest value of each path that it follows where that is not what it
// knows. What it set itself it knows. A value that several paths reach is told once. One for OSC's subscribers and
// OSCQuery's listeners alike. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/image.h"
#include "params/pattern_budget.h"

namespace limber {

class Feed {
 public:
  static constexpr std::size_t kMostPaths = 4096;  ///< Paths and patterns asked for.
  static constexpr std::size_t kMostValues = 4096;
  static constexpr int kSliceWork = 200'000;  ///< Steps of matching, some nanoseconds each.

  /// A value to tell; false: no room, it comes next time.
  using Tell = std::function<bool(const std::string& path, const Row& row, const RowValue& value)>;

  /// Follows a row's path, or a pattern: the values that it reaches. One that reaches none yet waits. Of several paths
  /// that reach a value, the one with the least `order` has it. False: too many.
  bool add(std::string_view path, std::int64_t order = 0);
  /// Follows it no longer; what was told of it is forgotten. False: it was not followed.
  bool remove(std::string_view path);
  bool empty() const { return paths_.empty(); }
  std::size_t size() const { return paths_.size(); }

  /// Looks at an image: who is there, and what `self` set since the one before. Every image is to be heard.
  void hear(const std::shared_ptr<const Image>& image, const Origin& self);
  /// The same in slices of kSliceWork at most. False: call it again; nothing is told before.
  bool hear_some(const std::shared_ptr<const Image>& image, const Origin& self);
  /// Tells what differs in the image heard last. What there was no room for comes first the next time.
  void tell(const Tell& tell_one);
  /// The same for the values that a path has. Returns how many these are, and false if there was no room for one.
  std::pair<std::size_t, bool> tell(std::string_view path, const Tell& tell_one);
  /// Why a path has reached no value in the image heard last; empty: it has, or is not followed.
  std::string_view problem(std::string_view path) const;
  /// Whether the paths reach more than kMostValues: the others are not told.
  bool truncated() const { return truncated_; }

 private:
  struct Value {
    std::string path;
    const Row* row = nullptr;
    TreeNumbers numbers;
    std::uint64_t place = 0;  // key of node and row
    bool told = false;
    bool own = false;  // set by the client itself, since the last tell, to `set`
    std::array<double, 4> known{};
    std::string known_text;
    std::array<double, 4> set{};
  };

  struct Path {
    std::string text;
    std::int64_t order = 0;
    std::size_t first = 0, end = 0;  // its values
    std::size_t next = 0;            // of these, which is told first
    std::string problem;
  };

  void begin_bind(const std::shared_ptr<const Tree>& tree);
  bool bind_some();
  void bind(Path& path);
  void add_value(const TreePlace& place);
  void note(const WriteNote& note);
  bool tell_value(Value& value, const Tell& tell_one);
  bool tell(std::size_t first, std::size_t end, std::size_t& next, const Tell& tell_one);

  std::vector<Path> paths_;                                    // by order
  std::vector<Value> values_;                                  // by path
  std::unordered_map<std::uint64_t, std::uint32_t> by_place_;  // where in values_
  bool unbound_ = true;                                        // paths have changed
  bool truncated_ = false;
  std::shared_ptr<const Image> image_;
  std::uint64_t heard_note_ = 0;
  std::size_t next_ = 0;
  // while values are looked for
  std::shared_ptr<const Tree> tree_;
  std::size_t binds_next_ = 0;  // path
  PatternBudget bind_work_;
  std::vector<Value> before_;
  std::unordered_map<std::string_view, Value*> known_;
};

}  // namespace limber
