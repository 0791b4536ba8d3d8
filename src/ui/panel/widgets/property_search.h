// PropertySearch: searches properties by words in their address, a slice per frame, so that no frame is delayed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ui/panel/gui_context.h"

namespace limber::panel {

class PropertySearch {
 public:
  static constexpr std::size_t kMaxResults = 200;  ///< Maximum number of results; more() is true if there are others.
  static constexpr std::size_t kNodesPerFrame = 400;

  /// Starts a search for words separated by spaces; each must occur in the address, ignoring case.
  void start(std::string_view words);
  /// Searches one slice of the tree; restarts if the tree has changed.
  void advance(const std::shared_ptr<const TreeSnapshot>& tree);

  const std::vector<PropertyHandle>& found() const { return found_; }
  bool active() const { return !words_.empty(); }
  bool done() const { return tree_ != nullptr && next_ >= tree_->nodes().size(); }
  bool more() const { return more_; }

 private:
  bool matches(std::string_view path, const Property& property) const;

  std::vector<std::string> words_;
  std::shared_ptr<const TreeSnapshot> tree_;
  std::size_t next_ = 0;
  bool more_ = false;
  std::vector<PropertyHandle> found_;
};

}  // namespace limber::panel
