// NodeValues: the values of all nodes' properties, which are numbers in two flat arrays: persistent values (settings)
// and transient values (states and readouts that the simulation changes). [sim]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "properties/node_tree.h"

namespace limber {

/// Pointers to the store's arrays. They change when nodes are added, so read them again through NodeValues::view().
struct StoreView {
  const NodeSlot* slots = nullptr;
  const double* persistent = nullptr;
  const double* transient = nullptr;
  std::uint32_t slot_count = 0;
};

/// Numbers in blocks. A freed block is used again for the next one of its width.
class BlockArray {
 public:
  /// Returns the index of the first number of a new block.
  std::uint32_t allocate(std::uint32_t width);
  /// Sets the block to zero and frees it.
  void free(std::uint32_t first, std::uint32_t width);
  std::span<const double> numbers() const { return numbers_; }
  std::span<double> numbers() { return numbers_; }
  double* at(std::uint32_t index) { return numbers_.data() + index; }
  const double* at(std::uint32_t index) const { return numbers_.data() + index; }

 private:
  std::vector<double> numbers_;
  std::vector<std::vector<std::uint32_t>> free_;  // by width
};

class NodeValues : public NodeTree {
 public:
  /// Reads a property into `out` (`width` numbers); computed ones through their getter.
  void get(NodeId id, const Property& property, double* out) const;

  /// The numbers of a stored property, for the object itself.
  const double* values(NodeId id, const Property& property) const {
    return const_cast<NodeValues*>(this)->mutable_values(id, property);
  }
  /// Direct write access to a stored property, for the object that owns it and updates a readout or state. The write is
  /// not validated, marks nothing dirty and notifies no listener.
  double* mutable_values(NodeId id, const Property& property) {
    const NodeSlot& slot = slots_[id.slot];
    return property.transient ? transient_.at(slot.transient + property.offset)
                              : persistent_.at(slot.persistent + property.offset);
  }
  /// The numbers of all transient or persistent properties of a node, at Property::offset. Write access to the
  /// persistent ones counts as a write.
  double* transient_block(NodeId id) { return transient_.at(slots_[id.slot].transient); }
  const double* transient_block(NodeId id) const { return transient_.at(slots_[id.slot].transient); }
  double* persistent_block(NodeId id) {
    persistent_version_++;
    return persistent_.at(slots_[id.slot].persistent);
  }
  const double* persistent_block(NodeId id) const { return persistent_.at(slots_[id.slot].persistent); }

  std::span<const double> persistent_values() const { return persistent_.numbers(); }
  std::span<const double> transient_values() const { return transient_.numbers(); }
  /// Write access to all values, to restore a checkpoint of the same structure.
  std::span<double> restore_persistent_values() {
    persistent_version_++;
    return persistent_.numbers();
  }
  std::span<double> restore_transient_values() { return transient_.numbers(); }
  /// Counts writes to persistent values and changes of the structure. Copies are out of date when it has changed.
  std::uint64_t persistent_version() const { return persistent_version_; }

  const StoreView* view() const { return &view_; }
  /// Keeps `copy` equal to view() until unregister_view(), for readers that may switch to another store.
  void register_view(StoreView& copy);
  void unregister_view(StoreView& copy);

  [[gnu::always_inline]] void prefetch_values(NodeId id) const {
    prefetch(persistent_.at(slots_[id.slot].persistent), 128);
  }

  /// Removes the node and its descendants; their ids are stale then. Ignores the root and stale ids.
  void remove(NodeId id);
  /// Hides the node and its descendants as if they were removed; their ids are stale until show(). Returns its position
  /// among its siblings.
  std::size_t hide(NodeId id);
  /// Shows a hidden node again at its position, with the id that it had.
  void show(NodeId id, std::size_t position);
  /// Removes a hidden node permanently.
  void remove_hidden(NodeId id);

 protected:
  NodeValues() { refresh_view(); }
  ~NodeValues() = default;

  /// Adds a node with default values.
  NodeId add_with_values(const PropertyTable& table, NodeId parent, std::string name, void* object);
  /// Replaces the table of a node. Properties of the same name and type keep their values. Returns the new id.
  NodeId replace_table(NodeId id, const PropertyTable& table);
  /// Copies numbers into a stored property.
  void write_values(NodeId id, const Property& property, const double* from) {
    double* const to = mutable_values(id, property);
    for (std::uint32_t i = 0; i < property.width; i++) to[i] = from[i];  // at most 4: a call would cost more
    if (!property.transient) persistent_version_++;
  }

 private:
  void allocate_blocks(std::uint32_t slot);
  void free_blocks(std::uint32_t slot);
  void refresh_view();

  BlockArray persistent_;
  BlockArray transient_;
  std::uint64_t persistent_version_ = 0;
  StoreView view_;
  std::vector<StoreView*> registered_views_;
};

}  // namespace limber
