// Broadphase: its pairs are those that looking at everything finds, whatever moves, comes, goes, joins and parts.
#include "sim/broadphase.h"

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

namespace limber {
namespace {

constexpr double kFat = 0.01;   // by which boxes are larger
constexpr double kNear = 0.02;  // Bullet's contact threshold, by which it makes all boxes larger
constexpr int kBodies = 60;
constexpr int kRounds = 300;
constexpr std::size_t kLately = 12;  // rounds after which each has left its box

// A cloud of boxes of all sizes, some of which stand, over two planes.
struct Cloud {
  explicit Cloud(unsigned seed, std::shared_ptr<Team> team = nullptr)
      : random(seed), world(WorldSetup{kFat, 20, std::move(team)}) {
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

  btScalar between(double low, double high) {
    return to_scalar(std::uniform_real_distribution<double>(low, high)(random));
  }
  btScalar size() { return to_scalar(std::exp(static_cast<double>(between(std::log(0.01), std::log(0.6))))); }
  int any() { return std::uniform_int_distribution<int>(0, kBodies - 1)(random); }

  void add(double mass, btCollisionShape& shape) {
    bodies.push_back(std::make_unique<btRigidBody>(to_scalar(mass), nullptr, &shape, btVector3(1, 1, 1)));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
  }
  btTransform turned(const btVector3& at) {
    return btTransform(btQuaternion(between(-3, 3), between(-3, 3), between(-3, 3)), at);
  }
  void place(int i) {
    bodies[static_cast<std::size_t>(i)]->setWorldTransform(turned({between(-2, 2), between(-2, 2), between(-0.5, 2)}));
  }
  void nudge(int i) {
    btTransform& at = bodies[static_cast<std::size_t>(i)]->getWorldTransform();
    at.setOrigin(at.getOrigin() + btVector3(between(-0.02, 0.02), between(-0.02, 0.02), between(-0.02, 0.02)));
  }

  // Every other one has come long after the rest: a team has them in another tree.
  void let_some_come_anew() {
    for (int times = 0; times < 10; ++times) {
      for (std::size_t i = 0; i < kBodies; i += 2) {
        world.removeRigidBody(bodies[i].get());
        world.addRigidBody(bodies[i].get());
      }
    }
  }

  // Metres by which a box may reach ahead of its body: two of the steps that it has lately made.
  double ahead(std::size_t i) const {
    return i < kBodies ? 2 * *std::max_element(steps[i].begin(), steps[i].end()) : 0.0;
  }
  void note_steps(int round) {
    for (std::size_t i = 0; i < kBodies; ++i) {
      const Vec3 at = from_bt(bodies[i]->getWorldTransform().getOrigin());
      const Vec3 step = glm::abs(at - std::exchange(places[i], at));
      steps[i][static_cast<std::size_t>(round) % kLately] = std::max({step.x, step.y, step.z});
    }
  }
  // something happens
  void change() {
    for (int i = 0; i < kBodies; ++i) nudge(i);
    place(any());
    const int what = std::uniform_int_distribution<int>(0, 5)(random);
    btRigidBody& one = *bodies[static_cast<std::size_t>(any())];
    if (what == 0) {
      const auto bits = [&] { return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(1, 7)(random)); };
      world.set_filter(one, {bits(), bits(), std::uniform_int_distribution<int>(-1, 2)(random), random() % 2 == 0});
    }
    if (what == 1) floor_at().setRotation(btQuaternion(between(-0.3, 0.3), between(-0.3, 0.3), 0));
    if (what == 2) floor_at().setOrigin({0, 0, between(-0.4, 0.4)});
    if (what == 3) join_or_part();
    if (what == 4 && one.isInWorld() && one.getNumConstraintRefs() == 0) {
      world.removeRigidBody(&one);
    } else if (what == 5) {
      for (auto& body : bodies) {
        if (!body->isInWorld()) world.addRigidBody(body.get());
      }
    }
  }
  btTransform& floor_at() { return bodies[kBodies]->getWorldTransform(); }
  void join_or_part() {
    const int some = any();
    const int other = any();
    const std::pair<int, int> pair(std::min(some, other), std::max(some, other));
    btRigidBody& a = *bodies[static_cast<std::size_t>(pair.first)];
    btRigidBody& b = *bodies[static_cast<std::size_t>(pair.second)];
    if (joints.size() > 20) {
      world.removeConstraint(joints.begin()->second.get());
      joints.erase(joints.begin());
    } else if (&a != &b && !joints.contains(pair) && a.isInWorld() && b.isInWorld()) {
      auto& joint = joints[pair];
      joint = std::make_unique<JointConstraint>(a, b, btTransform::getIdentity(), btTransform::getIdentity());
      world.addConstraint(joint.get());
    }
  }

  bool may_collide(std::size_t i, std::size_t k) const {
    const btRigidBody& a = *bodies[i];
    const btRigidBody& b = *bodies[k];
    if (!a.isInWorld() || !b.isInWorld()) return false;
    if (a.isStaticObject() && b.isStaticObject()) return false;
    const CollisionFilter of_a = CollisionFilter::of(a);
    const CollisionFilter of_b = CollisionFilter::of(b);
    if ((of_a.group & of_b.mask) == 0 || (of_b.group & of_a.mask) == 0) return false;
    if (of_a.body >= 0 && of_a.body == of_b.body && !(of_a.self_collision && of_b.self_collision)) return false;
    return !joints.contains({static_cast<int>(i), static_cast<int>(k)});
  }
  // metres between the two as the broadphase sees them; below 0: they overlap
  double distance(std::size_t i, std::size_t k) const {
    Vec3 low[2], high[2];
    box(i, low[0], high[0]);
    if (k >= kBodies) {
      const auto& plane = static_cast<const btStaticPlaneShape&>(*bodies[k]->getCollisionShape());
      const Vec3 normal = from_bt(bodies[k]->getWorldTransform().getBasis() * plane.getPlaneNormal());
      double least = 1e9;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 at((corner & 1) ? low[0].x : high[0].x, (corner & 2) ? low[0].y : high[0].y,
                      (corner & 4) ? low[0].z : high[0].z);
        least = std::min(least, glm::dot(normal, at - from_bt(bodies[k]->getWorldTransform().getOrigin())));
      }
      return least;
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
    low = from_bt(a);
    high = from_bt(b);
  }

  std::mt19937 random;
  std::vector<std::unique_ptr<btBoxShape>> shapes;
  btStaticPlaneShape floor{btVector3(0, 0, 1), 0};
  btStaticPlaneShape wall{btVector3(1, 0, 0), 0};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::map<std::pair<int, int>, std::unique_ptr<JointConstraint>> joints;
  std::array<Vec3, kBodies> places{};
  std::array<std::array<double, kLately>, kBodies> steps{};
  IslandWorld world;
};

void look_at_everything(Cloud& cloud) {
  int found = 0, left_out = 0, forbidden = 0;
  for (int round = 0; round < kRounds; ++round) {
    cloud.change();
    cloud.note_steps(round);
    cloud.world.performDiscreteCollisionDetection();
    for (std::size_t i = 0; i < kBodies; ++i) {
      for (std::size_t k = i + 1; k < cloud.bodies.size(); ++k) {
        btRigidBody& a = *cloud.bodies[i];
        btRigidBody& b = *cloud.bodies[k];
        const bool there = a.isInWorld() && b.isInWorld() &&
                           cloud.world.getPairCache()->findPair(a.getBroadphaseHandle(), b.getBroadphaseHandle());
        const bool to_plane = k >= kBodies;
        const double distance = cloud.distance(i, k);
        if (!cloud.may_collide(i, k)) {
          ASSERT_FALSE(there) << round << ": " << i << ' ' << k;
          if (distance < 0) ++forbidden;
          continue;
        }
        // from a plane a contact begins as far as the part's own threshold says
        const double reach = static_cast<double>(a.getCollisionShape()->getContactBreakingThreshold(0.02F));
        const double sure = kNear + (to_plane ? reach : kNear);
        // a box that has not been left yet may be larger by twice the margin, and its corner nearer by √3 than its side
        const double ahead = cloud.ahead(i) + cloud.ahead(k);
        const double most = to_plane ? std::sqrt(3.0) * (kNear + 2 * kFat + ahead) + reach : sure + 4 * kFat + ahead;
        if (distance < sure - 1e-4) {
          ASSERT_TRUE(there) << round << ": " << i << ' ' << k << " are " << distance << " m apart";
          ++found;
        } else if (distance > most + 1e-4) {
          ASSERT_FALSE(there) << round << ": " << i << ' ' << k << " are " << distance << " m apart";
          ++left_out;
        }
      }
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(left_out, 100000);
  EXPECT_GT(forbidden, 100);
}

TEST(Broadphase, ItsPairsAreThoseThatLookingAtEverythingFinds) {
  Cloud cloud(4711);
  look_at_everything(cloud);
}

TEST(Broadphase, ATeamsTreesFindTheSame) {
  Cloud cloud(4712, std::make_shared<Team>(2));
  cloud.let_some_come_anew();
  look_at_everything(cloud);
}

TEST(Broadphase, APlaneIsMetFromAsFarAsAContactCanBegin) {
  Rig rig;
  btStaticPlaneShape floor{btVector3(0, 0, 1), 0};
  btRigidBody ground(0, nullptr, &floor);
  btBoxShape shape(btVector3(1, 1, 1));
  btRigidBody box(1, nullptr, &shape, btVector3(1, 1, 1));
  const double reach = static_cast<double>(shape.getContactBreakingThreshold(0.02F));
  ASSERT_GT(reach, 0.03);  // more than the margin
  rig.world.addRigidBody(&ground);
  rig.world.addRigidBody(&box);
  const auto meets_at = [&](double gap) {
    for (const double height : {50.0, 1 + gap}) {  // from far away, so that its box is new
      box.getWorldTransform().setOrigin({0, 0, to_scalar(height)});
      rig.world.performDiscreteCollisionDetection();
    }
    return rig.world.getPairCache()->findPair(box.getBroadphaseHandle(), ground.getBroadphaseHandle()) != nullptr;
  };
  EXPECT_TRUE(meets_at(kNear + 0.95 * reach));
  EXPECT_FALSE(meets_at(kNear + reach + 1.1 * kFat));
  rig.world.removeRigidBody(&box);
  rig.world.removeRigidBody(&ground);
}

TEST(Broadphase, ABoxesQueryFindsWhatLiesInIt) {
  Cloud cloud(99);
  cloud.world.performDiscreteCollisionDetection();
  struct Named : btBroadphaseAabbCallback {
    bool process(const btBroadphaseProxy* proxy) override {
      return named.insert(static_cast<const btCollisionObject*>(proxy->m_clientObject)).second;
    }
    std::set<const btCollisionObject*> named;
  } inside;
  const Vec3 low(-1, -1, -1), high(0.5, 1, 1);
  cloud.world.getBroadphase()->aabbTest(to_bt(low), to_bt(high), inside);
  int counted = 0;
  for (std::size_t i = 0; i < kBodies; ++i) {
    Vec3 a, b;
    cloud.box(i, a, b);
    const bool meets = glm::all(glm::lessThan(a, high)) && glm::all(glm::lessThan(low, b));
    if (!meets) continue;
    EXPECT_TRUE(inside.named.contains(cloud.bodies[i].get())) << i;
    ++counted;
  }
  EXPECT_GT(counted, 5);
  EXPECT_LT(inside.named.size(), cloud.bodies.size());
  EXPECT_TRUE(inside.named.contains(cloud.bodies[kBodies].get()));  // a plane is everywhere
}

// A box that goes on meets what stands two of its steps ahead of it, and no more than that; one that jumps doesn't.
TEST(Broadphase, ABoxReachesAheadOfWhatMoves) {
  Rig rig;
  btBoxShape small(btVector3(0.2F, 0.2F, 0.2F));
  btRigidBody box(1, nullptr, &small, btVector3(1, 1, 1));
  btRigidBody wall(0, nullptr, &small);
  rig.world.addRigidBody(&box);
  rig.world.addRigidBody(&wall);
  // its next step, of so many metres, ends with a gap of so many to the wall
  const auto meets_at = [&](double step, double gap) {
    for (const double from : {0.0, 50.0}) {  // it jumps there, and has no way ahead of it
      box.getWorldTransform().setOrigin({to_scalar(from), 0, 0});
      rig.world.performDiscreteCollisionDetection();
    }
    wall.getWorldTransform().setOrigin({to_scalar(50.0 + step + 0.4 + gap), 0, 0});
    box.getWorldTransform().setOrigin({to_scalar(50.0 + step), 0, 0});
    rig.world.performDiscreteCollisionDetection();
    return rig.world.getPairCache()->findPair(box.getBroadphaseHandle(), wall.getBroadphaseHandle()) != nullptr;
  };
  const double still = 2 * kNear + kFat;
  for (const double step : {0.05, 0.1, 0.3}) {
    EXPECT_TRUE(meets_at(step, still + 1.9 * step)) << step;
    EXPECT_FALSE(meets_at(step, still + 2.1 * step)) << step;
  }
  EXPECT_FALSE(meets_at(0.5, still + 0.1));  // more than its size
  rig.world.removeRigidBody(&box);
  rig.world.removeRigidBody(&wall);
}

}  // namespace
}  // namespace limber
