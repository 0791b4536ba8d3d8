// PairAlgorithm: base class of the contact algorithms.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// Base class: owns the manifold of a pair.
class PairAlgorithm : public btCollisionAlgorithm {
 public:
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                const btCollisionObjectWrapper* b)
      : btCollisionAlgorithm(info),
        manifold_(info.m_dispatcher1->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {}
  ~PairAlgorithm() override { m_dispatcher->releaseManifold(manifold_); }
  PairAlgorithm(const PairAlgorithm&) = delete;
  PairAlgorithm& operator=(const PairAlgorithm&) = delete;

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override { manifolds.push_back(manifold_); }

 protected:
  btPersistentManifold& manifold() { return *manifold_; }

 private:
  btPersistentManifold* manifold_;
};

}  // namespace limber::sim::collision
