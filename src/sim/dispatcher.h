// Dispatcher: goes through the pairs that may touch, and has their contact points found.
#pragma once

#include <cstddef>

#include "base/prefetch.h"
#include "sim/bullet.h"

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

/// Bullet's, but that a pair which was made may collide, and that what a pair is about to look at is asked for while
/// those before it are at work: a pair has two parts, two shapes and a kilobyte of contact points, which a large scene
/// has thrown out of the caches since the last step. [sim]
class Dispatcher : public btCollisionDispatcher {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  using btCollisionDispatcher::btCollisionDispatcher;

  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return true; }
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

 private:
  btManifoldArray manifolds_;  // of one pair
};

}  // namespace limber
