// Store: the tree of all nodes (bodies, joints, settings, …) with the values of their properties. The setter,
// Store::set(), validates, clamps, writes, and marks properties dirty; on-change callbacks then apply them. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/id.h"
#include "base/result.h"
#include "base/threads/thread_pool.h"
#include "properties/node_values.h"
#include "properties/store_transaction.h"

namespace limber {

/// The result of a successful Store::set().
struct SetOutcome {
  bool clamped = false;
};

class Archive;

/// The structure is in NodeTree, the numbers are in NodeValues.
class Store : public NodeValues {
 public:
  /// Adds a node under `parent` with default values; all properties are dirty. `object` is passed to the properties'
  /// callbacks. Names of siblings must be unique; the caller checks this with child().
  NodeId add(const PropertyTable& table, NodeId parent, std::string name, void* object);
  /// Adds a node without properties, such as /physics/body.
  NodeId add_group(NodeId parent, std::string name);
  /// Replaces the table and object of a node that has no children; its name and position remain. Properties of the same
  /// name and type keep their values, clamped to the new ranges; the others get their defaults. Returns the node's id,
  /// which is new if the table differs; the old id is stale then.
  NodeId change_table(NodeId id, const PropertyTable& table, void* object);

  /// Sets a property: clamps the value to the range, writes it, marks the property dirty, and notifies the listener.
  /// The value of a computed property goes to its setter. Errors: NaN or infinity, a wrong number of components, a
  /// property that can't be set, a value that the object rejects. On error nothing is written.
  Result<SetOutcome> set(NodeId id, const Property& property, std::span<const double> values);
  Result<SetOutcome> set(NodeId id, std::string_view property, std::span<const double> values);
  /// Validates like set() and stores the clamped value in `accepted` (4 numbers), without writing it to the property.
  Result<SetOutcome> validate(NodeId id, const Property& property, std::span<const double> values,
                              double* accepted) const;
  /// Writes a value that validate() returned, or one between two such values, to a stored property of a live node, and
  /// notifies like set(). Does not mark the property dirty: the caller runs the on-change callback.
  void write_unchecked(NodeId id, const Property& property, const double* values) {
    write(id, property, values);
    if (property.on_write != nullptr) property.on_write(nodes_[id.slot].object, property);
  }

  /// The properties of a node that the scene's script set explicitly, as a bit mask: those that were set while an
  /// ExplicitSetScope existed, including computed properties and the stored ones that their setters write, and those
  /// that mark_explicitly_set() added.
  std::uint64_t explicitly_set(NodeId id) const { return node(id).explicitly_set; }
  void mark_explicitly_set(NodeId id, std::uint64_t properties) {
    if (alive(id)) nodes_[id.slot].explicitly_set |= properties;
  }
  void mark_explicitly_set(NodeId id, const Property& property) {
    mark_explicitly_set(id, std::uint64_t{1} << property.index);
  }
  /// While one exists with `true`, set() marks properties as explicitly set.
  class ExplicitSetScope {
   public:
    ExplicitSetScope(Store& store, bool explicitly_set) : store_(store), previous_(store.tracks_explicit_sets_) {
      store_.tracks_explicit_sets_ = explicitly_set;
    }
    ~ExplicitSetScope() { store_.tracks_explicit_sets_ = previous_; }
    ExplicitSetScope(const ExplicitSetScope&) = delete;
    ExplicitSetScope& operator=(const ExplicitSetScope&) = delete;

   private:
    Store& store_;
    bool previous_;
  };

  /// Marks a property dirty, as if it had been set. Has no effect without an on-change callback.
  void mark_dirty(NodeId id, const Property& property);
  /// Marks every property dirty that has an on-change callback.
  void mark_all_dirty(NodeId id);
  /// Runs the on-change callbacks of all dirty properties, each function once per node, in the order in which the nodes
  /// became dirty. Runs in parallel if all of them are independent.
  void flush(ThreadPool* pool = nullptr);
  /// Runs the callbacks of one node ahead of the others.
  void flush(NodeId id);
  /// Prefetches the data of the next nodes in a loop over `count` nodes, at index `at`. After a tick of physics, their
  /// data is no longer in the cache. Works in three stages, since each one needs the pointers of the previous: the node
  /// and its numbers, then the object, then the data that its callbacks read. `id_of(index)` may return a null or stale
  /// id.
  template <class IdOf>
  void prefetch_ahead(std::size_t at, std::size_t count, IdOf&& id_of) const {
    constexpr std::size_t kAhead = 5;
    if (const NodeId far = at + 3 * kAhead < count ? id_of(at + 3 * kAhead) : NodeId{}; alive(far)) {
      prefetch_node(far);
      prefetch_values(far);
    }
    if (const NodeId nearer = at + 2 * kAhead < count ? id_of(at + 2 * kAhead) : NodeId{}; alive(nearer))
      prefetch_object(nearer);
    if (const NodeId near = at + kAhead < count ? id_of(at + kAhead) : NodeId{}; alive(near)) prefetch_callbacks(near);
  }
  void prefetch_callbacks(NodeId id) const {
    const Node& owner = node(id);
    owner.table->prefetch(owner.object);
  }
  /// Runs the on-change callbacks of these properties of a node (a bit mask), each function once.
  void run_callbacks(NodeId id, std::uint64_t properties);
  /// True if the property is dirty: its on-change callback is pending.
  bool is_dirty(NodeId id, const Property& property) const { return (node(id).dirty >> property.index & 1u) != 0; }

  /// Begins a transaction: previous values are logged until commit_transaction() or rollback(). Allocates only while
  /// the log grows.
  void begin_transaction();
  /// True if no value was written in the transaction.
  bool transaction_is_empty() const { return transaction_.values.empty(); }
  /// Ends the transaction, keeps its writes and sends the deferred notifications.
  void commit_transaction();
  /// Ends the transaction and restores all values and dirty flags to those at begin_transaction().
  void rollback();
  /// Logs the current value before a write that bypasses set(). Does nothing outside a transaction.
  void save_before_write(NodeId id, const Property& property) {
    if (transaction_.active) save_value(id, property);
  }
  /// Called before each write of set() and write_unchecked() with the previous value; for a computed property, with the
  /// stored properties that its setter writes. `over_time`: a morph will write the property. In a transaction, the
  /// calls are deferred until the commit.
  struct Listener {
    void (*callback)(void* context, NodeId id, const Property& property, bool over_time,
                     const double* before) = nullptr;
    void* context = nullptr;
  };
  /// Sets the listener and returns the previous one.
  Listener set_listener(Listener listener) { return std::exchange(listener_, listener); }
  /// Notifies the listener about a property; deferred in a transaction unless `over_time`.
  void notify(NodeId id, const Property& property, bool over_time) {
    if (listener_.callback == nullptr) return;
    if (transaction_.active && !over_time) return defer_notification(id, property);
    listener_.callback(listener_.context, id, property, over_time, values(id, property));
  }

  /// For checkpoints: the properties with pending on-change callbacks, in the order in which these will be called.
  void serialize(Archive& archive);

 private:
  void write(NodeId id, const Property& property, const double* values) {
    notify(id, property, false);
    save_before_write(id, property);
    write_values(id, property, values);
  }
  void save_value(NodeId id, const Property& property);
  void defer_notification(NodeId id, const Property& property);
  StoreTransaction::Saved& saved_in_transaction(NodeId id);
  void flush_node(NodeId id);

  // what persists from tick to tick, besides the values and the dirty flags of the nodes in the list
  struct State {
    std::vector<NodeId> dirty_nodes;
    bool dirty_are_independent = true;  // all pending callbacks are independent, and no node is in the list twice
  } state_;
  std::vector<NodeId> flushing_;
  StoreTransaction transaction_;
  bool tracks_explicit_sets_ = false;
  Listener listener_;
};

}  // namespace limber
