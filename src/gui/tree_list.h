// TreeList: the tree of things as lines: who is open, who fits a search. Made anew only when one of these changes, so
// that a frame costs what is seen.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "params/tree.h"

namespace limber {

class TreeList {
 public:
  struct Line {
    std::uint32_t node = 0;
    std::uint16_t depth = 0;
    bool opens = false;  ///< There is something below.
    bool open = false;
  };

  /// The lines for that tree; `words`: only what has them in its name, with what it lies in.
  const std::vector<Line>& lines(const std::shared_ptr<const Tree>& tree, std::string_view words);
  void toggle(std::uint32_t node);
  /// Opens all that a thing lies in.
  void reveal(std::uint32_t node);

  /// What people call it: "world" for /physics/sim.
  static std::string_view title(const Tree& tree, std::uint32_t node);

 private:
  void add(std::uint32_t node, std::uint16_t depth);
  void add_found(std::string_view words);
  static std::uint64_t key(const Tree& tree, std::uint32_t node);
  std::vector<std::uint32_t> top() const;

  std::shared_ptr<const Tree> tree_;
  std::string words_;
  bool stale_ = true;
  bool begun_ = false;
  std::unordered_set<std::uint64_t> open_;
  std::vector<Line> lines_;
};

}  // namespace limber
