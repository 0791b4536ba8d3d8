// NodeTree: the tree of all nodes (bodies, joints, settings, …): their ids, names, classes, objects, parents and
// children. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "base/id.h"
#include "base/memory/prefetch.h"
#include "properties/property_table.h"

namespace limber {

/// The location of a node's numbers. Scripts read it without a call: script/api/c_api.inc declares the same layout.
struct NodeSlot {
  std::uint32_t generation = 0;  ///< Odd: alive.
  std::uint32_t table = 0;       ///< Index of its class in NodeTree::tables().
  std::uint32_t persistent = 0;  ///< First number in the persistent block.
  std::uint32_t transient = 0;   ///< First number in the transient block.
};

class NodeTree {
 public:
  NodeTree(const NodeTree&) = delete;
  NodeTree& operator=(const NodeTree&) = delete;

  /// The root of the tree; it has no properties.
  NodeId root() const { return root_; }

  bool alive(NodeId id) const {
    return id.slot < slots_.size() && slots_[id.slot].generation == id.generation && (id.generation & 1u) != 0;
  }
  // For a stale id these return an empty table, an empty name, null, a null id, and no children.
  const PropertyTable& table(NodeId id) const { return *node(id).table; }
  const std::string& name(NodeId id) const { return node(id).name; }
  void* object(NodeId id) const { return node(id).object; }
  NodeId parent(NodeId id) const { return node(id).parent; }
  std::span<const NodeId> children(NodeId id) const { return node(id).children; }
  /// True for a node that Store::add_group() added.
  bool is_group(NodeId id) const;
  /// Returns the child of exactly that name, or a null id.
  NodeId child(NodeId parent, std::string_view name) const;
  /// Returns the address of a node: "/physics/body/arm/part/tip". Builds the string.
  std::string path(NodeId id) const;
  /// Calls f(id) for the node and its descendants, parents first, children in order.
  template <class F>
  void walk(NodeId id, F&& f) const {
    f(id);
    for (const NodeId child : nodes_[id.slot].children) walk(child, f);
  }

  /// Moves these children to the front in this order; the others follow in their previous order.
  void order_children(NodeId parent, std::span<const NodeId> first);
  /// Counts changes of the structure. Copies are out of date when it has changed.
  std::uint64_t structure_version() const { return structure_version_; }
  /// Counts a change of something that is not a node.
  void bump_structure_version() { structure_version_++; }
  /// The structure version when the node was added or got another table.
  std::uint64_t added_version(NodeId id) const { return node(id).added_version; }

  /// Returns the index of the table in tables(), which it is added to if necessary.
  std::uint32_t table_number(const PropertyTable& table);
  std::span<const PropertyTable* const> tables() const { return tables_; }

  // Inlined, because a compiler may treat a function that only prefetches as having no effect and drop the call.
  [[gnu::always_inline]] void prefetch_node(NodeId id) const {
    const Node& node = nodes_[id.slot];
    __builtin_prefetch(&node);
    __builtin_prefetch(&node.children);
  }
  [[gnu::always_inline]] void prefetch_object(NodeId id) const {
    if (const void* const object = nodes_[id.slot].object; object != nullptr) prefetch(object, 64);
  }

 protected:
  struct Node {
    const PropertyTable* table = nullptr;
    void* object = nullptr;
    std::string name;
    NodeId parent;
    std::vector<NodeId> children;
    std::uint64_t added_version = 0;
    // of Store, here because it accesses them together with the table and the object
    std::uint64_t dirty = 0;
    std::uint64_t explicitly_set = 0;
  };

  NodeTree();
  ~NodeTree() = default;

  /// The table of nodes without properties.
  static const PropertyTable& group_table();
  const Node& node(NodeId id) const { return alive(id) ? nodes_[id.slot] : null_node(); }
  /// Adds a node, whose slot has no numbers yet.
  NodeId add_node(const PropertyTable& table, NodeId parent, std::string name, void* object);
  /// Gives the node another table and a new id.
  NodeId change_class(NodeId id, const PropertyTable& table);
  /// Removes the node from its parent's children. Returns the position that it had.
  std::size_t unlink_from_parent(NodeId id);
  /// Hides a node that is unlinked and its descendants: their ids are stale. Or shows them again.
  void set_hidden(NodeId id, bool hidden);
  /// Makes the slot of a hidden node available to others.
  void free_slot(std::uint32_t slot);

  std::vector<NodeSlot> slots_;
  std::vector<Node> nodes_;

 private:
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

  static const Node& null_node();

  std::vector<std::uint32_t> free_slots_;
  std::unordered_set<std::uint32_t, ChildHash, ChildEqual> child_of_{0, ChildHash{{&nodes_}}, ChildEqual{{&nodes_}}};
  std::vector<const PropertyTable*> tables_;
  NodeId root_;
  std::uint64_t structure_version_ = 0;
};

/// Returns the node of `to` that has the path of `id` in `from`; null if there is none.
NodeId counterpart(const NodeTree& from, NodeId id, const NodeTree& to);

}  // namespace limber
