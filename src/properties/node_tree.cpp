// NodeTree: adding, hiding, removing and finding nodes.
#include "properties/node_tree.h"

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "base/memory/growth.h"
#include "base/text.h"

namespace limber {

const PropertyTable& NodeTree::group_table() {
  static const PropertyTable table("group", "", "", {});
  return table;
}

const NodeTree::Node& NodeTree::null_node() {
  static const Node none{&group_table(), nullptr, "", {}, {}, 0, 0, 0};
  return none;
}

NodeTree::NodeTree() {
  slots_.push_back({1, table_number(group_table()), 0, 0});
  nodes_.push_back(null_node());
  root_ = {0, 1};
}

std::uint32_t NodeTree::table_number(const PropertyTable& table) {
  const auto found = std::find(tables_.begin(), tables_.end(), &table);
  if (found != tables_.end()) return static_cast<std::uint32_t>(found - tables_.begin());
  tables_.push_back(&table);
  return static_cast<std::uint32_t>(tables_.size() - 1);
}

bool NodeTree::is_group(NodeId id) const { return alive(id) && nodes_[id.slot].table == &group_table(); }

NodeId NodeTree::child(NodeId parent, std::string_view name) const {
  const auto found = child_of_.find(ChildKey{parent.slot, name});
  return found == child_of_.end() ? NodeId{} : NodeId{*found, slots_[*found].generation};
}

std::string NodeTree::path(NodeId id) const {
  if (id == root_ || !alive(id)) return id == root_ ? "/" : "";
  std::string path;
  for (NodeId at = id; at != root_; at = nodes_[at.slot].parent) path = "/" + escape_name(nodes_[at.slot].name) + path;
  return path;
}

NodeId counterpart(const NodeTree& from, NodeId id, const NodeTree& to) {
  if (!from.alive(id)) return {};
  if (id == from.root()) return to.root();
  const NodeId parent = counterpart(from, from.parent(id), to);
  return parent.null() ? NodeId{} : to.child(parent, from.name(id));
}

void NodeTree::order_children(NodeId parent, std::span<const NodeId> first) {
  if (!alive(parent)) return;
  std::vector<NodeId>& children = nodes_[parent.slot].children;
  std::vector<bool> named(slots_.size());
  for (const NodeId child : first) named[child.slot] = true;
  std::vector<NodeId> ordered(first.begin(), first.end());
  std::copy_if(children.begin(), children.end(), std::back_inserter(ordered),
               [&](NodeId child) { return !named[child.slot]; });
  LIMBER_CHECK(ordered.size() == children.size());
  children = std::move(ordered);
  bump_structure_version();
}

NodeId NodeTree::add_node(const PropertyTable& table, NodeId parent, std::string name, void* object) {
  LIMBER_CHECK(alive(parent) && child(parent, name).null());
  auto slot = static_cast<std::uint32_t>(slots_.size());
  if (free_slots_.empty()) {
    reserve_by_quarter(slots_, 1);
    reserve_by_quarter(nodes_, 1);
    slots_.emplace_back();
    nodes_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  bump_structure_version();
  NodeSlot& s = slots_[slot];
  s.generation++;  // even to odd: alive
  s.table = table_number(table);
  const NodeId id{slot, s.generation};
  nodes_[slot] = {&table, object, std::move(name), parent, {}, structure_version_, 0, 0};
  nodes_[parent.slot].children.push_back(id);
  child_of_.insert(slot);
  return id;
}

NodeId NodeTree::change_class(NodeId id, const PropertyTable& table) {
  bump_structure_version();
  NodeSlot& slot = slots_[id.slot];
  slot.generation += 2;
  slot.table = table_number(table);
  const NodeId changed_id{id.slot, slot.generation};
  Node& node = nodes_[id.slot];
  node.table = &table;
  node.added_version = structure_version_;
  std::vector<NodeId>& siblings = nodes_[node.parent.slot].children;
  std::replace(siblings.begin(), siblings.end(), id, changed_id);
  return changed_id;
}

// Searches from the end, since mostly recent nodes are removed.
std::size_t NodeTree::unlink_from_parent(NodeId id) {
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  const auto at = std::find(siblings.rbegin(), siblings.rend(), id).base() - 1;
  const auto position = static_cast<std::size_t>(at - siblings.begin());
  siblings.erase(at);
  return position;
}

void NodeTree::set_hidden(NodeId id, bool hidden) {
  NodeSlot& slot = slots_[id.slot];
  if (hidden) {
    child_of_.erase(child_of_.find(id.slot));
    slot.generation++;  // odd to even: its ids are stale
  } else {
    slot.generation--;
    child_of_.insert(id.slot);
  }
  for (const NodeId child : nodes_[id.slot].children) set_hidden(child, hidden);
}

void NodeTree::free_slot(std::uint32_t slot) {
  free_slots_.push_back(slot);
  nodes_[slot] = {};
}

}  // namespace limber
