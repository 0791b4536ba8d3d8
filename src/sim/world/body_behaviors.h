// BodyBehaviors: the behaviors of one body, in order; the world's BehaviorList creates and removes them. [sim]
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "properties/store.h"

namespace limber::sim {

class Behavior;

class BodyBehaviors {
 public:
  BodyBehaviors(const Store& store, NodeId group) : store_(store), group_(group) {}

  /// The parent of their nodes.
  NodeId group() const { return group_; }
  std::span<Behavior* const> list() const { return behaviors_; }
  Behavior* find(std::string_view name) const {
    const NodeId id = store_.child(group_, name);
    return id.null() ? nullptr : static_cast<Behavior*>(store_.object(id));
  }

  // Called by BehaviorList.
  void insert(std::size_t index, Behavior& behavior) {
    behaviors_.insert(behaviors_.begin() + static_cast<std::ptrdiff_t>(index), &behavior);
  }
  void replace(const Behavior& previous, Behavior& behavior) { *std::ranges::find(behaviors_, &previous) = &behavior; }
  /// Returns the index that it had.
  std::size_t remove(const Behavior& behavior) {
    const auto at = std::ranges::find(behaviors_, &behavior);
    return static_cast<std::size_t>(behaviors_.erase(at) - behaviors_.begin());
  }

 private:
  const Store& store_;
  NodeId group_;
  std::vector<Behavior*> behaviors_;
};

}  // namespace limber::sim
