// Boxes that meet, found through two trees; planes by their distance.
#include "sim/broadphase.h"

#include <algorithm>
#include <utility>

#include "base/prefetch.h"
#include "sim/collision_filter.h"

namespace limber {
namespace {

/// Boxes that are alone are larger where their objects go, by the way of so many steps: they are left the more seldom.
/// Among others that would cost more, since contacts are looked for with all that a box meets. What jumps by more than
/// its own size will not jump on.
constexpr btScalar kStepsAhead = 2;
/// Largest extension of a box along its object's motion in a step, m. Contacts can't stop faster objects.
constexpr btScalar kFarthestAhead = 10;
/// So many ahead the memory of what has left its box is asked for, and then of its place in the tree: who looked at it,
/// or moved it, may have been another processor.
constexpr std::size_t kAhead = 8;
constexpr std::size_t kLeafAhead = 4;
/// Of those whose neighbours are looked for, so many at a time; it changes no result.
constexpr int kSearched = 16;
/// So many that came one after the other are in one tree: they are mostly near each other.
constexpr int kInTree = 256;

}  // namespace

struct Broadphase::Proxy : btBroadphaseProxy {
  using btBroadphaseProxy::btBroadphaseProxy;

  btDbvtNode* leaf = nullptr;  // null: a plane
  btDbvtVolume box{};          // the leaf's: which would be another place in memory
  bool moves = false;
  int tree = 0;               // of those of what moves
  bool anew = false;          // who may collide with it has changed
  bool near = false;          // something was found around it lately
  int marked = 0;             // place in marked_, from 1 on; 0: none
  btScalar reach = 0;         // how far from its surface contacts begin
  btVector3 way{0, 0, 0};     // of its box in the last step
  btVector3 normal{0, 0, 0};  // a plane's, and its distance from the origin
  btScalar distance = 0;

  btCollisionObject& object() const { return *static_cast<btCollisionObject*>(m_clientObject); }

  // as a plane: was it moved
  bool look_at_plane() {
    const auto& shape = *static_cast<const btStaticPlaneShape*>(object().getCollisionShape());
    const btTransform& at = object().getWorldTransform();
    const btVector3 before = std::exchange(normal, at.getBasis() * shape.getPlaneNormal());
    const btScalar far = std::exchange(distance, shape.getPlaneConstant() + normal.dot(at.getOrigin()));
    return normal != before || distance != far;
  }
  // as a plane: is the other one so near to it that a contact can begin
  bool reaches(const Proxy& other) const {
    return normal.dot(other.box.Center()) - distance - normal.absolute().dot(other.box.Extents()) <= other.reach;
  }
  bool meets(const Proxy& other) const {
    if (leaf == nullptr) return other.leaf != nullptr && reaches(other);
    return other.leaf == nullptr ? other.reaches(*this) : Intersect(box, other.box);
  }
};

// room for what is usual, so that nothing is allocated in a step
struct Broadphase::Search {
  Search() {
    found.reserve(std::size_t{8} * kSearched);
    stack.reserve(256);
  }
  std::vector<std::pair<Proxy*, Proxy*>> found;
  std::vector<const btDbvtNode*> stack;
};

namespace {

// all proxies in the tree whose boxes meet this one
template <class Proxy, class Found>
void meet(const btDbvt& tree, const btDbvtVolume& box, std::vector<const btDbvtNode*>& stack, Found&& found) {
  if (tree.m_root == nullptr) return;
  stack.assign(1, tree.m_root);
  while (!stack.empty()) {
    const btDbvtNode* node = stack.back();
    stack.pop_back();
    if (!Intersect(node->volume, box)) continue;
    if (node->isinternal()) {
      prefetch(node->childs[0], sizeof *node);  // the other one's turn comes first
      stack.push_back(node->childs[0]);
      stack.push_back(node->childs[1]);
    } else {
      found(*static_cast<Proxy*>(node->data));
    }
  }
}

bool may_collide(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
  if ((a.m_collisionFilterGroup & b.m_collisionFilterMask) == 0) return false;
  if ((b.m_collisionFilterGroup & a.m_collisionFilterMask) == 0) return false;
  const auto& first = *static_cast<const btCollisionObject*>(a.m_clientObject);
  const auto& second = *static_cast<const btCollisionObject*>(b.m_clientObject);
  if (!CollisionFilter::of(first).accepts(CollisionFilter::of(second))) return false;
  return first.checkCollideWith(&second) && second.checkCollideWith(&first);
}

// By as much of the way that the object moves in the step as is more than boxes reach ahead anyway: contacts that begin
// within the step are found before it.
void extend_along_motion(const btCollisionObject& object, btScalar h, btVector3& low, btVector3& high) {
  if (object.isStaticObject()) return;
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr) return;
  const btVector3 way = body->getLinearVelocity() * h;
  for (int k = 0; k < 3; k++) {
    if (way[k] > gContactBreakingThreshold) high[k] += std::min(way[k] - gContactBreakingThreshold, kFarthestAhead);
    if (way[k] < -gContactBreakingThreshold) low[k] += std::max(way[k] + gContactBreakingThreshold, -kFarthestAhead);
  }
}

}  // namespace

Broadphase::Broadphase(double margin, Team* team)
    : margin_(to_scalar(margin)),
      team_(team),
      trees_(team == nullptr ? 1 : std::min(team->members(), kMostTrees)),
      searches_(std::make_unique<std::vector<Search>>()) {}

Broadphase::~Broadphase() = default;

btDbvt& Broadphase::tree_of(const Proxy& proxy) {
  return proxy.moves ? moving_[static_cast<std::size_t>(proxy.tree)] : standing_;
}

void Broadphase::mark(Proxy& proxy) {
  if (proxy.marked != 0) return;
  marked_.push_back(&proxy);
  proxy.marked = marked_.size();
}

btBroadphaseProxy* Broadphase::createProxy(const btVector3& low, const btVector3& high, int shape, void* object,
                                           int group, int mask, btDispatcher*) {
  auto* proxy = new Proxy(low, high, object, group, mask);
  proxy->m_uniqueId = ++last_id_;
  if (shape == STATIC_PLANE_PROXYTYPE) {
    planes_.push_back(proxy);
    proxy->look_at_plane();
  } else {
    const btCollisionObject& of = proxy->object();
    proxy->moves = !of.isStaticObject();
    proxy->reach = of.getCollisionShape()->getContactBreakingThreshold(gContactBreakingThreshold);
    proxy->box = btDbvtVolume::FromMM(low, high);
    if (proxy->moves) proxy->tree = last_id_ / kInTree % trees_;
    proxy->leaf = tree_of(*proxy).insert(proxy->box, proxy);
  }
  mark(*proxy);
  make_room(++count_);
  return proxy;
}

void Broadphase::make_room(int marked) {
  const auto needed = static_cast<std::size_t>(ranges_of(marked, kSearched));
  if (searches_->size() < needed) searches_->resize(needed);
}

void Broadphase::destroyProxy(btBroadphaseProxy* of, btDispatcher* dispatcher) {
  auto* proxy = static_cast<Proxy*>(of);
  pairs_.removeOverlappingPairsContainingProxy(proxy, dispatcher);
  if (proxy->marked != 0) marked_[proxy->marked - 1] = nullptr;
  if (proxy->leaf == nullptr) {
    planes_.remove(proxy);
  } else {
    btDbvt& tree = tree_of(*proxy);
    tree.remove(proxy->leaf);
    // the node that a tree keeps for later, and would free when a leaf is moved: a team's members must free nothing
    btAlignedFree(std::exchange(tree.m_free, nullptr));
  }
  delete proxy;
  --count_;
}

void Broadphase::look_anew(btBroadphaseProxy* of) {
  auto& proxy = *static_cast<Proxy*>(of);
  proxy.anew = true;
  mark(proxy);
}

bool Broadphase::look(btCollisionObject& object, btScalar h) {
  if (object.getBroadphaseHandle() == nullptr) return false;
  Proxy& proxy = *static_cast<Proxy*>(object.getBroadphaseHandle());
  if (proxy.leaf == nullptr) return proxy.look_at_plane();
  btVector3 low;
  btVector3 high;
  object.getCollisionShape()->getAabb(object.getWorldTransform(), low, high);
  const btVector3 ahead(gContactBreakingThreshold, gContactBreakingThreshold, gContactBreakingThreshold);
  extend_along_motion(object, h, low, high);
  const btVector3 before = proxy.m_aabbMin + proxy.m_aabbMax;
  proxy.m_aabbMin = low - ahead;
  proxy.m_aabbMax = high + ahead;
  proxy.way = (proxy.m_aabbMin + proxy.m_aabbMax - before) / 2;
  const btDbvtVolume box = btDbvtVolume::FromMM(proxy.m_aabbMin, proxy.m_aabbMax);
  return proxy.moves ? !proxy.box.Contain(box) : NotEqual(proxy.box, box);
}

void Broadphase::fetch(const btCollisionObject& object) { prefetch(object.getBroadphaseHandle(), sizeof(Proxy)); }

void Broadphase::leave(std::span<btBroadphaseProxy* const> proxies) {
  for (std::size_t i = 0; i < proxies.size(); i++) {
    if (i + kAhead < proxies.size()) prefetch(proxies[i + kAhead], sizeof(Proxy));
    mark(*static_cast<Proxy*>(proxies[i]));
  }
  share_out(team_, trees_, [&](int tree, int) {
    for (std::size_t i = 0; i < proxies.size(); i++) {
      if (i + kAhead < proxies.size()) prefetch(proxies[i + kAhead], sizeof(Proxy));
      if (i + kLeafAhead < proxies.size()) {
        prefetch(static_cast<const Proxy*>(proxies[i + kLeafAhead])->leaf, sizeof(btDbvtNode));
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
    const btVector3 left = size - proxy.way.absolute();
    if (!proxy.near && left[left.minAxis()] >= 0) box.SignedExpand(proxy.way * kStepsAhead);
  }
  tree_of(proxy).update(proxy.leaf, box);
  proxy.box = box;
}

void Broadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& low, const btVector3& high, btDispatcher*) {
  proxy->m_aabbMin = low;
  proxy->m_aabbMax = high;
  mark(*static_cast<Proxy*>(proxy));
  move(*static_cast<Proxy*>(proxy));
}

void Broadphase::getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const {
  low = proxy->m_aabbMin;
  high = proxy->m_aabbMax;
}

void Broadphase::search_around(Proxy& proxy, Search& search) const {
  const auto found = [&](Proxy& other) {
    // of two that are marked, the later one finds the other
    if (&proxy == &other || other.marked > proxy.marked) return;
    if (may_collide(proxy, other)) search.found.emplace_back(&proxy, &other);
  };
  if (proxy.leaf == nullptr) {
    for (const btDbvt& tree : moving_) {
      if (tree.m_root == nullptr) continue;
      meet<Proxy>(tree, tree.m_root->volume, search.stack, [&](Proxy& other) {
        if (proxy.reaches(other)) found(other);
      });
    }
    return;
  }
  for (const btDbvt& tree : moving_) meet<Proxy>(tree, proxy.box, search.stack, found);
  if (!proxy.moves) return;
  meet<Proxy>(standing_, proxy.box, search.stack, found);
  for (int i = 0; i < planes_.size(); i++) {
    if (planes_[i]->reaches(proxy)) found(*planes_[i]);
  }
}

void Broadphase::search(int first, int end, Search& search) const {
  search.found.clear();
  for (int i = first; i < end; i++) {
    if (marked_[i] != nullptr) search_around(*marked_[i], search);
  }
}

void Broadphase::forget_parted(btDispatcher* dispatcher) {
  btBroadphasePairArray& pairs = pairs_.getOverlappingPairArray();
  for (int i = 0; i < pairs.size();) {
    auto& a = *static_cast<Proxy*>(pairs[i].m_pProxy0);
    auto& b = *static_cast<Proxy*>(pairs[i].m_pProxy1);
    const bool parted = (a.marked != 0 || b.marked != 0) && !a.meets(b);
    if (parted || ((a.anew || b.anew) && !may_collide(a, b))) {
      pairs_.removeOverlappingPair(&a, &b, dispatcher);  // the last one takes its place
    } else {
      i++;
    }
  }
}

void Broadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
  for (btDbvt& tree : moving_) tree.optimizeIncremental(1);
  if (marked_.size() == 0) return;
  forget_parted(dispatcher);
  make_room(marked_.size());
  share_out_places(
      team_, marked_.size(),
      [&](int range, int first, int end) { search(first, end, (*searches_)[static_cast<std::size_t>(range)]); },
      kSearched);
  for (int i = 0; i < marked_.size(); i++) {
    if (i + static_cast<int>(kAhead) < marked_.size()) prefetch(marked_[i + static_cast<int>(kAhead)], sizeof(Proxy));
    if (marked_[i] == nullptr) continue;
    marked_[i]->marked = 0;
    marked_[i]->anew = marked_[i]->near = false;
  }
  for (int range = 0; range < ranges_of(marked_.size(), kSearched); range++) {
    for (const auto& [a, b] : (*searches_)[static_cast<std::size_t>(range)].found) {
      a->near = b->near = true;
      pairs_.addOverlappingPair(a, b);
    }
  }
  marked_.resizeNoInitialize(0);
}

void Broadphase::aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) {
  const btDbvtVolume box = btDbvtVolume::FromMM(low, high);
  const auto found = [&](Proxy& proxy) { callback.process(&proxy); };
  std::vector<const btDbvtNode*> stack;
  for (const btDbvt& tree : moving_) meet<Proxy>(tree, box, stack, found);
  meet<Proxy>(standing_, box, stack, found);
  for (int i = 0; i < planes_.size(); i++) callback.process(planes_[i]);
}

void Broadphase::rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback,
                         const btVector3& low, const btVector3& high) {
  btVector3 least = from;
  btVector3 most = from;
  least.setMin(to);
  most.setMax(to);
  aabbTest(least + low, most + high, callback);
}

void Broadphase::getBroadphaseAabb(btVector3& low, btVector3& high) const {
  low.setZero();
  high.setZero();
  bool first = true;
  const auto reach = [&](const btDbvt& tree) {
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
  reach(standing_);
  for (const btDbvt& tree : moving_) reach(tree);
}

}  // namespace limber
