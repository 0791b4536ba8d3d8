// Value snapshots: persistent values are copied as a block; computed values and texts are read one by one.
#include "engine/output/value_snapshotter.h"

#include <algorithm>
#include <utility>

namespace limber::engine {

void ValueSnapshotter::note_write(const Store& store, const CommandOrigin& origin, const PropertyRef& ref,
                                  bool clamped) {
  // search only the most recent writes: a moving slider sets the same property again and again
  constexpr std::ptrdiff_t kLookBack = 8;
  const auto recent = writes_.end() - std::min(kLookBack, std::distance(writes_.begin(), writes_.end()));
  const auto same = std::find_if(recent, writes_.end(), [&](const PendingWrite& pending) {
    return pending.write.node == ref.node && pending.write.property == ref.property && pending.write.origin == origin;
  });
  if (same != writes_.end()) writes_.erase(same);
  if (writes_.size() >= kMaxWrites) writes_.erase(writes_.begin(), writes_.begin() + kMaxWrites / 4);
  PendingWrite& pending = writes_.emplace_back();
  pending.made_at = made_;
  pending.write = {++write_count_, origin, ref.node, ref.property, {}, clamped};
  store.get(ref.node, *ref.property, pending.write.values.data());
}

bool ValueSnapshotter::make(const Store& store, const std::shared_ptr<const Snapshot>& snapshot,
                            std::uint64_t requests) {
  if (requests == served_) return false;
  if (now_() < next_) return false;
  const double begin = cpu_time_();
  if (tree_ == nullptr || structure_version_ != store.structure_version()) {
    tree_ = std::make_shared<const TreeSnapshot>(store);
    structure_version_ = store.structure_version();
  }
  std::erase_if(writes_, [&](const PendingWrite& pending) { return made_ >= pending.made_at + kWriteLifetime; });
  const std::shared_ptr<ValueSnapshot> out = out_.acquire_buffer();
  out->number = ++made_;
  out->request = served_ = requests;
  out->tree = tree_;
  out->snapshot = snapshot;
  out->persistent.assign(store.persistent_values().begin(), store.persistent_values().end());
  fill_computed(store, *out);
  out->writes.clear();
  for (const PendingWrite& pending : writes_) out->writes.push_back(pending.write);
  out_.publish(out);
  const double cost = cpu_time_() - begin;
  next_ = now_() + cost * (1 / kMaxShare - 1);
  return true;
}

void ValueSnapshotter::reset_store() {
  tree_ = nullptr;
  writes_.clear();
}

void ValueSnapshotter::fill_computed(const Store& store, ValueSnapshot& snapshot) const {
  snapshot.computed.resize(tree_->computed_width());
  snapshot.texts.resize(tree_->text_count());
  double* out = snapshot.computed.data();
  auto text = snapshot.texts.begin();
  for (const TreeSnapshot::Node& node : tree_->nodes()) {
    const void* const object = store.object(node.id);
    for (const Property& property : node.table->properties()) {
      if (property.type == PropertyType::text) *text++ = property.read_text(object);
      if (!property.computed()) continue;
      property.read(object, out);
      out += property.width;
    }
  }
}

}  // namespace limber::engine
