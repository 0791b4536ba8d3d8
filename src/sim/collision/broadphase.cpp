// Overlapping boxes are found by tree queries; planes by their distance.
#include "sim/collision/broadphase.h"

#include <algorithm>
#include <utility>

#include "base/memory/prefetch.h"
#include "sim/bullet/collision_filter.h"
#include "sim/bullet/surface_motion.h"

namespace limber::sim::collision {
namespace {

/// Boxes without neighbors are extended along the motion of this many steps, so that objects leave them less often.
/// Near other objects it would cost more, as every overlapping box is a candidate for contacts. Boxes of objects that
/// moved by more than their own size (teleported) are not extended.
constexpr btScalar kExtensionSteps = 2;
/// Largest extension of an AABB along its object's motion in a step, m. Faster objects may tunnel through others.
constexpr btScalar kMaxExtension = 10;
/// Prefetch distances for objects that left their box and for their tree leaves, which another processor may have
/// written.
constexpr std::size_t kProxiesAhead = 8;
constexpr std::size_t kLeavesAhead = 4;
/// Objects per search task; results don't depend on it.
constexpr int kProxiesPerTask = 16;
/// This many consecutively added objects share a tree: they are mostly near each other.
constexpr int kProxiesPerTree = 256;

}  // namespace

struct Broadphase::Proxy : btBroadphaseProxy {
  using btBroadphaseProxy::btBroadphaseProxy;

  btDbvtNode* leaf = nullptr;  // null: a plane
  btDbvtVolume box{};          // copy of the leaf's volume, to avoid a cache miss
  bool moves = false;
  int tree = 0;                   // index in moving_
  bool filter_changed = false;    // since the last search
  bool has_neighbors = false;     // something was found around it in the last search
  int marked_index = 0;           // index in marked_, from 1 on; 0: not marked
  btScalar contact_distance = 0;  // distance from its surface within which contacts begin
  btVector3 motion{0, 0, 0};      // motion of its box in the last step
  btVector3 normal{0, 0, 0};      // of a plane
  btScalar distance = 0;          // of a plane from the origin

  btCollisionObject& object() const { return *static_cast<btCollisionObject*>(m_clientObject); }

  // for planes: updates normal and distance; returns true if they changed
  bool update_plane() {
    const auto& shape = *static_cast<const btStaticPlaneShape*>(object().getCollisionShape());
    const btTransform& pose = object().getWorldTransform();
    const btVector3 before = std::exchange(normal, pose.getBasis() * shape.getPlaneNormal());
    const btScalar distance_before = std::exchange(distance, shape.getPlaneConstant() + normal.dot(pose.getOrigin()));
    return normal != before || distance != distance_before;
  }
  // for planes: distance of the lowest corner of a box
  btScalar height_of(const btDbvtVolume& volume) const {
    return normal.dot(volume.Center()) - distance - normal.absolute().dot(volume.Extents());
  }
  // for planes: true if the other object is within contact distance
  bool near_plane(const Proxy& other) const { return height_of(other.box) <= other.contact_distance; }
  bool overlaps(const Proxy& other) const {
    if (leaf == nullptr) return other.leaf != nullptr && near_plane(other);
    return other.leaf == nullptr ? other.near_plane(*this) : Intersect(box, other.box);
  }
};

// memory is reserved for usual sizes, so that steps don't allocate
struct Broadphase::SearchTask {
  SearchTask() {
    found.reserve(std::size_t{8} * kProxiesPerTask);
    stack.reserve(256);
  }
  std::vector<std::pair<Proxy*, Proxy*>> found;
  std::vector<const btDbvtNode*> stack;
};

namespace {

// Calls found() for all proxies in the tree whose boxes overlap this one.
template <class Proxy, class Found>
void query_tree(const btDbvt& tree, const btDbvtVolume& box, std::vector<const btDbvtNode*>& stack, Found&& found) {
  if (tree.m_root == nullptr) return;
  stack.assign(1, tree.m_root);
  while (!stack.empty()) {
    const btDbvtNode* node = stack.back();
    stack.pop_back();
    if (!Intersect(node->volume, box)) continue;
    if (node->isinternal()) {
      prefetch(node->childs[0], sizeof *node);  // the other child is visited first
      stack.push_back(node->childs[0]);
      stack.push_back(node->childs[1]);
    } else {
      found(*static_cast<Proxy*>(node->data));
    }
  }
}

bool proxies_may_collide(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
  if ((a.m_collisionFilterGroup & b.m_collisionFilterMask) == 0) return false;
  if ((b.m_collisionFilterGroup & a.m_collisionFilterMask) == 0) return false;
  const auto& first = *static_cast<const btCollisionObject*>(a.m_clientObject);
  const auto& second = *static_cast<const btCollisionObject*>(b.m_clientObject);
  if (!bullet::CollisionFilter::of(first).accepts(bullet::CollisionFilter::of(second))) return false;
  return first.checkCollideWith(&second) && second.checkCollideWith(&first);
}

// Extends an AABB by the part of the object's motion in the step that exceeds the contact distance, so that contacts
// that begin within the step are found before it.
void extend_along_motion(const btCollisionObject& object, btScalar h, btVector3& low, btVector3& high) {
  if (object.isStaticObject() && !bullet::is_moving_static(object)) return;
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr) return;
  const btVector3 motion = body->getLinearVelocity() * h;
  for (int k = 0; k < 3; k++) {
    if (motion[k] > gContactBreakingThreshold)
      high[k] += std::min(motion[k] - gContactBreakingThreshold, kMaxExtension);
    if (motion[k] < -gContactBreakingThreshold)
      low[k] += std::max(motion[k] + gContactBreakingThreshold, -kMaxExtension);
  }
}

}  // namespace

Broadphase::Broadphase(double margin, ThreadPool* thread_pool)
    : margin_(bullet::to_scalar(margin)),
      thread_pool_(thread_pool),
      tree_count_(thread_pool == nullptr ? 1 : std::min(thread_pool->thread_count(), kMaxTrees)),
      searches_(std::make_unique<std::vector<SearchTask>>()) {}

Broadphase::~Broadphase() = default;

btDbvt& Broadphase::tree_of(const Proxy& proxy) {
  return proxy.moves ? moving_[static_cast<std::size_t>(proxy.tree)] : static_;
}

void Broadphase::mark_for_search(Proxy& proxy) {
  if (proxy.marked_index != 0) return;
  marked_.push_back(&proxy);
  proxy.marked_index = marked_.size();
}

btBroadphaseProxy* Broadphase::createProxy(const btVector3& low, const btVector3& high, int shape, void* object,
                                           int group, int mask, btDispatcher*) {
  auto* proxy = new Proxy(low, high, object, group, mask);
  proxy->m_uniqueId = ++last_id_;
  if (shape == STATIC_PLANE_PROXYTYPE) {
    planes_.push_back(proxy);
    proxy->update_plane();
  } else {
    const btCollisionObject& collision_object = proxy->object();
    proxy->moves = !collision_object.isStaticObject();
    proxy->contact_distance =
        collision_object.getCollisionShape()->getContactBreakingThreshold(gContactBreakingThreshold);
    proxy->box = btDbvtVolume::FromMM(low, high);
    if (proxy->moves) proxy->tree = last_id_ / kProxiesPerTree % tree_count_;
    proxy->leaf = tree_of(*proxy).insert(proxy->box, proxy);
  }
  mark_for_search(*proxy);
  reserve_searches(++count_);
  return proxy;
}

void Broadphase::reserve_searches(int marked) {
  const auto needed = static_cast<std::size_t>(range_count(marked, kProxiesPerTask));
  if (searches_->size() < needed) searches_->resize(needed);
}

void Broadphase::destroyProxy(btBroadphaseProxy* handle, btDispatcher* dispatcher) {
  auto* proxy = static_cast<Proxy*>(handle);
  pairs_.removeOverlappingPairsContainingProxy(proxy, dispatcher);
  if (proxy->marked_index != 0) marked_[proxy->marked_index - 1] = nullptr;
  if (proxy->leaf == nullptr) {
    planes_.remove(proxy);
  } else {
    btDbvt& tree = tree_of(*proxy);
    tree.remove(proxy->leaf);
    // frees the cached node, which would be freed when a leaf is moved: threads of the pool must not free memory
    btAlignedFree(std::exchange(tree.m_free, nullptr));
  }
  delete proxy;
  --count_;
}

void Broadphase::update_pairs(btBroadphaseProxy* handle) {
  auto& proxy = *static_cast<Proxy*>(handle);
  proxy.filter_changed = true;
  mark_for_search(proxy);
}

bool Broadphase::refit_aabb(btCollisionObject& object, btScalar h) {
  if (object.getBroadphaseHandle() == nullptr) return false;
  Proxy& proxy = *static_cast<Proxy*>(object.getBroadphaseHandle());
  if (proxy.leaf == nullptr) return proxy.update_plane();
  btVector3 low;
  btVector3 high;
  object.getCollisionShape()->getAabb(object.getWorldTransform(), low, high);
  const btVector3 contact_margin(gContactBreakingThreshold, gContactBreakingThreshold, gContactBreakingThreshold);
  extend_along_motion(object, h, low, high);
  const btVector3 before = proxy.m_aabbMin + proxy.m_aabbMax;
  proxy.m_aabbMin = low - contact_margin;
  proxy.m_aabbMax = high + contact_margin;
  proxy.motion = (proxy.m_aabbMin + proxy.m_aabbMax - before) / 2;
  const btDbvtVolume box = btDbvtVolume::FromMM(proxy.m_aabbMin, proxy.m_aabbMax);
  return proxy.moves ? !proxy.box.Contain(box) : NotEqual(proxy.box, box);
}

void Broadphase::prefetch_proxy(const btCollisionObject& object) {
  prefetch(object.getBroadphaseHandle(), sizeof(Proxy));
}

void Broadphase::update_aabbs(std::span<btBroadphaseProxy* const> proxies) {
  for (std::size_t i = 0; i < proxies.size(); i++) {
    if (i + kProxiesAhead < proxies.size()) prefetch(proxies[i + kProxiesAhead], sizeof(Proxy));
    mark_for_search(*static_cast<Proxy*>(proxies[i]));
  }
  parallel_for(thread_pool_, tree_count_, [&](int tree, int) {
    for (std::size_t i = 0; i < proxies.size(); i++) {
      if (i + kProxiesAhead < proxies.size()) prefetch(proxies[i + kProxiesAhead], sizeof(Proxy));
      if (i + kLeavesAhead < proxies.size()) {
        prefetch(static_cast<const Proxy*>(proxies[i + kLeavesAhead])->leaf, sizeof(btDbvtNode));
      }
      Proxy& proxy = *static_cast<Proxy*>(proxies[i]);
      if (proxy.tree == tree) move(proxy);
    }
  });
}

void Broadphase::move(Proxy& proxy) {
  if (proxy.leaf == nullptr) return;
  btDbvtVolume box = btDbvtVolume::FromMM(proxy.m_aabbMin, proxy.m_aabbMax);
  if (proxy.moves) {
    const btVector3 size = box.Extents() * 2;
    box.Expand(btVector3(margin_, margin_, margin_));
    const btVector3 overlap = size - proxy.motion.absolute();
    if (!proxy.has_neighbors && overlap[overlap.minAxis()] >= 0) box.SignedExpand(proxy.motion * kExtensionSteps);
  }
  tree_of(proxy).update(proxy.leaf, box);
  proxy.box = box;
}

void Broadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high, btDispatcher*) {
  proxy->m_aabbMin = low;
  proxy->m_aabbMax = high;
  mark_for_search(*static_cast<Proxy*>(proxy));
  move(*static_cast<Proxy*>(proxy));
}

void Broadphase::getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const {
  low = proxy->m_aabbMin;
  high = proxy->m_aabbMax;
}

void Broadphase::search_around(Proxy& proxy, SearchTask& search) const {
  const auto found = [&](Proxy& other) {
    // of two marked objects, the later one finds the pair
    if (&proxy == &other || other.marked_index > proxy.marked_index) return;
    if (proxies_may_collide(proxy, other)) search.found.emplace_back(&proxy, &other);
  };
  if (proxy.leaf == nullptr) {
    for (const btDbvt& tree : moving_) {
      if (tree.m_root == nullptr) continue;
      query_tree<Proxy>(tree, tree.m_root->volume, search.stack, [&](Proxy& other) {
        if (proxy.near_plane(other)) found(other);
      });
    }
    return;
  }
  for (const btDbvt& tree : moving_) query_tree<Proxy>(tree, proxy.box, search.stack, found);
  if (!proxy.moves) return;
  query_tree<Proxy>(static_, proxy.box, search.stack, found);
  for (int i = 0; i < planes_.size(); i++) {
    if (planes_[i]->near_plane(proxy)) found(*planes_[i]);
  }
}

void Broadphase::search(int first, int end, SearchTask& search) const {
  search.found.clear();
  for (int i = first; i < end; i++) {
    if (marked_[i] != nullptr) search_around(*marked_[i], search);
  }
}

void Broadphase::remove_stale_pairs(btDispatcher* dispatcher) {
  btBroadphasePairArray& pairs = pairs_.getOverlappingPairArray();
  for (int i = 0; i < pairs.size();) {
    auto& a = *static_cast<Proxy*>(pairs[i].m_pProxy0);
    auto& b = *static_cast<Proxy*>(pairs[i].m_pProxy1);
    const bool separated = (a.marked_index != 0 || b.marked_index != 0) && !a.overlaps(b);
    if (separated || ((a.filter_changed || b.filter_changed) && !proxies_may_collide(a, b))) {
      pairs_.removeOverlappingPair(&a, &b, dispatcher);  // the last pair moves to this index
    } else {
      i++;
    }
  }
}

void Broadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
  for (btDbvt& tree : moving_) tree.optimizeIncremental(1);
  if (marked_.size() == 0) return;
  remove_stale_pairs(dispatcher);
  reserve_searches(marked_.size());
  parallel_for_ranges(
      thread_pool_, marked_.size(),
      [&](int range, int first, int end) { search(first, end, (*searches_)[static_cast<std::size_t>(range)]); },
      kProxiesPerTask);
  for (int i = 0; i < marked_.size(); i++) {
    if (i + static_cast<int>(kProxiesAhead) < marked_.size())
      prefetch(marked_[i + static_cast<int>(kProxiesAhead)], sizeof(Proxy));
    if (marked_[i] == nullptr) continue;
    marked_[i]->marked_index = 0;
    marked_[i]->filter_changed = marked_[i]->has_neighbors = false;
  }
  for (int range = 0; range < range_count(marked_.size(), kProxiesPerTask); range++) {
    for (const auto& [a, b] : (*searches_)[static_cast<std::size_t>(range)].found) {
      a->has_neighbors = b->has_neighbors = true;
      pairs_.addOverlappingPair(a, b);
    }
  }
  marked_.resizeNoInitialize(0);
}

bool Broadphase::may_collide(const btCollisionObject& a, const btCollisionObject& b) {
  return proxies_may_collide(*a.getBroadphaseHandle(), *b.getBroadphaseHandle());
}

void Broadphase::find_collidable(const btCollisionObject& object, const btVector3& low, const btVector3& high,
                                 std::vector<const btDbvtNode*>& stack, std::vector<btCollisionObject*>& found) const {
  const auto& proxy = *static_cast<const Proxy*>(object.getBroadphaseHandle());
  const btDbvtVolume box = btDbvtVolume::FromMM(low, high);
  const auto add = [&](Proxy& other) {
    if (&other != &proxy && proxies_may_collide(proxy, other)) found.push_back(&other.object());
  };
  for (const btDbvt& tree : moving_) query_tree<Proxy>(tree, box, stack, add);
  query_tree<Proxy>(static_, box, stack, add);
  for (int i = 0; i < planes_.size(); i++) {
    if (planes_[i]->height_of(box) <= 0) add(*planes_[i]);
  }
}

void Broadphase::aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) {
  const btDbvtVolume box = btDbvtVolume::FromMM(low, high);
  const auto found = [&](Proxy& proxy) { callback.process(&proxy); };
  std::vector<const btDbvtNode*> stack;
  for (const btDbvt& tree : moving_) query_tree<Proxy>(tree, box, stack, found);
  query_tree<Proxy>(static_, box, stack, found);
  for (int i = 0; i < planes_.size(); i++) callback.process(planes_[i]);
}

void Broadphase::rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback,
                         const btVector3& low, const btVector3& high) {
  btVector3 ray_low = from;
  btVector3 ray_high = from;
  ray_low.setMin(to);
  ray_high.setMax(to);
  aabbTest(ray_low + low, ray_high + high, callback);
}

void Broadphase::getBroadphaseAabb(btVector3& low, btVector3& high) const {
  low.setZero();
  high.setZero();
  bool first = true;
  const auto extend = [&](const btDbvt& tree) {
    if (tree.m_root == nullptr) return;
    const btDbvtVolume& box = tree.m_root->volume;
    if (std::exchange(first, false)) {
      low = box.Mins();
      high = box.Maxs();
    } else {
      low.setMin(box.Mins());
      high.setMax(box.Maxs());
    }
  };
  extend(static_);
  for (const btDbvt& tree : moving_) extend(tree);
}

}  // namespace limber::sim::collision
