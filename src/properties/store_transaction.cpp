// Transactions of the store: the rollback log and deferred notifications.
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
  std::copy_n(mutable_values(id, property), property.width, value.previous.begin());
  transaction_.values.push_back(value);
}

void Store::rollback() {
  transaction_.active = false;
  for (auto value = transaction_.values.rbegin(); value != transaction_.values.rend(); ++value) {
    if (!alive(value->id)) continue;  // added and removed within the transaction
    const Property& property = *value->property;
    write_values(value->id, property, value->previous.data());
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

}  // namespace limber
