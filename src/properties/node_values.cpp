// NodeValues: blocks of values, which are allocated and freed with the nodes.
#include "properties/node_values.h"

#include <algorithm>

#include "base/check.h"
#include "base/memory/growth.h"

namespace limber {

std::uint32_t BlockArray::allocate(std::uint32_t width) {
  if (width < free_.size() && !free_[width].empty()) {
    const std::uint32_t first = free_[width].back();
    free_[width].pop_back();
    return first;
  }
  const auto first = static_cast<std::uint32_t>(numbers_.size());
  reserve_by_quarter(numbers_, width);  // with many bodies, the values are most of their memory
  numbers_.resize(numbers_.size() + width, 0.0);
  return first;
}

// Free blocks are zero, so that snapshots and hashes do not depend on removed nodes.
void BlockArray::free(std::uint32_t first, std::uint32_t width) {
  if (width == 0) return;
  std::fill_n(at(first), width, 0.0);
  if (free_.size() <= width) free_.resize(width + 1);
  free_[width].push_back(first);
}

void NodeValues::get(NodeId id, const Property& property, double* out) const {
  if (!alive(id)) return (void)std::fill_n(out, property.width, 0.0);
  if (property.computed()) return property.read(nodes_[id.slot].object, out);
  if (property.stored()) std::copy_n(values(id, property), property.width, out);
}

void NodeValues::refresh_view() {
  view_ = {slots_.data(), persistent_.at(0), transient_.at(0), static_cast<std::uint32_t>(slots_.size())};
  for (StoreView* const copy : registered_views_) *copy = view_;
}

void NodeValues::register_view(StoreView& copy) {
  copy = view_;
  registered_views_.push_back(&copy);
}

void NodeValues::unregister_view(StoreView& copy) { std::erase(registered_views_, &copy); }

void NodeValues::allocate_blocks(std::uint32_t slot) {
  const PropertyTable& table = *nodes_[slot].table;
  slots_[slot].persistent = persistent_.allocate(table.persistent_width());
  slots_[slot].transient = transient_.allocate(table.transient_width());
  persistent_version_++;
  refresh_view();
}

void NodeValues::free_blocks(std::uint32_t slot) {
  const PropertyTable& table = *nodes_[slot].table;
  persistent_.free(slots_[slot].persistent, table.persistent_width());
  transient_.free(slots_[slot].transient, table.transient_width());
}

NodeId NodeValues::add_with_values(const PropertyTable& table, NodeId parent, std::string name, void* object) {
  const NodeId id = add_node(table, parent, std::move(name), object);
  allocate_blocks(id.slot);
  for (const Property& property : table.properties()) {
    if (property.stored()) std::copy_n(property.initial.data(), property.width, mutable_values(id, property));
  }
  return id;
}

NodeId NodeValues::replace_table(NodeId id, const PropertyTable& table) {
  // Keep the values of properties that both tables have.
  std::vector<double> carried;
  const PropertyTable& previous_table = *nodes_[id.slot].table;
  for (const Property& property : table.properties()) {
    const std::size_t at = carried.size();
    carried.insert(carried.end(), property.initial.begin(), property.initial.begin() + property.width);
    const Property* const previous = previous_table.find(property.name);
    if (!property.stored() || previous == nullptr || !previous->stored() || previous->type != property.type) continue;
    const double* const old_values = values(id, *previous);
    for (std::uint32_t i = 0; i < property.width; i++)
      carried[at + i] = std::clamp(old_values[i], property.low(i), property.high(i));
    if (property.type != PropertyType::choice) continue;
    // A choice keeps its label; its number may differ between the tables.
    const auto label = std::find(property.choices.begin(), property.choices.end(),
                                 previous->choices[static_cast<std::size_t>(old_values[0])]);
    carried[at] =
        label == property.choices.end() ? property.initial[0] : static_cast<double>(label - property.choices.begin());
  }
  free_blocks(id.slot);
  const NodeId changed_id = change_class(id, table);
  allocate_blocks(id.slot);
  std::size_t at = 0;
  for (const Property& property : table.properties()) {
    if (property.stored()) std::copy_n(carried.data() + at, property.width, mutable_values(changed_id, property));
    at += property.width;
  }
  return changed_id;
}

std::size_t NodeValues::hide(NodeId id) {
  LIMBER_CHECK(alive(id) && id != root());
  const std::size_t position = unlink_from_parent(id);
  set_hidden(id, true);
  persistent_version_++;
  bump_structure_version();
  return position;
}

void NodeValues::show(NodeId id, std::size_t position) {
  bump_structure_version();
  set_hidden(id, false);
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  siblings.insert(siblings.begin() + static_cast<std::ptrdiff_t>(std::min(position, siblings.size())), id);
  persistent_version_++;
}

void NodeValues::remove_hidden(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) remove_hidden(child);
  free_blocks(id.slot);
  free_slot(id.slot);
}

void NodeValues::remove(NodeId id) {
  if (!alive(id) || id == root()) return;
  hide(id);
  remove_hidden(id);
}

}  // namespace limber
