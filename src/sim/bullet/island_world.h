// IslandWorld: Bullet's dynamics world with islands found in linear time and solved in a stable order. IslandSolver:
// sets up the constraint rows of the joints and contacts of an island, solves them, and stores the joints' impulses.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/threads/thread_pool.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/bullet_memory.h"
#include "sim/bullet/collision_filter.h"
#include "sim/bullet/contact_sweep.h"
#include "sim/bullet/gear_constraint.h"
#include "sim/bullet/joint_block.h"
#include "sim/bullet/joint_constraint.h"
#include "sim/bullet/sleep.h"
#include "sim/collision/broadphase.h"
#include "sim/solver/direct_solver.h"
#include "sim/world/world_setup.h"

namespace limber {

/// Sequential impulses with our own joint rows, whose softness has physical units (rate + softness·impulse = velocity)
/// and which are stable for any softness. Also applies gyroscopic torques, which Bullet omits for light bodies (its 3x3
/// solver treats determinants below 1.2e-7 as zero). [sim]
class IslandSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  void set_direct(bool on) { direct_enabled_ = on; }
  bool direct_enabled() const { return direct_enabled_; }
  /// Sets the number of internal steps per tick, and of those that are left, the current one included.
  void set_substep(int steps_left, int count) {
    steps_left_ = steps_left;
    step_count_ = count;
  }
  /// True: the next islands use the direct solver even if they have no joints.
  void set_contacts_direct(bool on) { contacts_direct_ = on; }
  DirectSolver& direct() { return direct_; }
  const DirectSolver& direct() const { return direct_; }

 protected:
  void convertBodies(btCollisionObject** bodies, int count, const btContactSolverInfo& info) override;
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  void convertJoints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  void solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject** bodies, int body_count,
                                                     btPersistentManifold** manifolds, int manifold_count,
                                                     btTypedConstraint** constraints, int constraint_count,
                                                     const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  void reserve_rows(int joints);
  void plan(JointConstraint& joint, const btContactSolverInfo& info);
  bool plan_direct(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_constraints(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_rows(JointConstraint& joint, btSolverConstraint* rows, int count, const btContactSolverInfo& info);
  JointBlock& add_rows(const btSolverConstraint* rows, int count, bool bounded, int locked);
  void plan_gears(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_gears(const btContactSolverInfo& info);
  btScalar sweep_joints();
  void convert_contact(btPersistentManifold& manifold, const btContactSolverInfo& info);
  void convert_rolling(btManifoldPoint& point, int contact, int id_a, int id_b, btScalar last_normal_impulse);
  btScalar sweep_gear(int gear);
  btScalar sweep_rolling();
  void save_rolling_friction();

  struct JointRows {  // of one joint: `scalar` single rows from `first` on, then the rows of the block
    int first;
    int scalar;
    int body_a;
    int body_b;
    JointBlock block;
  };
  struct GearSide {  // Jacobian with respect to a body, and the body's velocity change per impulse
    btVector3 linear, angular;
    btVector3 linear_per_impulse, angular_per_impulse;
  };
  struct GearRow {
    GearConstraint* gear;
    FixedArray<int, 4> bodies;
    FixedArray<GearSide, 4> sides;
    int count;
    btScalar target_rate;  // rate that is missing without the impulses of this step
    btScalar softness;
    btScalar step;  // impulse per missing rate
    btScalar bound;
    btScalar impulse;
  };
  void apply_gear_impulse(const GearRow& row, btScalar impulse);

  IndexedArray<GearRow> gears_;  // of the present island
  bool gears_swept_ = false;
  IndexedArray<JointConstraint::Row> planned_;  // of all joints of the island, in their order
  int planned_count_ = 0;
  btAlignedObjectArray<JointRows> joints_;
  ContactSweep contacts_;
  DirectSolver direct_;
  int steps_left_ = 1;
  int step_count_ = 1;
  bool direct_enabled_ = false;
  bool contacts_direct_ = false;
  bool use_direct_ = false;  // in the present island
};

/// Components of a world. IslandWorld inherits them first, so that they are constructed before and destroyed after
/// Bullet's world, which refers to them.
struct WorldParts {
  explicit WorldParts(const WorldSetup& setup);
  BulletMemory* memory;  ///< Of the scope at construction, or null.
  std::unique_ptr<btDefaultCollisionConfiguration> configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher;
  std::unique_ptr<Broadphase> broadphase;
  /// One per thread; on the heap, because their data lives for one step only.
  std::vector<std::unique_ptr<IslandSolver>> solvers;
  std::shared_ptr<ThreadPool> thread_pool;
};

/// Joints and contacts of an island are solved in an order that depends on that island alone (joints in the order of
/// their creation, contacts by the age of the parts), so an island moves bit-identically whether alone or among others.
/// Bodies belong to the caller; they have no motion states, are not kinematic, and have no continuous collision
/// detection. They sleep (sleep.h) if SleepTracker::allow() permits it. Persistent data is allocated in the memory of
/// the BulletMemory::Scope at construction. [sim]
class IslandWorld : private WorldParts, public btDiscreteDynamicsWorld {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  explicit IslandWorld(const WorldSetup& setup = {});
  ~IslandWorld() override;

  /// One tick: `substeps` equal internal steps of `h` seconds each. Forces applied before it act during all of them and
  /// are cleared at its end, as are the joints' averages. Does nothing unless h > 0 and substeps > 0.
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

  /// Sets which other objects this one may collide with, from the next step on.
  void set_filter(btCollisionObject& object, const CollisionFilter& filter);
  /// Excludes two objects from colliding with each other from the next step on, or includes them again; independent of
  /// joints that connect them. Calls must alternate: each exclude_pair() needs one include_pair().
  void exclude_pair(btCollisionObject& a, btCollisionObject& b);
  void include_pair(btCollisionObject& a, btCollisionObject& b);

  /// Reads the joints' rates again; to be called if velocities were changed in an internal step's callback.
  void refresh_joints();

  /// True if a part has been unstable (health.h) since the present internal step began.
  bool is_unstable() const { return unstable_.load(std::memory_order_relaxed); }

  /// Selects the direct solver (true) or the iterative one for all islands, from the next step on.
  void set_direct(bool on);
  /// Counts since the world was created.
  DirectCounts direct_counts() const;
  /// Solver of the calling thread; it solves all islands if there is no thread pool.
  DirectSolver& direct() { return solvers.front()->direct(); }

 protected:
  void predictUnconstraintMotion(btScalar h) override;
  void createPredictiveContacts(btScalar h) override;
  void updateAabbs() override;
  void calculateSimulationIslands() override;
  void solveConstraints(btContactSolverInfo& info) override;
  void integrateTransforms(btScalar h) override;
  void updateActivationState(btScalar h) override;

 private:
  struct OrderedManifold {  // a contact manifold and its position in the solving order
    int island;
    int first;
    int second;
    btPersistentManifold* manifold;
  };

  template <class Object, class Work>
  void for_each(const btAlignedObjectArray<Object*>& objects, Work&& work);
  void update_pairs(btTypedConstraint& joint);
  void update_pairs(btCollisionObject& object);
  void sleeping_step();
  int awake_index(const btCollisionObject& object) const { return awake_index_[object.getWorldArrayIndex()]; }
  static int root_of(btAlignedObjectArray<int>& parent, int index);
  static void unite(btAlignedObjectArray<int>& parent, int a, int b);
  void cache_structure();
  void sort_bodies();
  void sort_joints();
  void sort_contacts();
  /// True if an island has joints or contacts.
  bool has_work(int island) const {
    return joint_start_[island + 1] > joint_start_[island] || contact_start_[island + 1] > contact_start_[island];
  }
  void gather_batches(int min_work);
  void solve_islands(const btContactSolverInfo& info);
  void solve_batch(int batch, IslandSolver& solver, const btContactSolverInfo& info);
  void load_bodies(int first, int last, btScalar h);
  void move_bodies(int first, int last, btScalar h);

  std::atomic<bool> unstable_{false};
  bool first_substep_ = false;  // first and last internal step of a tick
  bool last_substep_ = false;

  SleepTracker sleep_{*this};
  btScalar step_length_ = 0;  // of the last internal step, s
  btScalar tick_length_ = 0;

  // Cached structure; changes only when bodies and joints are added, removed, woken or put to sleep.
  struct JointBodies {  // indices in awake_; -1: static
    int a;
    int b;
  };
  bool structure_cached_ = false;
  btAlignedObjectArray<btRigidBody*> awake_;               // of m_nonStaticRigidBodies, in their order
  btAlignedObjectArray<btCollisionObject*> with_aabb_;     // awake and static objects, whose bounding boxes are updated
  btAlignedObjectArray<btTypedConstraint*> awake_joints_;  // joints of awake bodies, or of none that can move
  btAlignedObjectArray<int> awake_index_;                  // by object: index in awake_, or -1
  btAlignedObjectArray<JointBodies> joint_bodies_;         // by joint in awake_joints_
  btAlignedObjectArray<int> joint_parent_;                 // by body: union-find over joints

  // Scratch of one internal step, reused to avoid allocation. Items of island i are bodies_[body_start_[i]] up to
  // bodies_[body_start_[i + 1]], and so on.
  int island_count_ = 0;
  btAlignedObjectArray<int> parent_;  // by body: union-find over joints and overlapping pairs
  btAlignedObjectArray<int> island_;  // by body
  btAlignedObjectArray<int> body_start_;
  btAlignedObjectArray<int> joint_start_;
  btAlignedObjectArray<int> island_of_root_;
  btAlignedObjectArray<int> contact_start_;
  btAlignedObjectArray<int> cursor_;
  btAlignedObjectArray<btCollisionObject*> bodies_;
  btAlignedObjectArray<btTypedConstraint*> joints_;
  btAlignedObjectArray<OrderedManifold> ordered_manifolds_;
  btAlignedObjectArray<btPersistentManifold*> contacts_;
  btAlignedObjectArray<btBroadphaseProxy*> left_aabb_;  // proxies of objects that left their boxes; null for the others
  btAlignedObjectArray<int> batches_;                   // islands of batch i: batches_[i] up to batches_[i + 1]
};

}  // namespace limber
