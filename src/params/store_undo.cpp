// The store's log of a guarded call, and nodes that are hidden until the call has ended well.
#include "params/store_undo.h"

#include <algorithm>

#include "base/check.h"
#include "params/store.h"

namespace limber {

void Store::begin_undo() {
  LIMBER_CHECK(!undo_.active);
  undo_.active = true;
  undo_.call++;
  undo_.values.clear();
  undo_.marked_before = marked_.size();
}

void Store::end_undo() { undo_.active = false; }

void Store::keep_value(NodeId id, const Row& row) {
  if (!alive(id) || !row.stored()) return;
  if (undo_.kept.size() <= id.slot) undo_.kept.resize(slots_.size());
  StoreUndo::Kept& kept = undo_.kept[id.slot];
  if (kept.call != undo_.call) kept = {undo_.call, 0};
  const std::uint64_t bit = std::uint64_t{1} << row.index;
  if ((kept.rows & bit) != 0) return;
  kept.rows |= bit;
  StoreUndo::Value value{id, &row, {}, (nodes_[id.slot].marks & bit) != 0};
  std::copy_n(slot_values(id, row), row.width, value.before.begin());
  undo_.values.push_back(value);
}

void Store::take_back() {
  undo_.active = false;
  for (auto value = undo_.values.rbegin(); value != undo_.values.rend(); ++value) {
    if (!alive(value->id)) continue;  // made in the call, and gone again
    const Row& row = *value->row;
    std::copy_n(value->before.begin(), row.width, slot_values(value->id, row));
    if (!row.live) kept_version_++;
    const std::uint64_t bit = std::uint64_t{1} << row.index;
    std::uint64_t& marks = nodes_[value->id.slot].marks;
    // an effect that ran meanwhile runs again with the old value; of live ones (poses, speeds) the owner undoes it
    const bool ran = (marks & bit) == 0;
    if (value->marked || (ran && !row.live)) {
      mark(value->id, row);
    } else {
      marks &= ~bit;
    }
  }
  // effects run in the order in which nodes were marked: what is no longer marked must not hold a place
  const auto first = marked_.begin() + static_cast<std::ptrdiff_t>(std::min(undo_.marked_before, marked_.size()));
  marked_.erase(
      std::remove_if(first, marked_.end(), [&](NodeId id) { return !alive(id) || nodes_[id.slot].marks == 0; }),
      marked_.end());
}

void Store::turn_hidden(NodeId id, bool hide) {
  NodeSlot& slot = slots_[id.slot];
  if (hide) {
    child_of_.erase(child_of_.find(id.slot));
    slot.generation++;  // odd to even: gone for everyone who asks
  } else {
    slot.generation--;
    child_of_.insert(id.slot);
  }
  for (const NodeId child : nodes_[id.slot].children) turn_hidden(child, hide);
}

std::size_t Store::hide(NodeId id) {
  LIMBER_CHECK(alive(id) && id != root_);
  const std::size_t place = leave_siblings(id);
  turn_hidden(id, true);
  kept_version_++;
  structure_version_++;
  return place;
}

void Store::show(NodeId id, std::size_t place) {
  turn_hidden(id, false);
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  siblings.insert(siblings.begin() + static_cast<std::ptrdiff_t>(std::min(place, siblings.size())), id);
  kept_version_++;
  structure_version_++;
}

void Store::drop_hidden(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) drop_hidden(child);
  give_back(id.slot);
}

}  // namespace limber
