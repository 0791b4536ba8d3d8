// Broadphase: finds pairs of objects that are near enough for contacts.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/threads/thread_pool.h"
#include "sim/bullet/bullet.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

namespace limber::sim::collision {

/// Dynamic bounding volume trees of Bullet (btDbvt): one of static objects and one, or several with a thread pool, of
/// moving objects; and Bullet's pair cache. The pairs found don't depend on the trees. The cache contains only pairs
/// that may collide: not those excluded by filters or joints. A plane is in no tree, since its box is unbounded: it
/// pairs with objects within contact distance. Pairs are updated once per step, in calculateOverlappingPairs(), around
/// objects that left their fattened box or were marked by update_pairs(). Persistent data is allocated in the memory of
/// the present BulletMemory::Scope. [sim]
class Broadphase : public btBroadphaseInterface {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// `margin`: m by which boxes of moving objects are fattened; boxes without neighbors are also extended along the
  /// motion. `thread_pool`: threads for searching pairs and updating trees, or null.
  Broadphase(double margin, ThreadPool* thread_pool);
  ~Broadphase() override;
  Broadphase(const Broadphase&) = delete;
  Broadphase& operator=(const Broadphase&) = delete;

  /// Updates the pairs of an object in the next step, after its permission to collide with others has changed.
  void update_pairs(btBroadphaseProxy* proxy);

  /// Computes the AABB of an object again, including its motion in a step of `h` s. Returns true if the object left its
  /// fattened AABB, or is static and was moved; update_aabbs() must be called with it then. [any thread, a different
  /// object each]
  static bool refit_aabb(btCollisionObject& object, btScalar h);
  /// Prefetches memory for refit_aabb().
  static void prefetch_proxy(const btCollisionObject& object);
  /// Updates the fattened AABBs of objects for which refit_aabb() returned true.
  void update_aabbs(std::span<btBroadphaseProxy* const> proxies);

  btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int shape, void* object, int group,
                                 int mask, btDispatcher* dispatcher) override;
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
  void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
               btDispatcher* dispatcher) override;
  void getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const override;
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

  btOverlappingPairCache* getOverlappingPairCache() override { return &pairs_; }
  const btOverlappingPairCache* getOverlappingPairCache() const override { return &pairs_; }

  /// True if filters and joints permit two objects to collide.
  static bool may_collide(const btCollisionObject& a, const btCollisionObject& b);
  /// Appends the objects that may collide with this one and whose fattened boxes overlap an AABB, and the planes near
  /// it, in no particular order. `stack`: scratch.
  void find_collidable(const btCollisionObject& object, const btVector3& low, const btVector3& high,
                       std::vector<const btDbvtNode*>& stack, std::vector<btCollisionObject*>& found) const;

  /// Calls back for all objects whose boxes overlap the ray's AABB, and all planes.
  void rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback, const btVector3& low,
               const btVector3& high) override;
  void aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) override;
  /// AABB of everything except planes.
  void getBroadphaseAabb(btVector3& low, btVector3& high) const override;
  void printStats() override {}

 private:
  struct Proxy;

  static constexpr int kMaxTrees = 8;

  struct SearchTask;  // pairs found around a range of marked_

  btDbvt& tree_of(const Proxy& proxy);
  void move(Proxy& proxy);
  void reserve_searches(int marked);
  void mark_for_search(Proxy& proxy);
  void search(int first, int end, SearchTask& search) const;
  void search_around(Proxy& proxy, SearchTask& search) const;
  void remove_stale_pairs(btDispatcher* dispatcher);

  btScalar margin_;
  std::array<btDbvt, kMaxTrees> moving_;  // the first tree_count_ of them are used
  btDbvt static_;
  btAlignedObjectArray<Proxy*> planes_;
  btAlignedObjectArray<Proxy*> marked_;  // objects whose pairs must be searched; null: removed since
  btHashedOverlappingPairCache pairs_;
  int last_id_ = 0;
  int count_ = 0;
  ThreadPool* thread_pool_;
  int tree_count_;
  // on the heap; its content lives for one step only
  std::unique_ptr<std::vector<SearchTask>> searches_;
};

}  // namespace limber::sim::collision
