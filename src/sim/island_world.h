// IslandWorld: Bullet's dynamics world with islands dispatched in linear time and in a stable order, and IslandSolver,
// which sets up the rows of our joints and hands back the impulses they applied.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/team.h"
#include "sim/broadphase.h"
#include "sim/bullet.h"
#include "sim/bullet_memory.h"
#include "sim/collision_filter.h"
#include "sim/contact_sweep.h"
#include "sim/gear_constraint.h"
#include "sim/island_direct.h"
#include "sim/joint_block.h"
#include "sim/joint_constraint.h"
#include "sim/sleep.h"

namespace limber {

/// How a world is made; see performance notes of each for what it buys.
struct WorldSetup {
  double broadphase_margin = 0.01;  ///< Metres that bounding boxes are fattened by.
  int solver_iterations = 50;
  std::shared_ptr<Team> team{};  ///< Shares out a step, with the same result; null: this thread alone.
};

/// Sequential impulses with joint rows of our own making: softness in physical units (a row is
/// rate + softness·impulse = velocity), stable for any softness. And with gyroscopic torques, which Bullet leaves out
/// for light bodies (its 3x3 solver takes determinants under 1.2e-7 for zero). [sim]
class IslandSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  void set_direct(bool on) { direct_wanted_ = on; }
  bool direct_wanted() const { return direct_wanted_; }
  /// Of the `count` internal steps of a tick, `left` are still to come, the present one included.
  void set_substep(int left, int count) {
    steps_left_ = left;
    step_count_ = count;
  }
  /// Of the islands that come next: whether one without joints goes to the direct solver, too.
  void set_contacts_direct(bool on) { contacts_direct_ = on; }
  IslandDirect& direct() { return direct_; }
  const IslandDirect& direct() const { return direct_; }

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
  void make_room(int joints);
  void plan(JointConstraint& joint, const btContactSolverInfo& info);
  bool plan_direct(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_all(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_rows(JointConstraint& joint, btSolverConstraint* rows, int count, const btContactSolverInfo& info);
  JointBlock& add_rows(const btSolverConstraint* rows, int count, bool bounded, int locked);
  void plan_gears(btTypedConstraint** constraints, int count, const btContactSolverInfo& info);
  void convert_gears(const btContactSolverInfo& info);
  btScalar sweep_joints();
  void convert_contact(btPersistentManifold& manifold, const btContactSolverInfo& info);
  void convert_rolling(btManifoldPoint& point, int contact, int id_a, int id_b, btScalar pressing);
  btScalar sweep_gear(int gear);
  btScalar sweep_rolling();
  void remember_rolling_friction();

  struct JointRows {  // of one joint: `scalar` rows from `first` on, then those of the block
    int first;
    int scalar;
    int body_a;
    int body_b;
    JointBlock block;
  };
  struct GearSide {  // a body's part of the row's rate, and its change of velocity per impulse
    btVector3 linear, angular;
    btVector3 linear_per_impulse, angular_per_impulse;
  };
  struct GearRow {
    GearConstraint* gear;
    std::array<int, 4> bodies;
    std::array<GearSide, 4> sides;
    int count;
    btScalar wanted;  // rate that is missing without impulses of this step
    btScalar softness;
    btScalar step;  // impulse per missing rate
    btScalar bound;
    btScalar impulse;
  };
  void push_gear(const GearRow& row, btScalar impulse);

  std::vector<GearRow> gears_;  // of the island at hand
  bool gears_swept_ = false;
  std::vector<JointConstraint::Row> planned_;  // of the joints at hand, those of one behind those of another
  std::size_t planned_count_ = 0;
  btAlignedObjectArray<JointRows> joints_;
  ContactSweep contacts_;
  IslandDirect direct_;
  int steps_left_ = 1;
  int step_count_ = 1;
  bool direct_wanted_ = false;
  bool contacts_direct_ = false;
  bool direct_here_ = false;  // in the island at hand
};

/// What a world is made of; a base of IslandWorld so that it outlives Bullet's part.
struct WorldParts {
  explicit WorldParts(const WorldSetup& setup);
  BulletMemory* memory;  ///< Of the scope that it was made in, or null.
  std::unique_ptr<btDefaultCollisionConfiguration> configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher;
  std::unique_ptr<Broadphase> broadphase;
  /// One for each of the team's members; on the heap: nothing of them outlives a step.
  std::vector<std::unique_ptr<IslandSolver>> solvers;
  std::shared_ptr<Team> team;
};

/// Joints and contacts of an island are solved in an order that depends on that island alone (joints as added,
/// contacts by the parts' age), so an island moves the same, bit for bit, alone or among others. Bodies are the
/// caller's, without motion states, are not kinematic, and have no continuous collision; they sleep (sleep.h) where
/// SleepTracker::allow() lets them. What it keeps from step to step lies in the memory of the BulletMemory::Scope that
/// it was made in. [sim]
class IslandWorld : private WorldParts, public btDiscreteDynamicsWorld {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  explicit IslandWorld(const WorldSetup& setup = {});
  ~IslandWorld() override;

  /// One tick: `substeps` equal internal steps of `h` seconds each. Forces applied before act on all of them and are
  /// cleared at the end, as are the joints' averages. Does nothing unless h > 0 and substeps > 0.
  void step(double h, int substeps);

  /// Joints keep the order in which they were added, whatever is removed between. By default the joined parts stop
  /// colliding with each other, at once, and collide again when their last such joint is removed.
  void addConstraint(btTypedConstraint* constraint, bool disable_collisions = true) override;
  void removeConstraint(btTypedConstraint* constraint) override;
  void addRigidBody(btRigidBody* body) override;
  void addRigidBody(btRigidBody* body, int group, int mask) override;
  void removeRigidBody(btRigidBody* body) override;
  void addCollisionObject(btCollisionObject* object, int group, int mask) override;
  /// Wakes everything when it differs.
  void setGravity(const btVector3& gravity) override;

  /// Nothing sleeps any more.
  void wake_all();
  SleepTracker& sleep() { return sleep_; }
  const SleepTracker& sleep() const { return sleep_; }

  /// With which other objects this one may collide, from the next step on.
  void set_filter(btCollisionObject& object, const CollisionFilter& filter);
  /// Keeps two objects from colliding, from the next step on, or lets them collide again; independent of joints that
  /// connect them. Calls must alternate: each `exclude` needs one `include`.
  void exclude_pair(btCollisionObject& a, btCollisionObject& b);
  void include_pair(btCollisionObject& a, btCollisionObject& b);

  /// Joints' rates anew, where velocities were changed in an internal step's callback.
  void refresh_joints();

  /// Whether a part is beyond what is healthy (health.h) since the internal step at hand.
  bool ails() const { return ails_.load(std::memory_order_relaxed); }

  /// From the next step on: joints exactly, as trees; or everything by sweeps.
  void set_direct(bool on);
  /// Since the world was made.
  DirectCounts direct_counts() const;
  /// Of the islands that this thread solves: all, without a team.
  IslandDirect& direct() { return solvers.front()->direct(); }

 protected:
  void predictUnconstraintMotion(btScalar h) override;
  void createPredictiveContacts(btScalar h) override;
  void updateAabbs() override;
  void calculateSimulationIslands() override;
  void solveConstraints(btContactSolverInfo& info) override;
  void integrateTransforms(btScalar h) override;
  void updateActivationState(btScalar h) override;

 private:
  struct Touch {  // a contact manifold and its place in the order
    int island;
    int first;
    int second;
    btPersistentManifold* manifold;
  };

  template <class Object, class Work>
  void for_each(const btAlignedObjectArray<Object*>& objects, Work&& work);
  void look_anew(btTypedConstraint& joint);
  void look_anew(btCollisionObject& object);
  void rest_step();
  int place_of(const btCollisionObject& object) const { return places_[object.getWorldArrayIndex()]; }
  static int root_of(btAlignedObjectArray<int>& above, int place);
  static void unite(btAlignedObjectArray<int>& above, int a, int b);
  void learn_joints();
  void sort_bodies();
  void sort_joints();
  void sort_contacts();
  /// Whether an island has joints or contacts.
  bool has_work(int island) const {
    return joint_start_[island + 1] > joint_start_[island] || contact_start_[island + 1] > contact_start_[island];
  }
  void gather_batches(int least);
  void solve_islands(const btContactSolverInfo& info);
  void solve_batch(int batch, IslandSolver& solver, const btContactSolverInfo& info);
  void load_bodies(int first, int last, btScalar h);
  void move_bodies(int first, int last, btScalar h);

  std::atomic<bool> ails_{false};
  bool first_ = false;  // of a tick's internal steps, and the last
  bool last_ = false;

  SleepTracker sleep_{*this};
  btScalar step_length_ = 0;  // of the last step
  btScalar tick_length_ = 0;

  // What only bodies and joints that come, go, wake or fall asleep change: places of bodies in awake_, -1 of the
  // others.
  struct Ends {
    int a;
    int b;
  };
  bool joints_known_ = false;
  btAlignedObjectArray<btRigidBody*> awake_;         // of m_nonStaticRigidBodies, in their order
  btAlignedObjectArray<btCollisionObject*> looked_;  // these and what stands
  btAlignedObjectArray<btTypedConstraint*> linked_;  // joints of these, or of nothing that can move
  btAlignedObjectArray<int> places_;                 // by object
  btAlignedObjectArray<Ends> ends_;                  // by joint in linked_
  btAlignedObjectArray<int> joined_;                 // by body: union-find

  // Scratch of one internal step, kept so that nothing is allocated once the scene stands. Items of island i are
  // bodies_[body_start_[i]] up to bodies_[body_start_[i + 1]], and so on.
  int island_count_ = 0;
  btAlignedObjectArray<int> above_;   // by body: union-find, with what meets
  btAlignedObjectArray<int> island_;  // by body
  btAlignedObjectArray<int> body_start_;
  btAlignedObjectArray<int> joint_start_;
  btAlignedObjectArray<int> island_of_root_;
  btAlignedObjectArray<int> contact_start_;
  btAlignedObjectArray<int> cursor_;
  btAlignedObjectArray<btCollisionObject*> bodies_;
  btAlignedObjectArray<btTypedConstraint*> joints_;
  btAlignedObjectArray<Touch> touches_;
  btAlignedObjectArray<btPersistentManifold*> contacts_;
  btAlignedObjectArray<btBroadphaseProxy*> left_;  // of each object that has left its box; null: of the others
  btAlignedObjectArray<int> batches_;              // islands of batch i: batches_[i] up to batches_[i + 1]
};

}  // namespace limber
