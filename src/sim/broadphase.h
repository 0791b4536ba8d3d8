// Broadphase: which objects come so near to each other that contacts are looked for.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/team.h"
#include "sim/bullet.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

namespace limber {

/// Bullet's trees of bounding boxes, one for what stands and one or, with a team, some for what moves, and Bullet's
/// table of pairs. Which boxes meet does not depend on the trees. Only pairs that may collide are in the table: neither
/// objects of one group, nor those that a joint keeps from colliding. A plane is in no tree, since its box is
/// everything: it meets what comes as near to it as a contact can begin. Pairs are found once a step, in
/// calculateOverlappingPairs, around what left its box or was looked at anew. All that it remembers lies in the memory
/// of the BulletMemory::Scope that it is used in. [sim]
class Broadphase : public btBroadphaseInterface {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// Metres that the boxes of what moves are larger: so far it moves before its neighbours are looked for again;
  /// those of what is alone reach ahead of it besides.
  /// `team`, which may be null, looks for pairs side by side, and moves boxes: each member those of a tree.
  Broadphase(double margin, Team* team);
  ~Broadphase() override;
  Broadphase(const Broadphase&) = delete;
  Broadphase& operator=(const Broadphase&) = delete;

  /// Who may collide with this one has changed: from the next step on its pairs are those that may.
  void look_anew(btBroadphaseProxy* proxy);

  /// Has this one left its box, or was it moved though it stands? Then leave() is to follow. `h`: the step's length, s;
  /// a box reaches as far as its object will move in the step. [any thread, each another]
  static bool look(btCollisionObject& object, btScalar h);
  /// Soon look() will be asked about it.
  static void fetch(const btCollisionObject& object);
  /// These have.
  void leave(std::span<btBroadphaseProxy* const> proxies);

  btBroadphaseProxy* createProxy(const btVector3& low, const btVector3& high, int shape, void* object, int group,
                                 int mask, btDispatcher* dispatcher) override;
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
  void setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high,
               btDispatcher* dispatcher) override;
  void getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const override;
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

  btOverlappingPairCache* getOverlappingPairCache() override { return &pairs_; }
  const btOverlappingPairCache* getOverlappingPairCache() const override { return &pairs_; }

  /// All whose boxes meet the ray's own box, and all planes.
  void rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback, const btVector3& low,
               const btVector3& high) override;
  void aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) override;
  /// Around everything but planes.
  void getBroadphaseAabb(btVector3& low, btVector3& high) const override;
  void printStats() override {}

 private:
  struct Proxy;

  static constexpr int kMostTrees = 8;

  struct Search;  // what is found around some of those that are marked

  btDbvt& tree_of(const Proxy& proxy);
  void move(Proxy& proxy);
  void make_room(int marked);
  void mark(Proxy& proxy);
  void search(int first, int end, Search& search) const;
  void search_around(Proxy& proxy, Search& search) const;
  void forget_parted(btDispatcher* dispatcher);

  btScalar margin_;
  std::array<btDbvt, kMostTrees> moving_;  // the first trees_ of them
  btDbvt standing_;
  btAlignedObjectArray<Proxy*> planes_;
  btAlignedObjectArray<Proxy*> marked_;  // whose neighbours are to be looked for; null: gone since
  btHashedOverlappingPairCache pairs_;
  int last_id_ = 0;
  int count_ = 0;
  Team* team_;
  int trees_;
  // on the heap, and nothing that outlives a step
  std::unique_ptr<std::vector<Search>> searches_;
};

}  // namespace limber
