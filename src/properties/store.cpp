// The store: nodes, blocks of values, the setter, dirty properties.
#include "properties/store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/memory/archive.h"
#include "base/text.h"

namespace limber {

namespace {

const PropertyTable& group_table() {
  static const PropertyTable table("group", "", "", {});
  return table;
}

// Grows by a quarter instead of doubling: with many bodies, the values are most of their memory.
template <class T>
void reserve(std::vector<T>& v, std::size_t more) {
  if (v.size() + more > v.capacity()) v.reserve(v.size() + v.size() / 4 + more);
}

// Rounds a number to one that the type has.
double round_to_type(PropertyType type, double v) {
  if (type == PropertyType::boolean || type == PropertyType::flags3) return v >= 0.5 ? 1 : 0;
  return type == PropertyType::integer || type == PropertyType::choice ? std::round(v) : v;
}

// Scales a quaternion to unit length; false if it is zero. A unit quaternion up to rounding stays bit-identical, so
// that setting a value that was read does not change it.
bool normalize(double* q) {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (square < 1e-18) return false;
  if (std::abs(square - 1) > 1e-14) {
    for (std::size_t i = 0; i < 4; i++) q[i] /= std::sqrt(square);
  }
  return true;
}

// Rounds, clamps and normalizes values of a property. The error follows the property's path.
Result<SetOutcome> accept_values(const Property& property, std::span<const double> values, double* accepted) {
  if (values.size() != property.width)
    return Error{
        fmt::format("takes {} number{}, not {}", property.width, property.width == 1 ? "" : "s", values.size())};
  SetOutcome outcome;
  for (std::size_t i = 0; i < property.width; i++) {
    if (!std::isfinite(values[i])) return Error{fmt::format("takes finite numbers, not {}", values[i])};
    const double v = round_to_type(property.type, values[i]);
    accepted[i] = std::clamp(v, property.low(i), property.high(i));
    outcome.clamped |= accepted[i] != v;
  }
  if (property.type == PropertyType::choice && outcome.clamped)
    return Error{fmt::format("must be one of {} (got {})", fmt::join(property.choices, ", "), values[0])};
  if (property.type == PropertyType::quat && !normalize(accepted)) return Error{"takes a rotation, not 0 0 0 0"};
  return outcome;
}

}  // namespace

Store::Store() {
  slots_.push_back({1, table_number(group_table()), 0, 0});
  nodes_.push_back({&group_table(), nullptr, "", {}, {}, 0, 0, 0});
  root_ = {0, 1};
  refresh_view();
}

std::uint32_t Store::table_number(const PropertyTable& table) {
  const auto found = std::find(tables_.begin(), tables_.end(), &table);
  if (found != tables_.end()) return static_cast<std::uint32_t>(found - tables_.begin());
  tables_.push_back(&table);
  return static_cast<std::uint32_t>(tables_.size() - 1);
}

void Store::refresh_view() {
  view_ = {slots_.data(), persistent_.data(), transient_.data(), static_cast<std::uint32_t>(slots_.size())};
  for (StoreView* const copy : registered_views_) *copy = view_;
}

void Store::register_view(StoreView& copy) {
  copy = view_;
  registered_views_.push_back(&copy);
}

void Store::unregister_view(StoreView& copy) { std::erase(registered_views_, &copy); }

void Store::order_children(NodeId parent, std::span<const NodeId> first) {
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

std::uint32_t Store::allocate_block(std::vector<double>& block, std::vector<std::vector<std::uint32_t>>& free_list,
                                    std::uint32_t width) {
  if (width < free_list.size() && !free_list[width].empty()) {
    const std::uint32_t base = free_list[width].back();
    free_list[width].pop_back();
    return base;
  }
  const auto base = static_cast<std::uint32_t>(block.size());
  reserve(block, width);
  block.resize(block.size() + width, 0.0);
  return base;
}

NodeId Store::add(const PropertyTable& table, NodeId parent, std::string name, void* object) {
  LIMBER_CHECK(alive(parent) && child(parent, name).null());
  std::uint32_t slot = 0;
  if (free_slots_.empty()) {
    slot = static_cast<std::uint32_t>(slots_.size());
    reserve(slots_, 1);
    reserve(nodes_, 1);
    slots_.emplace_back();
    nodes_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  NodeSlot& s = slots_[slot];
  s.generation++;  // even to odd: alive
  s.table = table_number(table);
  s.persistent = allocate_block(persistent_, free_persistent_, table.persistent_width());
  s.transient = allocate_block(transient_, free_transient_, table.transient_width());
  const NodeId id{slot, s.generation};
  nodes_[slot] = {&table, object, std::move(name), parent, {}, 0, 0, structure_version_ + 1};
  nodes_[parent.slot].children.push_back(id);
  child_of_.insert(slot);
  for (const Property& property : table.properties()) {
    if (property.stored()) std::copy_n(property.initial.data(), property.width, slot_values(id, property));
  }
  mark_all_dirty(id);
  persistent_version_++;
  bump_structure_version();
  refresh_view();
  return id;
}

NodeId Store::add_group(NodeId parent, std::string name) {
  return add(group_table(), parent, std::move(name), nullptr);
}

bool Store::is_group(NodeId id) const { return alive(id) && nodes_[id.slot].table == &group_table(); }

const Store::Node& Store::null_node() {
  static const Node none{&group_table(), nullptr, "", {}, {}, 0, 0, 0};
  return none;
}

NodeId Store::change_table(NodeId id, const PropertyTable& table, void* object) {
  if (!alive(id)) return {};
  Node& node = nodes_[id.slot];
  LIMBER_CHECK(node.children.empty());
  node.object = object;
  if (node.table == &table) return id;
  // Keep the values of properties that both tables have.
  std::vector<double> carried;
  const PropertyTable& previous_table = *node.table;
  for (const Property& property : table.properties()) {
    const std::size_t at = carried.size();
    carried.insert(carried.end(), property.initial.begin(), property.initial.begin() + property.width);
    const Property* const previous = previous_table.find(property.name);
    if (!property.stored() || previous == nullptr || !previous->stored() || previous->type != property.type) continue;
    const double* const values = slot_values(id, *previous);
    for (std::uint32_t i = 0; i < property.width; i++)
      carried[at + i] = std::clamp(values[i], property.low(i), property.high(i));
    if (property.type != PropertyType::choice) continue;
    // A choice keeps its label; its number may differ between the tables.
    const auto label = std::find(property.choices.begin(), property.choices.end(),
                                 previous->choices[static_cast<std::size_t>(values[0])]);
    carried[at] =
        label == property.choices.end() ? property.initial[0] : static_cast<double>(label - property.choices.begin());
  }
  free_blocks(id.slot);
  NodeSlot& slot = slots_[id.slot];
  slot.generation += 2;
  slot.table = table_number(table);
  slot.persistent = allocate_block(persistent_, free_persistent_, table.persistent_width());
  slot.transient = allocate_block(transient_, free_transient_, table.transient_width());
  node.table = &table;
  node.dirty = 0;
  node.added_version = structure_version_ + 1;
  const NodeId changed_id{id.slot, slot.generation};
  std::vector<NodeId>& siblings = nodes_[node.parent.slot].children;
  std::replace(siblings.begin(), siblings.end(), id, changed_id);
  std::size_t at = 0;
  for (const Property& property : table.properties()) {
    if (property.stored()) std::copy_n(carried.data() + at, property.width, slot_values(changed_id, property));
    at += property.width;
  }
  mark_all_dirty(changed_id);
  persistent_version_++;
  bump_structure_version();
  refresh_view();
  return changed_id;
}

// Returns the blocks of a node to the free lists.
void Store::free_blocks(std::uint32_t slot_index) {
  const NodeSlot& slot = slots_[slot_index];
  const PropertyTable& table = *nodes_[slot_index].table;
  const auto add_free = [](std::vector<std::vector<std::uint32_t>>& list, std::uint32_t base, std::uint32_t width) {
    if (width == 0) return;
    if (list.size() <= width) list.resize(width + 1);
    list[width].push_back(base);
  };
  // Free blocks are zero, so that snapshots and hashes do not depend on removed nodes.
  std::fill_n(persistent_.begin() + slot.persistent, table.persistent_width(), 0.0);
  std::fill_n(transient_.begin() + slot.transient, table.transient_width(), 0.0);
  add_free(free_persistent_, slot.persistent, table.persistent_width());
  add_free(free_transient_, slot.transient, table.transient_width());
}

void Store::remove_subtree(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) remove_subtree(child);
  child_of_.erase(child_of_.find(id.slot));
  slots_[id.slot].generation++;  // odd to even: removed
  free_slot(id.slot);
}

// Frees the slot and the blocks of a removed node.
void Store::free_slot(std::uint32_t slot) {
  free_blocks(slot);
  free_slots_.push_back(slot);
  nodes_[slot] = {};
}

// Returns the position that the node had among its siblings. Searches from the end, since mostly recent nodes are
// removed.
std::size_t Store::unlink_from_parent(NodeId id) {
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  const auto at = std::find(siblings.rbegin(), siblings.rend(), id).base() - 1;
  const auto position = static_cast<std::size_t>(at - siblings.begin());
  siblings.erase(at);
  return position;
}

void Store::remove(NodeId id) {
  if (!alive(id) || id == root_) return;
  bump_structure_version();
  unlink_from_parent(id);
  remove_subtree(id);
  persistent_version_++;
}

NodeId Store::child(NodeId parent, std::string_view name) const {
  const auto found = child_of_.find(ChildKey{parent.slot, name});
  return found == child_of_.end() ? NodeId{} : NodeId{*found, slots_[*found].generation};
}

std::string Store::path(NodeId id) const {
  if (id == root_ || !alive(id)) return id == root_ ? "/" : "";
  std::string path;
  for (NodeId at = id; at != root_; at = nodes_[at.slot].parent) path = "/" + escape_name(nodes_[at.slot].name) + path;
  return path;
}

Result<SetOutcome> Store::set(NodeId id, std::string_view property, std::span<const double> values) {
  if (!alive(id)) return Error{"this object no longer exists"};
  return set(id, table(id).at(property), values);
}

Result<SetOutcome> Store::validate(NodeId id, const Property& property, std::span<const double> values,
                                   double* accepted) const {
  if (!alive(id)) return Error{"this object no longer exists"};
  const auto rejected = [&](std::string_view why) {
    return Error{fmt::format("{}/{}{}", path(id), property.name, why)};
  };
  if (!property.writable() || (property.computed() && property.write == nullptr))
    return rejected(property.kind == PropertyKind::action ? " can be called, not set" : " can be read, not set");
  Result<SetOutcome> outcome = accept_values(property, values, accepted);
  if (!outcome) return rejected(" " + outcome.error());
  if (property.validate != nullptr) {
    const Result<void> allowed = property.validate(nodes_[id.slot].object, accepted);
    if (!allowed) return rejected(": " + allowed.error());
  }
  return outcome;
}

Result<SetOutcome> Store::set(NodeId id, const Property& property, std::span<const double> values) {
  std::array<double, 4> accepted{};
  Result<SetOutcome> outcome = validate(id, property, values, accepted.data());
  if (!outcome) return outcome;
  void* const object = nodes_[id.slot].object;
  if (tracks_explicit_sets_) mark_explicitly_set(id, property);
  if (property.computed()) {
    property.write(object, accepted.data());
    return outcome;
  }
  write(id, property, accepted.data());
  mark_dirty(id, property);
  if (property.on_write != nullptr) property.on_write(object, property);
  return outcome;
}

void Store::get(NodeId id, const Property& property, double* out) const {
  if (!alive(id)) return (void)std::fill_n(out, property.width, 0.0);
  if (property.computed()) return property.read(nodes_[id.slot].object, out);
  if (property.stored()) std::copy_n(values(id, property), property.width, out);
}

void Store::mark_dirty(NodeId id, const Property& property) {
  if (property.on_change == nullptr || !alive(id)) return;
  Node& node = nodes_[id.slot];
  if (node.dirty == 0) state_.dirty_nodes.push_back(id);
  node.dirty |= std::uint64_t{1} << property.index;
  state_.dirty_are_independent = state_.dirty_are_independent && property.independent;
}

void Store::serialize(Archive& archive) {
  auto& [dirty_nodes, dirty_are_independent] = state_;
  if (archive.loading()) {
    for (const NodeId id : dirty_nodes) nodes_[id.slot].dirty = 0;
  }
  archive.serialize_all(dirty_nodes, dirty_are_independent);
  for (const NodeId id : dirty_nodes) archive.serialize(nodes_[id.slot].dirty);
}

void Store::mark_all_dirty(NodeId id) {
  for (const Property& property : nodes_[id.slot].table->properties()) mark_dirty(id, property);
}

void Store::flush(ThreadPool* pool) {
  // A callback may set other properties; at most four rounds, in case of a cycle.
  for (int round = 0; round < 4 && !state_.dirty_nodes.empty(); round++) {
    flushing_.clear();
    flushing_.swap(state_.dirty_nodes);
    ThreadPool* const usable_pool = std::exchange(state_.dirty_are_independent, true) ? pool : nullptr;
    parallel_for_ranges(usable_pool, static_cast<int>(flushing_.size()), [this](int, int first, int end) {
      for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); i++) {
        prefetch_ahead(i, flushing_.size(), [this](std::size_t index) { return flushing_[index]; });
        flush_node(flushing_[i]);
      }
    });
  }
}

// The node stays in the list of dirty nodes, without dirty bits: to search the list would cost more.
void Store::flush(NodeId id) {
  state_.dirty_are_independent = false;
  flush_node(id);
}

void Store::flush_node(NodeId id) {
  if (alive(id)) run_callbacks(id, std::exchange(nodes_[id.slot].dirty, 0));
}

void Store::run_callbacks(NodeId id, std::uint64_t properties) {
  const PropertyTable& table = *nodes_[id.slot].table;
  std::array<void (*)(void*), 64> called;
  auto end = called.begin();
  for (; properties != 0; properties &= properties - 1) {
    const Property& property = table.property(static_cast<std::uint32_t>(std::countr_zero(properties)));
    if (property.on_change == nullptr || std::find(called.begin(), end, property.on_change) != end) continue;
    *end++ = property.on_change;
    property.on_change(nodes_[id.slot].object);
  }
}

}  // namespace limber
