// RowSearch: rows whose address has all words of a search, found a slice a frame, so that no frame waits for it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gui/desk.h"

namespace limber {

class RowSearch {
 public:
  static constexpr std::size_t kMost = 200;  ///< Rows found; more are said to be there.
  static constexpr std::size_t kNodesAFrame = 400;

  /// Words parted by blanks; each must be somewhere in the address, whatever its case.
  void look_for(std::string_view words);
  /// One slice, of that tree; begins anew when the tree is another.
  void go_on(const std::shared_ptr<const Tree>& tree);

  const std::vector<PlacedRow>& found() const { return found_; }
  bool active() const { return !words_.empty(); }
  bool done() const { return tree_ != nullptr && next_ >= tree_->nodes().size(); }
  bool more() const { return more_; }

 private:
  bool fits(std::string_view path, const Row& row) const;

  std::vector<std::string> words_;
  std::shared_ptr<const Tree> tree_;
  std::size_t next_ = 0;
  bool more_ = false;
  std::vector<PlacedRow> found_;
};

}  // namespace limber
