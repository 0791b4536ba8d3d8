// IslandWorld: Bullet's dynamics world with islands found in linear time and solved in a stable order.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/threads/thread_pool.h"
#include "sim/bullet/awake_objects.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/bullet_memory.h"
#include "sim/bullet/collision_filter.h"
#include "sim/bullet/islands.h"
#include "sim/bullet/kinematic_bodies.h"
#include "sim/bullet/sleep.h"
#include "sim/collision/broadphase.h"
#include "sim/solver/direct_solver.h"
#include "sim/world/world_setup.h"

namespace limber::sim::bullet {

class ContinuousCollision;
class IslandSolver;

/// Bullet's components of a world. IslandWorld inherits them first, so that they are constructed before and destroyed
/// after Bullet's world, which refers to them.
struct WorldParts {
  explicit WorldParts(const WorldSetup& setup);
  ~WorldParts();
  BulletMemory* memory;  ///< Of the scope at construction, or null.
  std::unique_ptr<btDefaultCollisionConfiguration> configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher;
  std::unique_ptr<collision::Broadphase> broadphase;
  /// One per thread; on the heap, because their data lives for one step only.
  std::vector<std::unique_ptr<IslandSolver>> solvers;
  std::unique_ptr<ContinuousCollision> continuous;
  std::shared_ptr<ThreadPool> thread_pool;
};

/// Joints and contacts of an island are solved in an order that depends on that island alone (joints in the order of
/// their creation, contacts by the age of the parts), so an island moves bit-identically whether alone or among others.
/// Bodies belong to the caller; they have no motion states, and none has Bullet's kinematic flag (see kinematic()).
/// They sleep (sleep.h) if SleepTracker::allow() permits it. Persistent data is allocated in the memory of the
/// BulletMemory::Scope at construction. [sim]
class IslandWorld : private WorldParts, public btDiscreteDynamicsWorld {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  explicit IslandWorld(const WorldSetup& setup = {});
  ~IslandWorld() override;

  /// One tick: `substeps` equal steps of `h` seconds each. Forces applied before it act during all of them and are
  /// cleared at its end, when the mean forces of the joints are computed. Does nothing unless h > 0 and substeps > 0.
  void step(double h, int substeps);

  /// Joints keep the order in which they were added. By default the joined parts stop colliding with each other at
  /// once, and collide again when their last such joint is removed.
  void addConstraint(btTypedConstraint* constraint, bool disable_collisions = true) override;
  void removeConstraint(btTypedConstraint* constraint) override;
  void addRigidBody(btRigidBody* body) override;
  void addRigidBody(btRigidBody* body, int group, int mask) override;
  void removeRigidBody(btRigidBody* body) override;
  void addCollisionObject(btCollisionObject* object, int group, int mask) override;
  /// Wakes everything if the value differs.
  void setGravity(const btVector3& gravity) override;

  /// Wakes all bodies.
  void wake_all();
  SleepTracker& sleep() { return sleep_; }
  const SleepTracker& sleep() const { return sleep_; }

  /// Moves of static bodies during the next tick.
  KinematicBodies& kinematic() { return kinematic_; }

  /// Sets which other objects this one may collide with, from the next step on.
  void set_filter(btCollisionObject& object, const CollisionFilter& filter);
  /// Excludes two objects from colliding with each other from the next step on, or includes them again; independent of
  /// joints that connect them. Calls must alternate: each exclude_pair() needs one include_pair().
  void exclude_pair(btCollisionObject& a, btCollisionObject& b);
  void include_pair(btCollisionObject& a, btCollisionObject& b);

  /// Reads the joints' rates again; to be called if velocities were changed in a substep's callback.
  void refresh_joints();

  /// True if a part has been unstable (stability.h) since the present substep began.
  bool is_unstable() const { return unstable_.load(std::memory_order_relaxed); }

  /// Selects the direct solver (true) or the iterative one for all islands, from the next step on.
  void set_direct(bool on);
  /// Counts since the world was created.
  solver::DirectCounts direct_counts() const;
  /// Solver of the calling thread; it solves all islands if there is no thread pool.
  solver::DirectSolver& direct();

 protected:
  void predictUnconstraintMotion(btScalar h) override;
  void createPredictiveContacts(btScalar h) override;
  void updateAabbs() override;
  void calculateSimulationIslands() override;
  void solveConstraints(btContactSolverInfo& info) override;
  void integrateTransforms(btScalar h) override;
  void updateActivationState(btScalar h) override;

 private:
  template <class Object, class Work>
  void for_each(const btAlignedObjectArray<Object*>& objects, Work&& work);
  void update_pairs(btTypedConstraint& joint);
  void update_pairs(btCollisionObject& object);
  void sleeping_step();
  void collect_awake();
  void solve_islands(const btContactSolverInfo& info);
  void solve_batch(int index, IslandSolver& solver, const btContactSolverInfo& info);
  void load_bodies(Islands::Range range, btScalar h);
  void move_batch(const Islands::Batch& batch, btScalar h, bool may_stop);
  bool move_bodies(Islands::Range range, btScalar h, bool may_stop);
  void end_joints(Islands::Range range, btScalar h, bool any_fast, bool may_stop);
  void move_fast_batches(btScalar h);

  std::atomic<bool> unstable_{false};
  bool first_substep_ = false;  // first and last substep of a tick
  bool last_substep_ = false;

  SleepTracker sleep_{*this};
  KinematicBodies kinematic_;
  btScalar step_length_ = 0;  // of the last substep, s
  btScalar tick_length_ = 0;

  AwakeObjects awake_;
  Islands islands_;  // of the present substep
  // scratch: proxies of objects that left their boxes; null for the others
  btAlignedObjectArray<btBroadphaseProxy*> left_aabb_;
};

}  // namespace limber::sim::bullet
