// ObjectList: the objects of one class that a world or a body owns, in order, with unique names; their nodes are the
// children of one group. [sim]
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "properties/store.h"

namespace limber::sim {

template <class T>
class ObjectList {
 public:
  ObjectList(Store& store, NodeId group) : store_(store), group_(group) {}

  /// The parent of the objects' nodes.
  NodeId group() const { return group_; }
  std::span<const std::unique_ptr<T>> list() const { return objects_; }
  /// Returns null if no object has this name.
  T* find(std::string_view name) const {
    const NodeId id = store_.child(group_, name);
    return id.null() ? nullptr : static_cast<T*>(store_.object(id));
  }
  /// Returns an error unless an object with this name can be added. `kind`: such as "body".
  Result<void> check_new_name(std::string_view kind, std::string_view name) const {
    if (const auto fault = name_error(name)) return Error{fmt::format("{}: {}", kind, *fault)};
    if (store_.child(group_, name).null()) return {};
    return Error{fmt::format("there is a {} '{}' already; names are unique", kind, name)};
  }
  T& add(std::unique_ptr<T> object) {
    objects_.push_back(std::move(object));
    return *objects_.back();
  }
  /// Returns the index of an object, or list().size().
  std::size_t index_of(const T& object) const {
    const auto is_it = [&](const std::unique_ptr<T>& each) { return each.get() == &object; };
    return static_cast<std::size_t>(std::ranges::find_if(objects_, is_it) - objects_.begin());
  }
  /// Moves the objects of `first` to the front, in this order; the others follow in their previous order.
  void move_to_front(const std::vector<T*>& first) {
    const auto is_same = [](const T* wanted, const std::unique_ptr<T>& element) { return element.get() == wanted; };
    if (first.size() <= objects_.size() && std::equal(first.begin(), first.end(), objects_.begin(), is_same)) return;
    std::vector<NodeId> ids;
    std::vector<std::uint32_t> rank(store_.view()->slot_count, static_cast<std::uint32_t>(first.size()));
    for (const T* object : first) {
      rank[object->id().slot] = static_cast<std::uint32_t>(ids.size());
      ids.push_back(object->id());
    }
    std::stable_sort(objects_.begin(), objects_.end(),
                     [&](const auto& a, const auto& b) { return rank[a->id().slot] < rank[b->id().slot]; });
    store_.order_children(group_, ids);
  }
  /// For removing objects.
  std::vector<std::unique_ptr<T>>& objects() { return objects_; }

 private:
  Store& store_;
  NodeId group_;
  std::vector<std::unique_ptr<T>> objects_;
};

}  // namespace limber::sim
