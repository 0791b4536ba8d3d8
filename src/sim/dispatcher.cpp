// Data of a pair is reached through chains of pointers, so it is prefetched in three stages, each when the one before
// has arrived.
#include "sim/dispatcher.h"

#include "sim/contact_manifold.h"

namespace limber {
namespace {

/// So many pairs ahead each go is made.
constexpr int kHandles = 16;
constexpr int kParts = 10;
constexpr int kPoints = 5;

btCollisionObject& object(const btBroadphaseProxy& proxy) {
  return *static_cast<btCollisionObject*>(proxy.m_clientObject);
}

[[gnu::always_inline]] inline void ask_for_handles(const btBroadphasePair& pair) {
  prefetch(pair.m_pProxy0, 1);
  prefetch(pair.m_pProxy1, 1);
  prefetch(pair.m_algorithm, sizeof(btCollisionAlgorithm) + 2 * sizeof(void*));
}

[[gnu::always_inline]] inline void ask_for_parts(const btBroadphasePair& pair, btManifoldArray& manifolds) {
  constexpr std::size_t kUsed = 480;  // of a body: where it is, its shape, what it is like, its velocity
  prefetch(&object(*pair.m_pProxy0), kUsed);
  prefetch(&object(*pair.m_pProxy1), kUsed);
  manifolds.resizeNoInitialize(0);
  if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(manifolds);
  for (int i = 0; i < manifolds.size(); ++i) prefetch_end(*manifolds[i]);
}

[[gnu::always_inline]] inline void ask_for_points(const btBroadphasePair& pair, btManifoldArray& manifolds) {
  prefetch(object(*pair.m_pProxy0).getCollisionShape(), sizeof(btBoxShape));
  prefetch(object(*pair.m_pProxy1).getCollisionShape(), sizeof(btBoxShape));
  manifolds.resizeNoInitialize(0);
  if (pair.m_algorithm != nullptr) pair.m_algorithm->getAllContactManifolds(manifolds);
  for (int i = 0; i < manifolds.size(); ++i) prefetch_points(*manifolds[i]);
}

}  // namespace

// Pairs of which at least one object is awake. What sleeps or is static keeps the contacts that it has.
void Dispatcher::find_awake(btBroadphasePairArray& pairs) {
  awake_.resizeNoInitialize(0);
  for (int i = 0; i < pairs.size(); ++i) {
    if (some_sleep_ && i + kHandles < pairs.size()) {
      prefetch(pairs[i + kHandles].m_pProxy0, 1);
      prefetch(pairs[i + kHandles].m_pProxy1, 1);
    }
    if (some_sleep_ && !object(*pairs[i].m_pProxy0).isActive() && !object(*pairs[i].m_pProxy1).isActive()) continue;
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
  looked_at_ += static_cast<std::uint64_t>(count);
  for (int i = 0; i < count; ++i) {
    if (i + kHandles < count) ask_for_handles(*awake_[i + kHandles]);
    if (i + kParts < count) ask_for_parts(*awake_[i + kParts], manifolds_);
    if (i + kPoints < count) ask_for_points(*awake_[i + kPoints], manifolds_);
    find_contacts(*awake_[i], info);
  }
}

}  // namespace limber
