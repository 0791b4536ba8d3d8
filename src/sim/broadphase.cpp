// Boxes that meet, found through two trees; planes by their distance.
#include "sim/broadphase.h"

#include <utility>

namespace limber {

struct Broadphase::Proxy : btBroadphaseProxy {
  using btBroadphaseProxy::btBroadphaseProxy;

  btDbvtNode* leaf = nullptr;  // null: a plane
  bool moves = false;
  bool anew = false;          // who may collide with it has changed
  int marked = 0;             // place in marked_, from 1 on; 0: none
  btScalar reach = 0;         // how far from its surface contacts begin
  btVector3 normal{0, 0, 0};  // a plane's, and its distance from the origin
  btScalar distance = 0;

  btCollisionObject& object() const { return *static_cast<btCollisionObject*>(m_clientObject); }

  // as a plane: is the other one so near to it that a contact can begin
  bool reaches(const Proxy& other) const {
    const btDbvtVolume& box = other.leaf->volume;
    return normal.dot(box.Center()) - distance - normal.absolute().dot(box.Extents()) <= other.reach;
  }
  bool meets(const Proxy& other) const {
    if (leaf == nullptr) return other.leaf != nullptr && reaches(other);
    return other.leaf == nullptr ? other.reaches(*this) : Intersect(leaf->volume, other.leaf->volume);
  }
};

namespace {

bool may_collide(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
  if ((a.m_collisionFilterGroup & b.m_collisionFilterMask) == 0) return false;
  if ((b.m_collisionFilterGroup & a.m_collisionFilterMask) == 0) return false;
  const auto& first = *static_cast<const btCollisionObject*>(a.m_clientObject);
  const auto& second = *static_cast<const btCollisionObject*>(b.m_clientObject);
  if (first.getUserIndex2() >= 0 && first.getUserIndex2() == second.getUserIndex2()) return false;
  return first.checkCollideWith(&second) && second.checkCollideWith(&first);
}

}  // namespace

Broadphase::~Broadphase() = default;

template <class Found>
void Broadphase::meet(const btDbvt& tree, const btDbvtVolume& box, Found&& found) {
  if (tree.m_root == nullptr) return;
  stack_.resizeNoInitialize(0);
  stack_.push_back(tree.m_root);
  while (stack_.size() > 0) {
    const btDbvtNode* node = stack_[stack_.size() - 1];
    stack_.pop_back();
    if (!Intersect(node->volume, box)) continue;
    if (node->isinternal()) {
      stack_.push_back(node->childs[0]);
      stack_.push_back(node->childs[1]);
    } else {
      found(*static_cast<Proxy*>(node->data));
    }
  }
}

void Broadphase::mark(Proxy& proxy) {
  if (proxy.marked != 0) return;
  marked_.push_back(&proxy);
  proxy.marked = marked_.size();
}

btBroadphaseProxy* Broadphase::createProxy(const btVector3& low, const btVector3& high, int shape, void* object,
                                           int group, int mask, btDispatcher* dispatcher) {
  auto* proxy = new Proxy(low, high, object, group, mask);
  proxy->m_uniqueId = ++last_id_;
  if (shape == STATIC_PLANE_PROXYTYPE) {
    planes_.push_back(proxy);
    setAabb(proxy, low, high, dispatcher);
  } else {
    const btCollisionObject& of = proxy->object();
    proxy->moves = !of.isStaticObject();
    proxy->reach = of.getCollisionShape()->getContactBreakingThreshold(gContactBreakingThreshold);
    proxy->leaf = (proxy->moves ? moving_ : standing_).insert(btDbvtVolume::FromMM(low, high), proxy);
  }
  mark(*proxy);
  return proxy;
}

void Broadphase::destroyProxy(btBroadphaseProxy* of, btDispatcher* dispatcher) {
  auto* proxy = static_cast<Proxy*>(of);
  pairs_.removeOverlappingPairsContainingProxy(proxy, dispatcher);
  if (proxy->marked != 0) marked_[proxy->marked - 1] = nullptr;
  if (proxy->leaf == nullptr) {
    planes_.remove(proxy);
  } else {
    (proxy->moves ? moving_ : standing_).remove(proxy->leaf);
  }
  delete proxy;
}

void Broadphase::look_anew(btBroadphaseProxy* of) {
  auto& proxy = *static_cast<Proxy*>(of);
  proxy.anew = true;
  mark(proxy);
}

void Broadphase::setAabb(btBroadphaseProxy* of, const btVector3& low, const btVector3& high, btDispatcher*) {
  Proxy& proxy = *static_cast<Proxy*>(of);
  proxy.m_aabbMin = low;
  proxy.m_aabbMax = high;
  if (proxy.leaf == nullptr) {
    const auto& shape = *static_cast<const btStaticPlaneShape*>(proxy.object().getCollisionShape());
    const btTransform& at = proxy.object().getWorldTransform();
    const btVector3 normal = at.getBasis() * shape.getPlaneNormal();
    const btScalar distance = shape.getPlaneConstant() + normal.dot(at.getOrigin());
    if (proxy.normal == normal && proxy.distance == distance) return;
    proxy.normal = normal;
    proxy.distance = distance;
    mark(proxy);
    return;
  }
  btDbvtVolume box = btDbvtVolume::FromMM(low, high);
  if (proxy.moves) {
    if (moving_.update(proxy.leaf, box, margin_)) mark(proxy);
  } else if (NotEqual(box, proxy.leaf->volume)) {
    standing_.update(proxy.leaf, box);
    mark(proxy);
  }
}

void Broadphase::getAabb(btBroadphaseProxy* proxy, btVector3& low, btVector3& high) const {
  low = proxy->m_aabbMin;
  high = proxy->m_aabbMax;
}

void Broadphase::add_pair(Proxy& a, Proxy& b) {
  // of two that are marked, the later one finds the other
  if (&a == &b || b.marked > a.marked) return;
  if (may_collide(a, b)) pairs_.addOverlappingPair(&a, &b);
}

void Broadphase::find_pairs_of(Proxy& proxy) {
  const auto found = [&](Proxy& other) { add_pair(proxy, other); };
  if (proxy.leaf == nullptr) {
    btVector3 low;
    btVector3 high;
    getBroadphaseAabb(low, high);
    meet(moving_, btDbvtVolume::FromMM(low, high), [&](Proxy& other) {
      if (proxy.reaches(other)) add_pair(proxy, other);
    });
    return;
  }
  meet(moving_, proxy.leaf->volume, found);
  if (!proxy.moves) return;
  meet(standing_, proxy.leaf->volume, found);
  for (int i = 0; i < planes_.size(); i++) {
    if (planes_[i]->reaches(proxy)) add_pair(proxy, *planes_[i]);
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
  BT_PROFILE("calculateOverlappingPairs");
  moving_.optimizeIncremental(1);
  if (marked_.size() == 0) return;
  forget_parted(dispatcher);
  for (int i = 0; i < marked_.size(); i++) {
    if (marked_[i] != nullptr) find_pairs_of(*marked_[i]);
  }
  for (int i = 0; i < marked_.size(); i++) {
    if (marked_[i] == nullptr) continue;
    marked_[i]->marked = 0;
    marked_[i]->anew = false;
  }
  marked_.resizeNoInitialize(0);
}

void Broadphase::aabbTest(const btVector3& low, const btVector3& high, btBroadphaseAabbCallback& callback) {
  const btDbvtVolume box = btDbvtVolume::FromMM(low, high);
  const auto found = [&](Proxy& proxy) { callback.process(&proxy); };
  meet(moving_, box, found);
  meet(standing_, box, found);
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
  for (const btDbvt* tree : {&moving_, &standing_}) {
    if (tree->m_root == nullptr) continue;
    const btDbvtVolume& box = tree->m_root->volume;
    if (std::exchange(first, false)) {
      low = box.Mins();
      high = box.Maxs();
    } else {
      low.setMin(box.Mins());
      high.setMax(box.Maxs());
    }
  }
}

}  // namespace limber
