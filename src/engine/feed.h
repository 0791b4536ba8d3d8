// Feed: what one client is told of changes: the newest value of each path that it follows where that is not what it
// knows. What it set itself it knows. One for OSC's subscribers and OSCQuery's listeners alike. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/image.h"

namespace limber {

class Feed {
 public:
  static constexpr std::size_t kMostPaths = 4096;  ///< Paths and patterns asked for.
  static constexpr std::size_t kMostValues = 4096;

  /// A value to tell; false: no room, it comes next time.
  using Tell = std::function<bool(const std::string& path, const Row& row, const RowValue& value)>;

  /// Follows a row's path, or a pattern: the values that it reaches. One that reaches none yet waits. False: too many.
  bool add(std::string_view path);
  /// Follows it no longer; what was told of it is forgotten. False: it was not followed.
  bool remove(std::string_view path);
  bool empty() const { return paths_.empty(); }
  std::size_t size() const { return paths_.size(); }

  /// Looks at an image: who is there, and what `self` set since the one before. Every image is to be heard.
  void hear(const std::shared_ptr<const Image>& image, const Origin& self);
  /// Tells what differs in the image heard last. What there was no room for comes first the next time.
  void tell(const Tell& tell);

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

  void bind(const Tree& tree);
  void note(const WriteNote& note);

  std::vector<std::string> paths_;
  std::vector<Value> values_;
  std::unordered_map<std::uint64_t, std::uint32_t> by_place_;  // where in values_
  bool unbound_ = true;                                        // paths have changed
  std::shared_ptr<const Image> image_;
  std::uint64_t heard_note_ = 0;
  std::size_t next_ = 0;
};

}  // namespace limber
