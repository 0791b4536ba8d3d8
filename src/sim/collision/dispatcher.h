// Dispatcher: finds the contact points of all overlapping pairs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/memory/prefetch.h"
#include "sim/bullet/bullet.h"
#include "sim/collision/contact_algorithms.h"

namespace limber::sim::collision {

/// Prefetches the end of a manifold, which holds the number of points and the objects.
[[gnu::always_inline]] inline void prefetch_end(const btPersistentManifold& manifold) {
  constexpr std::size_t kEnd = 64;
  prefetch(reinterpret_cast<const char*>(&manifold + 1) - kEnd, kEnd);
}

/// Prefetches the points of a manifold. Reads its end.
[[gnu::always_inline]] inline void prefetch_points(const btPersistentManifold& manifold) {
  prefetch(&manifold, static_cast<std::size_t>(manifold.getNumContacts()) * sizeof(btManifoldPoint));
}

/// Bullet's dispatcher with our contact algorithms. All pairs in the cache may collide: filters are applied when pairs
/// are created. Prefetches the data of the next pairs while one is processed: a pair has two parts, two shapes and a
/// kilobyte of contact points, which are not in the cache in a large scene. [sim]
class Dispatcher : public btCollisionDispatcher {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  explicit Dispatcher(btCollisionConfiguration* configuration);

  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return true; }
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

  /// Sets whether some objects may be asleep; then pairs without an awake object are skipped.
  void set_sleeping(bool some) { sleeping_ = some; }
  /// Number of pairs whose contacts were searched since the start.
  std::uint64_t processed_pairs() const { return processed_pairs_; }

 private:
  void find_awake(btBroadphasePairArray& pairs);
  void find_contacts(btBroadphasePair& pair, const btDispatcherInfo& info);

  ContactAlgorithms algorithms_;
  bool sleeping_ = false;
  std::uint64_t processed_pairs_ = 0;
  btAlignedObjectArray<btBroadphasePair*> awake_;  // scratch
  btManifoldArray manifolds_;                      // of one pair
};

}  // namespace limber::sim::collision
