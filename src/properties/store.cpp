// The store: the setter, dirty properties, on-change callbacks.
#include "properties/store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/memory/archive.h"
#include "base/plural.h"

namespace limber {

namespace {

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
    return Error{fmt::format("takes {}, not {}", counted(property.width, "number"), values.size())};
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

NodeId Store::add(const PropertyTable& table, NodeId parent, std::string name, void* object) {
  const NodeId id = add_with_values(table, parent, std::move(name), object);
  mark_all_dirty(id);
  return id;
}

NodeId Store::add_group(NodeId parent, std::string name) {
  return add(group_table(), parent, std::move(name), nullptr);
}

NodeId Store::change_table(NodeId id, const PropertyTable& table, void* object) {
  if (!alive(id)) return {};
  Node& node = nodes_[id.slot];
  LIMBER_CHECK(node.children.empty());
  node.object = object;
  if (node.table == &table) return id;
  node.dirty = 0;
  const NodeId changed_id = replace_table(id, table);
  mark_all_dirty(changed_id);
  return changed_id;
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
