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
  undo_.set.clear();
  undo_.marked_before = marked_.size();
}

void Store::end_undo() {
  undo_.active = false;
  if (listener_.heard == nullptr) return;
  for (const StoreUndo::Set& set : undo_.set) {
    if (alive(set.id)) listener_.heard(listener_.who, set.id, *set.row, false, set.before.data());
  }
}

// what a call sets that fails was never set: nobody hears of it before its end
void Store::hear_later(NodeId id, const Row& row) {
  StoreUndo::Kept& kept = kept_of(id);
  const std::uint64_t bit = std::uint64_t{1} << row.index;
  if ((kept.set & bit) != 0) return;
  kept.set |= bit;
  StoreUndo::Set& set = undo_.set.emplace_back(StoreUndo::Set{id, &row, {}});
  std::copy_n(values(id, row), row.width, set.before.begin());
}

StoreUndo::Kept& Store::kept_of(NodeId id) {
  if (undo_.kept.size() <= id.slot) undo_.kept.resize(slots_.size());
  StoreUndo::Kept& kept = undo_.kept[id.slot];
  if (kept.call != undo_.call) kept = {undo_.call, 0, 0};
  return kept;
}

void Store::keep_value(NodeId id, const Row& row) {
  if (!alive(id) || !row.stored()) return;
  StoreUndo::Kept& kept = kept_of(id);
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
    nodes_[id.slot].changed = structure_version_;  // it was not there meanwhile
  }
  for (const NodeId child : nodes_[id.slot].children) turn_hidden(child, hide);
}

std::size_t Store::hide(NodeId id) {
  LIMBER_CHECK(alive(id) && id != root_);
  const std::size_t place = leave_siblings(id);
  turn_hidden(id, true);
  kept_version_++;
  note_change(id);
  return place;
}

void Store::show(NodeId id, std::size_t place) {
  note_change(id);
  turn_hidden(id, false);
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  siblings.insert(siblings.begin() + static_cast<std::ptrdiff_t>(std::min(place, siblings.size())), id);
  kept_version_++;
}

void Store::drop_hidden(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) drop_hidden(child);
  give_back(id.slot);
}

}  // namespace limber
