// Dispatcher: goes through the pairs that may touch, and has their contact points found.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/prefetch.h"
#include "sim/bullet.h"
#include "sim/contact_algorithms.h"

namespace limber {

/// Asks for what a manifold says last: how many points it has, and of which parts.
[[gnu::always_inline]] inline void prefetch_end(const btPersistentManifold& manifold) {
  constexpr std::size_t kEnd = 64;
  prefetch(reinterpret_cast<const char*>(&manifold + 1) - kEnd, kEnd);
}

/// Asks for its points. Reads its end.
[[gnu::always_inline]] inline void prefetch_points(const btPersistentManifold& manifold) {
  prefetch(&manifold, static_cast<std::size_t>(manifold.getNumContacts()) * sizeof(btManifoldPoint));
}

/// Bullet's dispatcher with contact algorithms of our own. Pairs that exist may collide: filters apply when pairs are
/// made. Prefetches the data of the next pairs while one is processed: a pair has two parts, two shapes and a kilobyte
/// of contact points, which are no longer in the cache in a large scene. [sim]
class Dispatcher : public btCollisionDispatcher {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  explicit Dispatcher(btCollisionConfiguration* configuration);

  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return true; }
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

  /// Whether to look for what sleeps: pairs of which no object is awake are left out.
  void set_some_sleep(bool some) { some_sleep_ = some; }
  /// Pairs whose contacts were looked for, since the start.
  std::uint64_t looked_at() const { return looked_at_; }

 private:
  void find_awake(btBroadphasePairArray& pairs);
  void find_contacts(btBroadphasePair& pair, const btDispatcherInfo& info);

  ContactAlgorithms algorithms_;
  bool some_sleep_ = false;
  std::uint64_t looked_at_ = 0;
  btAlignedObjectArray<btBroadphasePair*> awake_;  // scratch
  btManifoldArray manifolds_;                      // of one pair
};

}  // namespace limber
