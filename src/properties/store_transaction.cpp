// Transactions of the store: the rollback log, deferred notifications, and nodes that are hidden until the commit.
#include "properties/store_transaction.h"

#include <algorithm>

#include "base/check.h"
#include "properties/store.h"

namespace limber {

void Store::begin_transaction() {
  LIMBER_CHECK(!transaction_.active);
  transaction_.active = true;
  transaction_.number++;
  transaction_.values.clear();
  transaction_.notifications.clear();
  transaction_.dirty_before = state_.dirty_nodes.size();
}

void Store::commit_transaction() {
  transaction_.active = false;
  if (listener_.callback == nullptr) return;
  for (const StoreTransaction::Notification& notification : transaction_.notifications) {
    if (alive(notification.id))
      listener_.callback(listener_.context, notification.id, *notification.property, false,
                         notification.previous.data());
  }
}

// Listeners are notified on commit only, since a rollback reverts the writes.
void Store::defer_notification(NodeId id, const Property& property) {
  StoreTransaction::Saved& saved = saved_in_transaction(id);
  const std::uint64_t bit = std::uint64_t{1} << property.index;
  if ((saved.notifications & bit) != 0) return;
  saved.notifications |= bit;
  StoreTransaction::Notification& notification =
      transaction_.notifications.emplace_back(StoreTransaction::Notification{id, &property, {}});
  std::copy_n(values(id, property), property.width, notification.previous.begin());
}

StoreTransaction::Saved& Store::saved_in_transaction(NodeId id) {
  if (transaction_.saved.size() <= id.slot) transaction_.saved.resize(slots_.size());
  StoreTransaction::Saved& saved = transaction_.saved[id.slot];
  if (saved.transaction != transaction_.number) saved = {transaction_.number, 0, 0};
  return saved;
}

void Store::save_value(NodeId id, const Property& property) {
  if (!alive(id) || !property.stored()) return;
  StoreTransaction::Saved& saved = saved_in_transaction(id);
  const std::uint64_t bit = std::uint64_t{1} << property.index;
  if ((saved.values & bit) != 0) return;
  saved.values |= bit;
  StoreTransaction::Value value{id, &property, {}, (nodes_[id.slot].dirty & bit) != 0};
  std::copy_n(slot_values(id, property), property.width, value.previous.begin());
  transaction_.values.push_back(value);
}

void Store::rollback() {
  transaction_.active = false;
  for (auto value = transaction_.values.rbegin(); value != transaction_.values.rend(); ++value) {
    if (!alive(value->id)) continue;  // added and removed within the transaction
    const Property& property = *value->property;
    std::copy_n(value->previous.begin(), property.width, slot_values(value->id, property));
    if (!property.transient) persistent_version_++;
    const std::uint64_t bit = std::uint64_t{1} << property.index;
    std::uint64_t& dirty = nodes_[value->id.slot].dirty;
    // A callback that ran meanwhile runs again with the old value; the owner restores transient ones (poses, speeds).
    const bool flushed = (dirty & bit) == 0;
    if (value->was_dirty || (flushed && !property.transient)) {
      mark_dirty(value->id, property);
    } else {
      dirty &= ~bit;
    }
  }
  // Callbacks run in the order in which nodes became dirty, so nodes that are no longer dirty must leave the list.
  const auto first = state_.dirty_nodes.begin() +
                     static_cast<std::ptrdiff_t>(std::min(transaction_.dirty_before, state_.dirty_nodes.size()));
  state_.dirty_nodes.erase(std::remove_if(first, state_.dirty_nodes.end(),
                                          [&](NodeId id) { return !alive(id) || nodes_[id.slot].dirty == 0; }),
                           state_.dirty_nodes.end());
}

void Store::set_hidden(NodeId id, bool hidden) {
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

std::size_t Store::hide(NodeId id) {
  LIMBER_CHECK(alive(id) && id != root_);
  const std::size_t position = unlink_from_parent(id);
  set_hidden(id, true);
  persistent_version_++;
  bump_structure_version();
  return position;
}

void Store::show(NodeId id, std::size_t position) {
  bump_structure_version();
  set_hidden(id, false);
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  siblings.insert(siblings.begin() + static_cast<std::ptrdiff_t>(std::min(position, siblings.size())), id);
  persistent_version_++;
}

void Store::remove_hidden(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) remove_hidden(child);
  free_slot(id.slot);
}

}  // namespace limber
