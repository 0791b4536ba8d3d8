// Data of a pair is reached through chains of pointers, so it is prefetched in three stages, each of which reads data
// that the previous one fetched.
#include "sim/collision/dispatcher.h"

#include "sim/collision/manifold_builder.h"

namespace limber::sim::collision {
namespace {

/// Prefetch distances of the stages, in pairs.
constexpr int kHandlesAhead = 16;
constexpr int kBodiesAhead = 10;
constexpr int kContactsAhead = 5;

btCollisionObject& object(const btBroadphaseProxy& proxy) {
  return *static_cast<btCollisionObject*>(proxy.m_clientObject);
}

[[gnu::always_inline]] inline void prefetch_handles(const btBroadphasePair& pair) {
  prefetch(pair.m_pProxy0, 1);
  prefetch(pair.m_pProxy1, 1);
  prefetch(pair.m_algorithm, sizeof(btCollisionAlgorithm) + 2 * sizeof(void*));
}

[[gnu::always_inline]] inline void prefetch_bodies(const btBroadphasePair& pair, btManifoldArray& manifolds) {
  constexpr std::size_t kUsed = 480;  // of a body: pose, shape, properties, velocity
  prefetch(&object(*pair.m_pProxy0), kUsed);
  prefetch(&object(*pair.m_pProxy1), kUsed);
  manifolds.resizeNoInitialize(0);
  if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(manifolds);
  for (int i = 0; i < manifolds.size(); ++i) prefetch_end(*manifolds[i]);
}

[[gnu::always_inline]] inline void prefetch_contact_data(const btBroadphasePair& pair, btManifoldArray& manifolds) {
  prefetch(object(*pair.m_pProxy0).getCollisionShape(), sizeof(btBoxShape));
  prefetch(object(*pair.m_pProxy1).getCollisionShape(), sizeof(btBoxShape));
  manifolds.resizeNoInitialize(0);
  if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(manifolds);
  for (int i = 0; i < manifolds.size(); ++i) prefetch_points(*manifolds[i]);
}

}  // namespace

// Collects pairs with at least one awake object. Other pairs retain their contacts.
void Dispatcher::find_awake(btBroadphasePairArray& pairs) {
  awake_.resizeNoInitialize(0);
  for (int i = 0; i < pairs.size(); ++i) {
    if (sleeping_ && i + kHandlesAhead < pairs.size()) {
      prefetch(pairs[i + kHandlesAhead].m_pProxy0, 1);
      prefetch(pairs[i + kHandlesAhead].m_pProxy1, 1);
    }
    if (sleeping_ && !object(*pairs[i].m_pProxy0).isActive() && !object(*pairs[i].m_pProxy1).isActive()) continue;
    awake_.push_back(&pairs[i]);
  }
}

Dispatcher::Dispatcher(btCollisionConfiguration* configuration) : btCollisionDispatcher(configuration) {
  algorithms_.install(*this);
}

void Dispatcher::find_contacts(btBroadphasePair& pair, const btDispatcherInfo& info) {
  btCollisionObject& first = object(*pair.m_pProxy0);
  btCollisionObject& second = object(*pair.m_pProxy1);
  const btCollisionObjectWrapper a(nullptr, first.getCollisionShape(), &first, first.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper b(nullptr, second.getCollisionShape(), &second, second.getWorldTransform(), -1, -1);
  if (pair.m_algorithm == nullptr) pair.m_algorithm = findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  if (pair.m_algorithm == nullptr) return;
  ContactResult result(&a, &b);
  pair.m_algorithm->processCollision(&a, &b, info, &result);
}

void Dispatcher::dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info, btDispatcher*) {
  find_awake(cache->getOverlappingPairArray());
  const int count = awake_.size();
  processed_pairs_ += static_cast<std::uint64_t>(count);
  for (int i = 0; i < count; ++i) {
    if (i + kHandlesAhead < count) prefetch_handles(*awake_[i + kHandlesAhead]);
    if (i + kBodiesAhead < count) prefetch_bodies(*awake_[i + kBodiesAhead], manifolds_);
    if (i + kContactsAhead < count) prefetch_contact_data(*awake_[i + kContactsAhead], manifolds_);
    find_contacts(*awake_[i], info);
  }
}

}  // namespace limber::sim::collision
