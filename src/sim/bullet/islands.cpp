// Islands: found by union-find, and sorted by counting.
#include "sim/bullet/islands.h"

#include <algorithm>

#include "sim/collision/dispatcher.h"

namespace limber::sim::bullet {
namespace {

/// A batch is complete with this many bodies; results don't depend on it.
constexpr int kBatchBodies = 64;
/// Number of manifolds to prefetch ahead.
constexpr int kManifoldsAhead = 8;

// Turns counts per island in start[1..] into start indices and copies them to cursor.
void to_start_indices(btAlignedObjectArray<int>& start, btAlignedObjectArray<int>& cursor) {
  for (int i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  cursor.copyFromArray(start);
}

void fill_with_zeros(btAlignedObjectArray<int>& a, int size) {
  a.resizeNoInitialize(size);
  for (int i = 0; i < size; ++i) a[i] = 0;
}

}  // namespace

void Islands::find(const AwakeObjects& awake, const btBroadphasePairArray& overlapping) {
  connected_.assign(awake.joined());
  for (int i = 0; i < overlapping.size(); ++i) {
    const auto index_of = [&](const btBroadphaseProxy* proxy) {
      return awake.index_of(*static_cast<const btCollisionObject*>(proxy->m_clientObject));
    };
    connected_.unite(index_of(overlapping[i].m_pProxy0), index_of(overlapping[i].m_pProxy1));
  }
  sort_bodies(awake);
  sort_joints(awake);
}

void Islands::sort_bodies(const AwakeObjects& awake) {
  const int count = awake.bodies().size();
  island_of_root_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) island_of_root_[i] = -1;
  island_.resizeNoInitialize(count);
  count_ = 0;
  fill_with_zeros(body_start_, count + 1);
  for (int i = 0; i < count; ++i) {
    int& island = island_of_root_[connected_.root(i)];
    if (island < 0) island = count_++;
    island_[i] = island;
    ++body_start_[island + 1];
  }
  body_start_.resizeNoInitialize(count_ + 1);
  to_start_indices(body_start_, cursor_);
  bodies_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) bodies_[cursor_[island_[i]]++] = awake.bodies()[i];
}

void Islands::sort_joints(const AwakeObjects& awake) {
  const int count = awake.joints().size();
  fill_with_zeros(joint_start_, count_ + 1);
  for (int i = 0; i < count; ++i) {
    if (const int body = awake.body_of_joint(i); body >= 0) ++joint_start_[island_[body] + 1];
  }
  to_start_indices(joint_start_, cursor_);
  joints_.resizeNoInitialize(joint_start_[count_]);
  static_joints_.resizeNoInitialize(0);
  for (int i = 0; i < count; ++i) {
    if (const int body = awake.body_of_joint(i); body >= 0) {
      joints_[cursor_[island_[body]]++] = awake.joints()[i];
    } else {
      static_joints_.push_back(awake.joints()[i]);
    }
  }
}

void Islands::find_contacts(const AwakeObjects& awake, btDispatcher& dispatcher) {
  ordered_manifolds_.resizeNoInitialize(0);
  const int manifolds = dispatcher.getNumManifolds();
  for (int i = 0; i < manifolds; ++i) {
    if (i + kManifoldsAhead < manifolds)
      collision::prefetch_end(*dispatcher.getManifoldByIndexInternal(i + kManifoldsAhead));
    btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() == 0) continue;
    const btCollisionObject* a = manifold->getBody0();
    const btCollisionObject* b = manifold->getBody1();
    const int index = std::max(awake.index_of(*a), awake.index_of(*b));
    if (index < 0 || !dispatcher.needsResponse(a, b)) continue;
    ordered_manifolds_.push_back(
        {island_[index], a->getBroadphaseHandle()->m_uniqueId, b->getBroadphaseHandle()->m_uniqueId, manifold});
  }
  // Bullet's order of manifolds depends on the history of all islands; the age of the parts doesn't
  const int count = ordered_manifolds_.size();
  if (count > 1) {
    std::sort(&ordered_manifolds_[0], &ordered_manifolds_[0] + count,
              [](const OrderedManifold& x, const OrderedManifold& y) {
                if (x.island != y.island) return x.island < y.island;
                return x.first != y.first ? x.first < y.first : x.second < y.second;
              });
  }
  fill_with_zeros(contact_start_, count_ + 1);
  contacts_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    contacts_[i] = ordered_manifolds_[i].manifold;
    ++contact_start_[ordered_manifolds_[i].island + 1];
  }
  to_start_indices(contact_start_, cursor_);
}

void Islands::make_batches(int min_constraints, bool separate) {
  batches_.resizeNoInitialize(0);
  batches_.push_back(0);
  for (int last = 1; last <= count_; ++last) {
    const int first = batches_[batches_.size() - 1];
    const int joints = joint_start_[last] - joint_start_[first];
    const int contacts = contact_start_[last] - contact_start_[first];
    const bool one_island = separate && (joints + contacts > 0 || (last < count_ && is_constrained(last)));
    const int bodies = body_start_[last] - body_start_[first];
    if (one_island || joints + contacts >= min_constraints || bodies >= kBatchBodies || last == count_)
      batches_.push_back(last);
  }
}

Islands::Batch Islands::batch(int index) const {
  const int first = batches_[index];
  const int last = batches_[index + 1];
  const auto range = [&](const btAlignedObjectArray<int>& start) {
    return Range{start[first], start[last] - start[first]};
  };
  int constrained = 0;
  for (int island = first; island < last; ++island) constrained += is_constrained(island) ? 1 : 0;
  return {range(body_start_), range(joint_start_), range(contact_start_), last - first, constrained};
}

}  // namespace limber::sim::bullet
