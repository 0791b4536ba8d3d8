// Store: every thing is a node of one tree, its values plain numbers in two flat blocks: kept (properties) and live
// (states and readouts). One door writes: it refuses what is no number, clamps, writes and marks. [sim]
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
#include "base/prefetch.h"
#include "base/result.h"
#include "base/team.h"
#include "params/store_undo.h"
#include "params/table.h"

namespace limber {

/// What scripts read without a call: where a node's numbers are. Layout known to script/c_api.inc.
struct NodeSlot {
  std::uint32_t generation = 0;  ///< Odd: alive.
  std::uint32_t table = 0;       ///< Number of its class in the order of first use.
  std::uint32_t kept = 0;        ///< First number in the kept block.
  std::uint32_t live = 0;        ///< First number in the live block.
};

/// The arrays behind the store; they move when nodes are added, so ask again through the same pointer.
struct StoreView {
  const NodeSlot* slots = nullptr;
  const double* kept = nullptr;
  const double* live = nullptr;
  std::uint32_t slot_count = 0;
};

/// How a value was taken.
struct SetOutcome {
  bool clamped = false;
};

class Store {
 public:
  Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The root of the tree; it has no rows.
  NodeId root() const { return root_; }

  /// Adds a node under `parent`; values are the table's defaults, every effect is marked. `thing` is handed to the
  /// rows' functions. Names among siblings must be unique: that is the caller's to check with child().
  NodeId add(const Table& table, NodeId parent, std::string name, void* thing);
  /// A node without rows, such as /physics/body.
  NodeId add_group(NodeId parent, std::string name);
  /// Gives a node without children another table and thing, in its place and under its name. Rows of the same name and
  /// type keep their values, brought into their ranges; the others have their defaults. The id stays when the table
  /// does; else the old one is stale.
  NodeId retable(NodeId id, const Table& table, void* thing);
  /// Removes the node and all below it.
  void remove(NodeId id);

  bool alive(NodeId id) const {
    return id.slot < slots_.size() && slots_[id.slot].generation == id.generation && (id.generation & 1u) != 0;
  }
  // Of a stale id: a table without rows, no name, null, a null id, no children.
  const Table& table(NodeId id) const { return *node(id).table; }
  const std::string& name(NodeId id) const { return node(id).name; }
  void* thing(NodeId id) const { return node(id).thing; }
  NodeId parent(NodeId id) const { return node(id).parent; }
  std::span<const NodeId> children(NodeId id) const { return node(id).children; }
  bool is_group(NodeId id) const;
  /// The child of exactly that name, or a null id.
  NodeId child(NodeId parent, std::string_view name) const;
  /// The address of a node: "/physics/body/arm/part/tip". Formed when asked.
  std::string path(NodeId id) const;

  /// The door. Refuses NaN, infinities, a wrong count, a row that is not writable; clamps to the range; writes; marks.
  /// A view's value goes to the rows behind it. Nothing of a refused value is applied.
  Result<SetOutcome> set(NodeId id, const Row& row, std::span<const double> values);
  Result<SetOutcome> set(NodeId id, std::string_view row, std::span<const double> values);
  /// What set() would make of the values: `taken` has room for 4. The same is refused.
  Result<SetOutcome> take(NodeId id, const Row& row, std::span<const double> values, double* taken) const;
  /// For what moves a stored row of a living thing between two values that take() gave: writes and tells like set(),
  /// but checks nothing more and marks nothing. The effect is the caller's to run.
  void go_on(NodeId id, const Row& row, const double* values) {
    write(id, row, values);
    if (row.written != nullptr) row.written(nodes_[id.slot].thing, row);
  }

  /// Reads a row (views are computed): `out` takes row.width numbers.
  void get(NodeId id, const Row& row, double* out) const;

  /// The numbers of a stored row, for the thing itself.
  const double* values(NodeId id, const Row& row) const { return const_cast<Store*>(this)->slot_values(id, row); }
  /// For the thing that tells a readout or a state: writes past the door, since nothing is to be brought into the
  /// world.
  double* tell(NodeId id, const Row& row) { return slot_values(id, row); }
  double* live_block(NodeId id) { return live_.data() + slots_[id.slot].live; }
  const double* live_block(NodeId id) const { return live_.data() + slots_[id.slot].live; }
  double* kept_block(NodeId id) {
    kept_version_++;
    return kept_.data() + slots_[id.slot].kept;
  }
  const double* kept_block(NodeId id) const { return kept_.data() + slots_[id.slot].kept; }

  /// The rows that a scene's run has said of a node, a bit a row: what went through the door while a Saying lived,
  /// views and the rows behind them, and what say() added.
  std::uint64_t said(NodeId id) const { return node(id).said; }
  void say(NodeId id, std::uint64_t rows) {
    if (alive(id)) nodes_[id.slot].said |= rows;
  }
  void say(NodeId id, const Row& row) { say(id, std::uint64_t{1} << row.index); }
  /// While one lives, what is set counts as said.
  class Saying {
   public:
    Saying(Store& store, bool said) : store_(store), before_(store.saying_) { store_.saying_ = said; }
    ~Saying() { store_.saying_ = before_; }
    Saying(const Saying&) = delete;
    Saying& operator=(const Saying&) = delete;

   private:
    Store& store_;
    bool before_;
  };

  /// Marks a row as if it had been set.
  void mark(NodeId id, const Row& row);
  /// Marks every row that has an effect.
  void mark_all(NodeId id);
  /// Runs the effects of all marked rows, each function once a node, in the order in which nodes were marked; where all
  /// of them are apart, side by side.
  void apply_marks(Team* team = nullptr);
  /// The same for one node, ahead of the others.
  void apply_marks(NodeId id);
  /// For who goes through many things and is at one of them: after a tick of physics they are far off, and the
  /// processor fetches those behind it while it goes on. What one finds leads to the next: first the node and its
  /// numbers, then the thing, then what its effects look at. `id_of(place)`: a null or dead id is passed over.
  template <class IdOf>
  void fetch_ahead(std::size_t at, std::size_t count, IdOf&& id_of) const {
    constexpr std::size_t kAhead = 5;
    if (const NodeId far = at + 3 * kAhead < count ? id_of(at + 3 * kAhead) : NodeId{}; alive(far)) {
      fetch_node(far);
      fetch_numbers(far);
    }
    if (const NodeId nearer = at + 2 * kAhead < count ? id_of(at + 2 * kAhead) : NodeId{}; alive(nearer))
      fetch_thing(nearer);
    if (const NodeId near = at + kAhead < count ? id_of(at + kAhead) : NodeId{}; alive(near)) fetch_effects(near);
  }
  // A compiler that looks at these alone sees that nothing comes of them and leaves them out: they have no calls.
  [[gnu::always_inline]] void fetch_node(NodeId id) const {
    const Node& node = nodes_[id.slot];
    __builtin_prefetch(&node);
    __builtin_prefetch(&node.children);
  }
  [[gnu::always_inline]] void fetch_numbers(NodeId id) const { prefetch(kept_.data() + slots_[id.slot].kept, 128); }
  [[gnu::always_inline]] void fetch_thing(NodeId id) const {
    if (const void* const thing = nodes_[id.slot].thing; thing != nullptr) prefetch(thing, 64);
  }
  void fetch_effects(NodeId id) const {
    const Node& its = node(id);
    its.table->fetch(its.thing);
  }
  /// Runs the effects of these rows of a node, a bit a row, each function once.
  void run_effects(NodeId id, std::uint64_t rows);
  /// Whether the row waits for its effect.
  bool marked(NodeId id, const Row& row) const { return (node(id).marks >> row.index & 1u) != 0; }

  /// From here on the log keeps what each value was, until end_undo() or take_back(). Allocates only while it grows.
  void begin_undo();
  /// Whether the log is empty.
  bool undo_untouched() const { return undo_.values.empty(); }
  /// The call ended well: what it wrote stays.
  void end_undo();
  /// The call failed: every value, and whether its effect waits, is as it was when begin_undo() was called.
  void take_back();
  /// Before something writes past the door: lets the log know the value. Costs nothing outside of a guarded call.
  void keep(NodeId id, const Row& row) {
    if (undo_.active) keep_value(id, row);
  }
  /// Takes the node and all below it out of sight, as if removed; the answer is its place among its siblings.
  std::size_t hide(NodeId id);
  /// Brings a hidden node back to its place, with the id that it had.
  void show(NodeId id, std::size_t place);
  /// Removes a hidden node for good.
  void drop_hidden(NodeId id);

  /// Told of each row that is written through the door, of a view the rows behind it, and of what it was before; or,
  /// `later`, that is going to be written as time goes on. Of a guarded call once it has ended well.
  struct Listener {
    void (*heard)(void* who, NodeId id, const Row& row, bool later, const double* before) = nullptr;
    void* who = nullptr;
  };
  /// From here on this one hears; the answer: who did before.
  Listener listen(Listener listener) { return std::exchange(listener_, listener); }
  /// Who listens hears of the row.
  void announce(NodeId id, const Row& row, bool later) {
    if (listener_.heard == nullptr) return;
    if (undo_.active && !later) return hear_later(id, row);
    listener_.heard(listener_.who, id, row, later, values(id, row));
  }

  std::span<const double> kept() const { return kept_; }
  std::span<const double> live() const { return live_; }
  /// Counts writes to kept values and changes of structure: copies are made anew when it has changed.
  std::uint64_t kept_version() const { return kept_version_; }
  std::uint64_t structure_version() const { return structure_version_; }
  /// Something that is no node has come or gone.
  void note_structure() { structure_version_++; }
  /// The structure's version when the node came, or got another table.
  std::uint64_t born(NodeId id) const { return node(id).born; }
  /// The structure's version when something came, went or got another place or table at the node or below it.
  std::uint64_t changed(NodeId id) const { return node(id).changed; }
  const StoreView* view() const { return &view_; }
  /// Keeps `copy` like view() until hide_view(): for readers that may turn to another store.
  void show_view(StoreView& copy);
  void hide_view(StoreView& copy);
  /// Brings children into this order; those that are not named stand behind, in the order that they had.
  void order_children(NodeId parent, std::span<const NodeId> first);
  std::uint32_t table_number(const Table& table);
  std::span<const Table* const> tables() const { return tables_; }

  /// Calls f(id) for each node below `id` and itself, parents first, children in order.
  template <class F>
  void walk(NodeId id, F&& f) const {
    f(id);
    for (const NodeId child : nodes_[id.slot].children) walk(child, f);
  }

 private:
  friend class WorldKey;
  struct Node {
    const Table* table = nullptr;
    void* thing = nullptr;
    std::string name;
    NodeId parent;
    std::vector<NodeId> children;
    std::uint64_t marks = 0;
    std::uint64_t said = 0;
    std::uint64_t born = 0;
    std::uint64_t changed = 0;
  };
  // children are found by parent and name; the set holds slots, the names stand in the nodes alone
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

  const Node& node(NodeId id) const { return alive(id) ? nodes_[id.slot] : nobody(); }
  static const Node& nobody();
  double* slot_values(NodeId id, const Row& row) {
    NodeSlot& slot = slots_[id.slot];
    return row.live ? live_.data() + slot.live + row.offset : kept_.data() + slot.kept + row.offset;
  }
  std::uint32_t take_block(std::vector<double>& block, std::vector<std::vector<std::uint32_t>>& spare,
                           std::uint32_t width);
  void note_change(NodeId at);
  std::size_t leave_siblings(NodeId id);
  void release(NodeId id);
  void give_back_blocks(std::uint32_t slot);
  void give_back(std::uint32_t slot);
  void write(NodeId id, const Row& row, const double* values) {
    announce(id, row, false);
    keep(id, row);
    double* const to = slot_values(id, row);
    for (std::uint32_t i = 0; i < row.width; i++) to[i] = values[i];  // so few that a call would cost more
    if (!row.live) kept_version_++;
  }
  void keep_value(NodeId id, const Row& row);
  void hear_later(NodeId id, const Row& row);
  StoreUndo::Kept& kept_of(NodeId id);
  void turn_hidden(NodeId id, bool hide);
  void run_marks(NodeId id);
  void refresh_view();

  std::vector<NodeSlot> slots_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<double> kept_;
  std::vector<double> live_;
  std::vector<std::vector<std::uint32_t>> spare_kept_;  // by width
  std::vector<std::vector<std::uint32_t>> spare_live_;
  std::unordered_set<std::uint32_t, ChildHash, ChildEqual> child_of_{0, ChildHash{{&nodes_}}, ChildEqual{{&nodes_}}};
  std::vector<const Table*> tables_;
  std::vector<NodeId> marked_;
  bool apart_ = true;  // all that is marked are effects apart, and no node is in the list twice
  std::vector<NodeId> applying_;
  StoreUndo undo_;
  NodeId root_;
  std::uint64_t kept_version_ = 0;
  std::uint64_t structure_version_ = 0;
  StoreView view_;
  std::vector<StoreView*> view_copies_;
  bool saying_ = false;
  Listener listener_;
};

}  // namespace limber
