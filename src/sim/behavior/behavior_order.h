// BehaviorOrder: the order in which a world's behaviors and groups are stepped, and their places in it, as the
// properties `place` read and set them. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_group.h"

namespace limber::sim {

/// A single behavior or a group. Empty if it was removed in the present step.
struct StepEntry {
  std::unique_ptr<Behavior> single;
  std::unique_ptr<BehaviorGroup> group;

  std::string_view name() const { return group != nullptr ? group->name() : single->name(); }
  /// "body/behavior", or "/group".
  std::string key() const;
  bool acts_on(const Body& body) const;
};

class BehaviorOrder {
 public:
  /// `entries`: the entries of the world's BehaviorList.
  BehaviorOrder(World& world, std::vector<StepEntry>& entries) : world_(world), entries_(entries) {}

  /// Returns its position, from 1, among the behaviors that act on its body, including groups that the body is in.
  std::size_t place(const Behavior& behavior) const;
  /// Returns its position, from 1, among all names of behaviors and groups, ordered by their first entry.
  std::size_t place(const BehaviorGroup& group) const;
  /// Moves a behavior to position `place`, clamped to the last, from the next step on. The others keep their order.
  /// Rolled back if the guarded call fails. BehaviorList::check_can_move() has to allow it.
  void move(Behavior& behavior, std::size_t place);
  /// The same for a group, among all names: behaviors of the same name become adjacent in the order.
  void move(BehaviorGroup& group, std::size_t place);
  /// Keys of all entries in step order.
  std::vector<std::string> keys() const;
  /// Sorts the entries into the order of these keys; those that it doesn't contain follow in their previous order.
  void sort(const std::vector<std::string>& keys);

 private:
  std::vector<std::string_view> names() const;
  std::size_t place_of(NodeId id) const;

  World& world_;
  std::vector<StepEntry>& entries_;
  mutable std::vector<std::uint32_t> places_;                   // by slot of the node
  mutable std::uint64_t places_structure_ = ~std::uint64_t{0};  // the structure version for which places were computed
};

}  // namespace limber::sim
