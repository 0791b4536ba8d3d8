// Store: the tree of all nodes (bodies, joints, settings, …) with the values of their properties, which are numbers in
// two flat arrays: persistent values (settings) and transient values (states and readouts that the simulation changes).
// The setter, Store::set(), validates, clamps, writes, and marks properties dirty. [sim]
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/id.h"
#include "base/memory/prefetch.h"
#include "base/result.h"
#include "base/threads/thread_pool.h"
#include "properties/property_table.h"
#include "properties/store_transaction.h"

namespace limber {

/// The location of a node's numbers. Scripts read it without a call: script/api/c_api.inc declares the same layout.
struct NodeSlot {
  std::uint32_t generation = 0;  ///< Odd: alive.
  std::uint32_t table = 0;       ///< Index of its class in Store::tables().
  std::uint32_t persistent = 0;  ///< First number in the persistent block.
  std::uint32_t transient = 0;   ///< First number in the transient block.
};

/// Pointers to the store's arrays. They change when nodes are added, so read them again through Store::view().
struct StoreView {
  const NodeSlot* slots = nullptr;
  const double* persistent = nullptr;
  const double* transient = nullptr;
  std::uint32_t slot_count = 0;
};

/// The result of a successful Store::set().
struct SetOutcome {
  bool clamped = false;
};

class Archive;

class Store {
 public:
  Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The root of the tree; it has no properties.
  NodeId root() const { return root_; }

  /// Adds a node under `parent` with default values; all properties are dirty. `object` is passed to the properties'
  /// callbacks. Names of siblings must be unique; the caller checks this with child().
  NodeId add(const PropertyTable& table, NodeId parent, std::string name, void* object);
  /// Adds a node without properties, such as /physics/body.
  NodeId add_group(NodeId parent, std::string name);
  /// Replaces the table and object of a node that has no children; its name and position remain. Properties of the same
  /// name and type keep their values, clamped to the new ranges; the others get their defaults. Returns the node's id,
  /// which is new if the table differs; the old id is stale then.
  NodeId change_table(NodeId id, const PropertyTable& table, void* object);
  /// Removes the node and its descendants; their ids are stale then. Ignores the root and stale ids.
  void remove(NodeId id);

  bool alive(NodeId id) const {
    return id.slot < slots_.size() && slots_[id.slot].generation == id.generation && (id.generation & 1u) != 0;
  }
  // For a stale id these return an empty table, an empty name, null, a null id, and no children.
  const PropertyTable& table(NodeId id) const { return *node(id).table; }
  const std::string& name(NodeId id) const { return node(id).name; }
  void* object(NodeId id) const { return node(id).object; }
  NodeId parent(NodeId id) const { return node(id).parent; }
  std::span<const NodeId> children(NodeId id) const { return node(id).children; }
  /// True for a node that add_group() added.
  bool is_group(NodeId id) const;
  /// Returns the child of exactly that name, or a null id.
  NodeId child(NodeId parent, std::string_view name) const;
  /// Returns the address of a node: "/physics/body/arm/part/tip". Builds the string.
  std::string path(NodeId id) const;

  /// Sets a property: clamps the value to the range, writes it, marks the property dirty, and notifies the listener.
  /// The value of a computed property goes to its setter. Errors: NaN or infinity, a wrong number of numbers, a
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

  /// Reads a property into `out` (`width` numbers); computed ones through their getter.
  void get(NodeId id, const Property& property, double* out) const;

  /// The numbers of a stored property, for the object itself.
  const double* values(NodeId id, const Property& property) const {
    return const_cast<Store*>(this)->slot_values(id, property);
  }
  /// Direct write access to a stored property, for the object that owns it and updates a readout or state. The write is
  /// not validated, marks nothing dirty and notifies no listener.
  double* mutable_values(NodeId id, const Property& property) { return slot_values(id, property); }
  /// The numbers of all transient or persistent properties of a node, at Property::offset. Write access to the
  /// persistent ones counts as a write.
  double* transient_block(NodeId id) { return transient_.data() + slots_[id.slot].transient; }
  const double* transient_block(NodeId id) const { return transient_.data() + slots_[id.slot].transient; }
  double* persistent_block(NodeId id) {
    persistent_version_++;
    return persistent_.data() + slots_[id.slot].persistent;
  }
  const double* persistent_block(NodeId id) const { return persistent_.data() + slots_[id.slot].persistent; }

  /// The properties of a node that the scene's script set explicitly, as a bit mask: those that were set while an
  /// ExplicitSetScope existed, including computed properties and the ones behind them, and those that
  /// mark_explicitly_set() added.
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
  // Inlined, because a compiler may treat a function that only prefetches as having no effect and drop the call.
  [[gnu::always_inline]] void prefetch_node(NodeId id) const {
    const Node& node = nodes_[id.slot];
    __builtin_prefetch(&node);
    __builtin_prefetch(&node.children);
  }
  [[gnu::always_inline]] void prefetch_values(NodeId id) const {
    prefetch(persistent_.data() + slots_[id.slot].persistent, 128);
  }
  [[gnu::always_inline]] void prefetch_object(NodeId id) const {
    if (const void* const object = nodes_[id.slot].object; object != nullptr) prefetch(object, 64);
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
  /// Hides the node and its descendants as if they were removed; their ids are stale until show(). Returns its position
  /// among its siblings.
  std::size_t hide(NodeId id);
  /// Shows a hidden node again at its position, with the id that it had.
  void show(NodeId id, std::size_t position);
  /// Removes a hidden node permanently.
  void remove_hidden(NodeId id);

  /// Called before each write of set() and write_unchecked() with the previous value; for a computed property, with the
  /// stored properties behind it. `later`: the property will be written over time (by a ramp). In a transaction, the
  /// calls are deferred until the commit.
  struct Listener {
    void (*callback)(void* context, NodeId id, const Property& property, bool later, const double* before) = nullptr;
    void* context = nullptr;
  };
  /// Sets the listener and returns the previous one.
  Listener set_listener(Listener listener) { return std::exchange(listener_, listener); }
  /// Notifies the listener about a property; deferred in a transaction unless `later`.
  void notify(NodeId id, const Property& property, bool over_time) {
    if (listener_.callback == nullptr) return;
    if (transaction_.active && !over_time) return defer_notification(id, property);
    listener_.callback(listener_.context, id, property, over_time, values(id, property));
  }

  std::span<const double> persistent_values() const { return persistent_; }
  std::span<const double> transient_values() const { return transient_; }
  /// Write access to all values, to restore a checkpoint of the same structure.
  std::span<double> restore_persistent_values() {
    persistent_version_++;
    return persistent_;
  }
  std::span<double> restore_transient_values() { return transient_; }
  /// For checkpoints: the properties with pending on-change callbacks, in the order in which these will be called.
  void serialize(Archive& archive);
  /// Counts writes to persistent values and changes of the structure. Copies are out of date when it has changed.
  std::uint64_t persistent_version() const { return persistent_version_; }
  std::uint64_t structure_version() const { return structure_version_; }
  /// Counts a change of something that is not a node.
  void bump_structure_version() { structure_version_++; }
  /// The structure version when the node was added or got another table.
  std::uint64_t added_version(NodeId id) const { return node(id).added_version; }
  const StoreView* view() const { return &view_; }
  /// Keeps `copy` equal to view() until unregister_view(), for readers that may switch to another store.
  void register_view(StoreView& copy);
  void unregister_view(StoreView& copy);
  /// Moves these children to the front in this order; the others follow in their previous order.
  void order_children(NodeId parent, std::span<const NodeId> first);
  /// Returns the index of the table in tables(), which it is added to if necessary.
  std::uint32_t table_number(const PropertyTable& table);
  std::span<const PropertyTable* const> tables() const { return tables_; }

  /// Calls f(id) for the node and its descendants, parents first, children in order.
  template <class F>
  void walk(NodeId id, F&& f) const {
    f(id);
    for (const NodeId child : nodes_[id.slot].children) walk(child, f);
  }

 private:
  struct Node {
    const PropertyTable* table = nullptr;
    void* object = nullptr;
    std::string name;
    NodeId parent;
    std::vector<NodeId> children;
    std::uint64_t dirty = 0;
    std::uint64_t explicitly_set = 0;
    std::uint64_t added_version = 0;
  };
  // Index of children by parent and name. The set holds slots; the names are in the nodes.
  struct ChildKey {
    std::uint32_t parent;
    std::string_view name;
    bool operator==(const ChildKey&) const = default;
  };
  struct ChildOf {
    using is_transparent = void;
    const std::vector<Node>* nodes;
    ChildKey key(std::uint32_t slot) const { return {(*nodes)[slot].parent.slot, (*nodes)[slot].name}; }
    ChildKey key(const ChildKey& k) const { return k; }
  };
  struct ChildHash : ChildOf {
    template <class K>
    std::size_t operator()(const K& of) const {
      const ChildKey k = key(of);
      return std::hash<std::string_view>{}(k.name) ^ (k.parent * 0x9e3779b97f4a7c15u);
    }
  };
  struct ChildEqual : ChildOf {
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return key(a) == key(b);
    }
  };

  const Node& node(NodeId id) const { return alive(id) ? nodes_[id.slot] : null_node(); }
  static const Node& null_node();
  double* slot_values(NodeId id, const Property& property) {
    NodeSlot& slot = slots_[id.slot];
    return property.transient ? transient_.data() + slot.transient + property.offset
                              : persistent_.data() + slot.persistent + property.offset;
  }
  std::uint32_t allocate_block(std::vector<double>& block, std::vector<std::vector<std::uint32_t>>& free_list,
                               std::uint32_t width);
  std::size_t unlink_from_parent(NodeId id);
  void remove_subtree(NodeId id);
  void free_blocks(std::uint32_t slot);
  void free_slot(std::uint32_t slot);
  void write(NodeId id, const Property& property, const double* values) {
    notify(id, property, false);
    save_before_write(id, property);
    double* const to = slot_values(id, property);
    for (std::uint32_t i = 0; i < property.width; i++) to[i] = values[i];  // at most 4: a call would cost more
    if (!property.transient) persistent_version_++;
  }
  void save_value(NodeId id, const Property& property);
  void defer_notification(NodeId id, const Property& property);
  StoreTransaction::Saved& saved_in_transaction(NodeId id);
  void set_hidden(NodeId id, bool hidden);
  void flush_node(NodeId id);
  void refresh_view();

  std::vector<NodeSlot> slots_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<double> persistent_;
  std::vector<double> transient_;
  std::vector<std::vector<std::uint32_t>> free_persistent_;  // by width
  std::vector<std::vector<std::uint32_t>> free_transient_;
  std::unordered_set<std::uint32_t, ChildHash, ChildEqual> child_of_{0, ChildHash{{&nodes_}}, ChildEqual{{&nodes_}}};
  std::vector<const PropertyTable*> tables_;
  // what persists from tick to tick, besides the values and the dirty flags of the nodes in the list
  struct State {
    std::vector<NodeId> dirty_nodes;
    bool dirty_are_independent = true;  // all pending callbacks are independent, and no node is in the list twice
  } state_;
  std::vector<NodeId> flushing_;
  StoreTransaction transaction_;
  NodeId root_;
  std::uint64_t persistent_version_ = 0;
  std::uint64_t structure_version_ = 0;
  StoreView view_;
  std::vector<StoreView*> registered_views_;
  bool tracks_explicit_sets_ = false;
  Listener listener_;
};

}  // namespace limber
