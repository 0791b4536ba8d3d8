// Broadphase: its pairs are those of a brute-force search, while objects move and are added, removed, joined and
// separated.
#include "sim/collision/broadphase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "joint_rig.h"

namespace limber::sim {
namespace {

constexpr double kFatMargin = 0.01;         // margin of fattened boxes
constexpr double kContactThreshold = 0.02;  // Bullet's contact threshold, which enlarges all boxes
constexpr int kBodies = 60;
constexpr int kRounds = 300;
constexpr std::size_t kLeaveRounds = 12;  // rounds within which each object leaves its fattened AABB

// A cloud of boxes of all sizes, some of them static, above two planes.
struct Cloud {
  explicit Cloud(unsigned seed, std::shared_ptr<ThreadPool> thread_pool = nullptr)
      : random(seed), world(WorldSetup{kFatMargin, 20, std::move(thread_pool)}) {
    for (int i = 0; i < kBodies; ++i) {
      shapes.push_back(std::make_unique<btBoxShape>(btVector3(size(), size(), size())));
      add(i % 5 == 0 ? 0 : 1, *shapes.back());
      place(i);
    }
    add(0, floor);
    add(0, wall);
    bodies[kBodies + 1]->getWorldTransform().setOrigin({-1, 0, 0});
  }
  ~Cloud() {
    for (auto& [pair, joint] : joints) world.removeConstraint(joint.get());
    for (auto& body : bodies) {
      if (body->isInWorld()) world.removeRigidBody(body.get());
    }
  }
  Cloud(const Cloud&) = delete;
  Cloud& operator=(const Cloud&) = delete;

  btScalar uniform(double low, double high) {
    return bullet::to_scalar(std::uniform_real_distribution<double>(low, high)(random));
  }
  btScalar size() { return bullet::to_scalar(std::exp(static_cast<double>(uniform(std::log(0.01), std::log(0.6))))); }
  int random_index() { return std::uniform_int_distribution<int>(0, kBodies - 1)(random); }

  void add(double mass, btCollisionShape& shape) {
    bodies.push_back(std::make_unique<btRigidBody>(bullet::to_scalar(mass), nullptr, &shape, btVector3(1, 1, 1)));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
  }
  btTransform random_rotation_at(const btVector3& at) {
    return btTransform(btQuaternion(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)), at);
  }
  void place(int i) {
    bodies[static_cast<std::size_t>(i)]->setWorldTransform(
        random_rotation_at({uniform(-2, 2), uniform(-2, 2), uniform(-0.5, 2)}));
  }
  void nudge(int i) {
    btTransform& at = bodies[static_cast<std::size_t>(i)]->getWorldTransform();
    at.setOrigin(at.getOrigin() + btVector3(uniform(-0.02, 0.02), uniform(-0.02, 0.02), uniform(-0.02, 0.02)));
  }

  // Adds every other body again: with a thread pool they are in another tree then.
  void readd_some() {
    for (int times = 0; times < 10; ++times) {
      for (std::size_t i = 0; i < kBodies; i += 2) {
        world.removeRigidBody(bodies[i].get());
        world.addRigidBody(bodies[i].get());
      }
    }
  }

  // Distance, m, by which a box may be extended along the motion: two of its recent steps.
  double extension(std::size_t i) const {
    return i < kBodies ? 2 * *std::max_element(steps[i].begin(), steps[i].end()) : 0.0;
  }
  void record_steps(int round) {
    for (std::size_t i = 0; i < kBodies; ++i) {
      const Vec3 at = bullet::from_bt(bodies[i]->getWorldTransform().getOrigin());
      const Vec3 step = glm::abs(at - std::exchange(positions[i], at));
      steps[i][static_cast<std::size_t>(round) % kLeaveRounds] = std::max({step.x, step.y, step.z});
    }
  }
  // Moves all objects a little, and makes one random change.
  void change_randomly() {
    for (int i = 0; i < kBodies; ++i) nudge(i);
    place(random_index());
    const int kind = std::uniform_int_distribution<int>(0, 5)(random);
    btRigidBody& one = *bodies[static_cast<std::size_t>(random_index())];
    if (kind == 0) {
      const auto bits = [&] { return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(1, 7)(random)); };
      world.set_filter(one, {bits(), bits(), std::uniform_int_distribution<int>(-1, 2)(random), random() % 2 == 0});
    }
    if (kind == 1) floor_transform().setRotation(btQuaternion(uniform(-0.3, 0.3), uniform(-0.3, 0.3), 0));
    if (kind == 2) floor_transform().setOrigin({0, 0, uniform(-0.4, 0.4)});
    if (kind == 3) add_or_remove_joint();
    if (kind == 4 && one.isInWorld() && one.getNumConstraintRefs() == 0) {
      world.removeRigidBody(&one);
    } else if (kind == 5) {
      for (auto& body : bodies) {
        if (!body->isInWorld()) world.addRigidBody(body.get());
      }
    }
  }
  btTransform& floor_transform() { return bodies[kBodies]->getWorldTransform(); }
  void add_or_remove_joint() {
    const int some = random_index();
    const int other = random_index();
    const std::pair<int, int> pair(std::min(some, other), std::max(some, other));
    btRigidBody& a = *bodies[static_cast<std::size_t>(pair.first)];
    btRigidBody& b = *bodies[static_cast<std::size_t>(pair.second)];
    if (joints.size() > 20) {
      world.removeConstraint(joints.begin()->second.get());
      joints.erase(joints.begin());
    } else if (&a != &b && !joints.contains(pair) && a.isInWorld() && b.isInWorld()) {
      auto& joint = joints[pair];
      joint = std::make_unique<bullet::JointConstraint>(a, b, btTransform::getIdentity(), btTransform::getIdentity());
      world.addConstraint(joint.get());
    }
  }

  bool may_collide(std::size_t i, std::size_t k) const {
    const btRigidBody& a = *bodies[i];
    const btRigidBody& b = *bodies[k];
    if (!a.isInWorld() || !b.isInWorld()) return false;
    if (a.isStaticObject() && b.isStaticObject()) return false;
    const bullet::CollisionFilter of_a = bullet::CollisionFilter::of(a);
    const bullet::CollisionFilter of_b = bullet::CollisionFilter::of(b);
    if ((of_a.group & of_b.mask) == 0 || (of_b.group & of_a.mask) == 0) return false;
    if (of_a.body >= 0 && of_a.body == of_b.body && !(of_a.self_collision && of_b.self_collision)) return false;
    return !joints.contains({static_cast<int>(i), static_cast<int>(k)});
  }
  // distance between two objects as the broadphase calculates it, m; negative: overlap
  double distance(std::size_t i, std::size_t k) const {
    Vec3 low[2], high[2];
    box(i, low[0], high[0]);
    if (k >= kBodies) {
      const auto& plane = static_cast<const btStaticPlaneShape&>(*bodies[k]->getCollisionShape());
      const Vec3 normal = bullet::from_bt(bodies[k]->getWorldTransform().getBasis() * plane.getPlaneNormal());
      double min_distance = 1e9;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 at((corner & 1) ? low[0].x : high[0].x, (corner & 2) ? low[0].y : high[0].y,
                      (corner & 4) ? low[0].z : high[0].z);
        min_distance =
            std::min(min_distance, glm::dot(normal, at - bullet::from_bt(bodies[k]->getWorldTransform().getOrigin())));
      }
      return min_distance;
    }
    box(k, low[1], high[1]);
    double gap = -1e9;
    for (int axis = 0; axis < 3; ++axis)
      gap = std::max({gap, low[0][axis] - high[1][axis], low[1][axis] - high[0][axis]});
    return gap;
  }
  void box(std::size_t i, Vec3& low, Vec3& high) const {
    btVector3 a, b;
    bodies[i]->getCollisionShape()->getAabb(bodies[i]->getWorldTransform(), a, b);
    low = bullet::from_bt(a);
    high = bullet::from_bt(b);
  }

  std::mt19937 random;
  std::vector<std::unique_ptr<btBoxShape>> shapes;
  btStaticPlaneShape floor{btVector3(0, 0, 1), 0};
  btStaticPlaneShape wall{btVector3(1, 0, 0), 0};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::map<std::pair<int, int>, std::unique_ptr<bullet::JointConstraint>> joints;
  std::array<Vec3, kBodies> positions{};
  std::array<std::array<double, kLeaveRounds>, kBodies> steps{};
  bullet::IslandWorld world;
};

void compare_with_brute_force(Cloud& cloud) {
  int near = 0, distant = 0, forbidden = 0;
  for (int round = 0; round < kRounds; ++round) {
    cloud.change_randomly();
    cloud.record_steps(round);
    cloud.world.performDiscreteCollisionDetection();
    for (std::size_t i = 0; i < kBodies; ++i) {
      for (std::size_t k = i + 1; k < cloud.bodies.size(); ++k) {
        btRigidBody& a = *cloud.bodies[i];
        btRigidBody& b = *cloud.bodies[k];
        const bool has_pair = a.isInWorld() && b.isInWorld() &&
                              cloud.world.getPairCache()->findPair(a.getBroadphaseHandle(), b.getBroadphaseHandle());
        const bool to_plane = k >= kBodies;
        const double distance = cloud.distance(i, k);
        if (!cloud.may_collide(i, k)) {
          ASSERT_FALSE(has_pair) << round << ": " << i << ' ' << k;
          if (distance < 0) ++forbidden;
          continue;
        }
        // with planes, contact distance is the part's own threshold
        const double contact_distance = static_cast<double>(a.getCollisionShape()->getContactBreakingThreshold(0.02F));
        const double guaranteed_distance = kContactThreshold + (to_plane ? contact_distance : kContactThreshold);
        // a fattened AABB may be larger by twice the margin, and along a diagonal √3 times as much
        const double extension = cloud.extension(i) + cloud.extension(k);
        const double max_distance =
            to_plane ? std::sqrt(3.0) * (kContactThreshold + 2 * kFatMargin + extension) + contact_distance
                     : guaranteed_distance + 4 * kFatMargin + extension;
        if (distance < guaranteed_distance - 1e-4) {
          ASSERT_TRUE(has_pair) << round << ": " << i << ' ' << k << " are " << distance << " m apart";
          ++near;
        } else if (distance > max_distance + 1e-4) {
          ASSERT_FALSE(has_pair) << round << ": " << i << ' ' << k << " are " << distance << " m apart";
          ++distant;
        }
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(distant, 100000);
  EXPECT_GT(forbidden, 100);
}

TEST(Broadphase, PairsMatchBruteForce) {
  Cloud cloud(4711);
  compare_with_brute_force(cloud);
}

TEST(Broadphase, PairsMatchBruteForceWithThreads) {
  Cloud cloud(4712, std::make_shared<ThreadPool>(2));
  cloud.readd_some();
  compare_with_brute_force(cloud);
}

TEST(Broadphase, PlanePairsWithinContactDistance) {
  Rig rig;
  btStaticPlaneShape floor{btVector3(0, 0, 1), 0};
  btRigidBody ground(0, nullptr, &floor);
  btBoxShape shape(btVector3(1, 1, 1));
  btRigidBody box(1, nullptr, &shape, btVector3(1, 1, 1));
  const double contact_distance = static_cast<double>(shape.getContactBreakingThreshold(0.02F));
  ASSERT_GT(contact_distance, 0.03);  // more than the margin
  rig.world.addRigidBody(&ground);
  rig.world.addRigidBody(&box);
  const auto has_pair_at = [&](double gap) {
    for (const double height : {50.0, 1 + gap}) {  // teleported from far away, so that its box is new
      box.getWorldTransform().setOrigin({0, 0, bullet::to_scalar(height)});
      rig.world.performDiscreteCollisionDetection();
    }
    return rig.world.getPairCache()->findPair(box.getBroadphaseHandle(), ground.getBroadphaseHandle()) != nullptr;
  };
  EXPECT_TRUE(has_pair_at(kContactThreshold + 0.95 * contact_distance));
  EXPECT_FALSE(has_pair_at(kContactThreshold + contact_distance + 1.1 * kFatMargin));
  rig.world.removeRigidBody(&box);
  rig.world.removeRigidBody(&ground);
}

TEST(Broadphase, BoxQueryFindsOverlappingObjects) {
  Cloud cloud(99);
  cloud.world.performDiscreteCollisionDetection();
  struct Collector : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
      return objects.insert(static_cast<const btCollisionObject*>(proxy->m_clientObject)).second;
    }
    std::set<const btCollisionObject*> objects;
  } inside;
  const Vec3 low(-1, -1, -1), high(0.5, 1, 1);
  cloud.world.getBroadphase()->aabbTest(bullet::to_bt(low), bullet::to_bt(high), inside);
  int counted = 0;
  for (std::size_t i = 0; i < kBodies; ++i) {
    Vec3 a, b;
    cloud.box(i, a, b);
    const bool overlaps = glm::all(glm::lessThan(a, high)) && glm::all(glm::lessThan(low, b));
    if (!overlaps) continue;
    EXPECT_TRUE(inside.objects.contains(cloud.bodies[i].get())) << i;
    ++counted;
  }
  EXPECT_GT(counted, 5);
  EXPECT_LT(inside.objects.size(), cloud.bodies.size());
  EXPECT_TRUE(inside.objects.contains(cloud.bodies[kBodies].get()));  // a plane is unbounded
}

// The box of a moving object overlaps static objects up to two steps ahead, but no farther; that of a teleported one
// doesn't.
TEST(Broadphase, ExtendsBoxesAlongTheMotion) {
  Rig rig;
  btBoxShape small(btVector3(0.2F, 0.2F, 0.2F));
  btRigidBody box(1, nullptr, &small, btVector3(1, 1, 1));
  btRigidBody wall(0, nullptr, &small);
  rig.world.addRigidBody(&box);
  rig.world.addRigidBody(&wall);
  // True if the pair exists after the box moved by `step` m to a distance of `gap` m from the wall.
  const auto has_pair_at = [&](double step, double gap) {
    for (const double from : {0.0, 50.0}) {  // teleported to the start, without motion
      box.getWorldTransform().setOrigin({bullet::to_scalar(from), 0, 0});
      rig.world.performDiscreteCollisionDetection();
    }
    wall.getWorldTransform().setOrigin({bullet::to_scalar(50.0 + step + 0.4 + gap), 0, 0});
    box.getWorldTransform().setOrigin({bullet::to_scalar(50.0 + step), 0, 0});
    rig.world.performDiscreteCollisionDetection();
    return rig.world.getPairCache()->findPair(box.getBroadphaseHandle(), wall.getBroadphaseHandle()) != nullptr;
  };
  const double margin = 2 * kContactThreshold + kFatMargin;
  for (const double step : {0.05, 0.1, 0.3}) {
    EXPECT_TRUE(has_pair_at(step, margin + 1.9 * step)) << step;
    EXPECT_FALSE(has_pair_at(step, margin + 2.1 * step)) << step;
  }
  EXPECT_FALSE(has_pair_at(0.5, margin + 0.1));  // more than its size
  rig.world.removeRigidBody(&box);
  rig.world.removeRigidBody(&wall);
}

}  // namespace
}  // namespace limber::sim
