// IslandWorld: replaces stages of Bullet's step, and solves islands in batches.
#include "sim/bullet/island_world.h"

#include <algorithm>
#include <utility>

#include "base/memory/prefetch.h"
#include "sim/bullet/continuous_collision.h"
#include "sim/bullet/island_solver.h"
#include "sim/bullet/joints/coupled_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/bullet/rotation_step.h"
#include "sim/collision/dispatcher.h"
#include "sim/world/stability.h"

namespace limber::sim::bullet {
namespace {

/// A batch is complete with this many joints and contact pairs; results don't depend on it.
constexpr int kBatchConstraints = 16;
/// Least number of joints, contact pairs and bodies in a step for which threads are woken; results don't depend on it.
constexpr int kMinParallelWork = 128;
/// Number of objects to prefetch ahead.
constexpr int kObjectsAhead = 8;
/// Contact pairs per block of Bullet's pool.
constexpr int kManifoldPoolSize = 64;

void disable_bullet_gyroscopic_torque(btRigidBody& body) {
  body.setFlags(body.getFlags() & ~(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT | BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                    BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY));
}

void end_tick(btTypedConstraint& joint) {
  if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).end_tick();
  if (is_coupled(joint)) static_cast<CoupledConstraint&>(joint).end_tick();
}

// Advances the predicted angles of a joint with fast parts (rotation_step.h); `refresh`: also reads the joint's pose.
void predict_angles(btTypedConstraint& constraint, btScalar h, bool refresh) {
  if (constraint.getConstraintType() != JointConstraint::kType) return;
  JointConstraint& joint = static_cast<JointConstraint&>(constraint);
  joint.predict_angles(h);
  if (refresh) joint.refresh();
}

bool has_fast_body(const btAlignedObjectArray<btCollisionObject*>& bodies, Islands::Range range, btScalar h) {
  for (int i = range.first; i < range.end(); ++i) {
    if (ContinuousCollision::is_fast(static_cast<const btRigidBody&>(*bodies[i]), h)) return true;
  }
  return false;
}

}  // namespace

WorldParts::WorldParts(const WorldSetup& setup) : memory(BulletMemory::current()), thread_pool(setup.thread_pool) {
  // Bullet's default pools of 4096 contact pairs take 4 MB, which each checkpoint would have to compare with the
  // previous one. A smaller pool may be exceeded; this costs no measurable time (benchmark arms-1000).
  btDefaultCollisionConstructionInfo pools;
  pools.m_defaultMaxPersistentManifoldPoolSize = pools.m_defaultMaxCollisionAlgorithmPoolSize = kManifoldPoolSize;
  configuration = std::make_unique<btDefaultCollisionConfiguration>(pools);
  dispatcher = std::make_unique<collision::Dispatcher>(configuration.get());
  broadphase = std::make_unique<collision::Broadphase>(setup.broadphase_margin, setup.thread_pool.get());
  const BulletMemory::Scope heap(nullptr);
  continuous = std::make_unique<ContinuousCollision>();
  for (int i = 0; i < (setup.thread_pool ? setup.thread_pool->thread_count() : 1); ++i) {
    solvers.push_back(std::make_unique<IslandSolver>());
  }
}

WorldParts::~WorldParts() = default;

IslandWorld::IslandWorld(const WorldSetup& setup)
    : WorldParts(setup),
      btDiscreteDynamicsWorld(dispatcher.get(), broadphase.get(), solvers.front().get(), configuration.get()) {
  btContactSolverInfo& info = getSolverInfo();
  info.m_numIterations = setup.solver_iterations;
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = 0;
  info.m_minimumSolverBatchSize = kBatchConstraints;
  getDispatchInfo().m_useContinuous = false;
}

IslandWorld::~IslandWorld() = default;

// Calls work(i, object) for each object, in parallel if there is a thread pool; the order must not matter.
template <class Object, class Work>
void IslandWorld::for_each(const btAlignedObjectArray<Object*>& objects, Work&& work) {
  const int count = objects.size();
  parallel_for_ranges(thread_pool.get(), count, [&](int, int first, int end) {
    for (int i = first; i < end; ++i) {
      if (i + kObjectsAhead < count) prefetch(objects[i + kObjectsAhead], sizeof *objects[i]);
      work(i, *objects[i]);
    }
  });
}

void IslandWorld::step(double h, int substeps) {
  if (!(h > 0) || substeps <= 0) return;
  const BulletMemory::Scope scope(memory);
  const btScalar step_length = to_scalar(h);
  if (std::exchange(step_length_, step_length) != step_length) wake_all();
  tick_length_ = to_scalar(h * substeps);
  for (int i = 0; i < substeps; ++i) {
    first_substep_ = i == 0;
    last_substep_ = i + 1 == substeps;
    for (const auto& solver : solvers) solver->set_substep(substeps - i, substeps);
    kinematic_.wake(sleep_);
    if (awake_.valid(getNumCollisionObjects()) && awake_.empty() && !sleep_.any_wake_requested()) {
      sleeping_step();
    } else {
      internalSingleStepSimulation(step_length);
    }
  }
  first_substep_ = last_substep_ = false;
  kinematic_.end_tick();
  if (awake_.valid(getNumCollisionObjects()) && sleep_.end_tick(awake_)) awake_.invalidate();
}

// Internal step in which everything sleeps.
void IslandWorld::sleeping_step() {
  unstable_.store(false, std::memory_order_relaxed);
  if (m_internalTickCallback != nullptr) m_internalTickCallback(this, step_length_);
}

void IslandWorld::refresh_joints() {
  for_each(m_constraints, [](int, btTypedConstraint& joint) {
    if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).refresh();
  });
}

void IslandWorld::addConstraint(btTypedConstraint* constraint, bool disable_collisions) {
  const BulletMemory::Scope scope(memory);
  awake_.invalidate();
  sleep_.wake(constraint->getRigidBodyA());
  sleep_.wake(constraint->getRigidBodyB());
  btDiscreteDynamicsWorld::addConstraint(constraint, disable_collisions);
  if (disable_collisions) update_pairs(*constraint);
}

void IslandWorld::addRigidBody(btRigidBody* body) {
  const BulletMemory::Scope scope(memory);
  awake_.invalidate();
  disable_bullet_gyroscopic_torque(*body);
  btDiscreteDynamicsWorld::addRigidBody(body);
}

void IslandWorld::addRigidBody(btRigidBody* body, int group, int mask) {
  const BulletMemory::Scope scope(memory);
  awake_.invalidate();
  disable_bullet_gyroscopic_torque(*body);
  btDiscreteDynamicsWorld::addRigidBody(body, group, mask);
}

void IslandWorld::addCollisionObject(btCollisionObject* object, int group, int mask) {
  btDiscreteDynamicsWorld::addCollisionObject(object, group, mask);
  sleep_.add(*object);
}

void IslandWorld::removeRigidBody(btRigidBody* body) {
  awake_.invalidate();
  sleep_.remove(*body);
  btDiscreteDynamicsWorld::removeRigidBody(body);
}

void IslandWorld::wake_all() {
  if (sleep_.sleeping() > 0) awake_.invalidate();
  sleep_.wake_all();
}

void IslandWorld::setGravity(const btVector3& gravity) {
  if (gravity != getGravity()) wake_all();  // Bullet doesn't update sleeping bodies
  btDiscreteDynamicsWorld::setGravity(gravity);
}

void IslandWorld::set_filter(btCollisionObject& object, const CollisionFilter& filter) {
  if (filter.store(object)) update_pairs(object);
}

// Bullet's lists may contain an object more than once: each entry counts, including those of joints.
void IslandWorld::exclude_pair(btCollisionObject& a, btCollisionObject& b) {
  const BulletMemory::Scope scope(memory);
  a.setIgnoreCollisionCheck(&b, true);
  b.setIgnoreCollisionCheck(&a, true);
  update_pairs(a);
  update_pairs(b);
}

void IslandWorld::include_pair(btCollisionObject& a, btCollisionObject& b) {
  const BulletMemory::Scope scope(memory);
  a.setIgnoreCollisionCheck(&b, false);
  b.setIgnoreCollisionCheck(&a, false);
  update_pairs(a);
  update_pairs(b);
}

void IslandWorld::removeConstraint(btTypedConstraint* constraint) {
  const int count = m_constraints.size();
  const int index = m_constraints.findLinearSearch(constraint);
  if (index == count) return;
  awake_.invalidate();
  for (int i = index; i + 1 < count; ++i) m_constraints[i] = m_constraints[i + 1];
  m_constraints.pop_back();
  const BulletMemory::Scope scope(memory);
  constraint->getRigidBodyA().removeConstraintRef(constraint);
  constraint->getRigidBodyB().removeConstraintRef(constraint);
  sleep_.wake(constraint->getRigidBodyA());
  sleep_.wake(constraint->getRigidBodyB());
  update_pairs(*constraint);
}

// Called when the parts' permission to collide has changed.
void IslandWorld::update_pairs(btTypedConstraint& joint) {
  update_pairs(joint.getRigidBodyA());
  update_pairs(joint.getRigidBodyB());
}

void IslandWorld::update_pairs(btCollisionObject& object) {
  sleep_.wake(object);
  if (object.getBroadphaseHandle() == nullptr) return;
  const BulletMemory::Scope scope(memory);
  broadphase->update_pairs(object.getBroadphaseHandle());
}

// Prepares the step: wakes objects and updates the cached structure. Bodies are updated in solve_batch().
void IslandWorld::predictUnconstraintMotion(btScalar) {
  unstable_.store(false, std::memory_order_relaxed);
  if (sleep_.execute_wakes(!first_substep_)) awake_.invalidate();
  collect_awake();
  static_cast<collision::Dispatcher&>(*dispatcher).set_sleeping(sleep_.sleeping() > 0);
}
void IslandWorld::integrateTransforms(btScalar) {}

void IslandWorld::createPredictiveContacts(btScalar) {}  // see ContinuousCollision

void IslandWorld::updateAabbs() {
  BT_PROFILE("updateAabbs");
  collect_awake();
  const btAlignedObjectArray<btCollisionObject*>& objects = awake_.with_aabb();
  const int count = objects.size();
  left_aabb_.resizeNoInitialize(count);
  for_each(objects, [&](int i, btCollisionObject& object) {
    if (i + kObjectsAhead / 2 < count) collision::Broadphase::prefetch_proxy(*objects[i + kObjectsAhead / 2]);
    left_aabb_[i] = collision::Broadphase::refit_aabb(object, getDispatchInfo().m_timeStep)
                        ? object.getBroadphaseHandle()
                        : nullptr;
  });
  int left_count = 0;
  for (int i = 0; i < count; ++i) {
    if (left_aabb_[i] == nullptr) continue;
    if (objects[i]->isStaticObject()) sleep_.wake(*objects[i]);
    left_aabb_[left_count++] = left_aabb_[i];
  }
  if (sleep_.execute_wakes(!first_substep_)) awake_.invalidate();
  if (left_count > 0) broadphase->update_aabbs({&left_aabb_[0], static_cast<std::size_t>(left_count)});
}

void IslandWorld::updateActivationState(btScalar) { sleep_.end_substep(); }

void IslandWorld::collect_awake() {
  if (awake_.valid(getNumCollisionObjects())) return;
  awake_.collect(m_nonStaticRigidBodies, m_collisionObjects, m_constraints);
}

void IslandWorld::calculateSimulationIslands() {
  BT_PROFILE("calculateSimulationIslands");
  if (sleep_.wake_touched(!first_substep_)) awake_.invalidate();
  collect_awake();
  islands_.find(awake_, getPairCache()->getOverlappingPairArray());
  if (!last_substep_) return;
  for (int i = 0; i < islands_.static_joints().size(); ++i) end_tick(*islands_.static_joints()[i]);
}

void IslandWorld::solveConstraints(btContactSolverInfo& info) {
  islands_.find_contacts(awake_, *getDispatcher());
  // the direct solver counts and falls back per island
  islands_.make_batches(info.m_minimumSolverBatchSize, solvers.front()->direct_enabled());
  solve_islands(info);
  kinematic_.advance(static_cast<double>(info.m_timeStep), last_substep_);
}

// Does all the work of a step on the bodies and joints of one batch while they are in the cache.
void IslandWorld::solve_batch(int index, IslandSolver& solver, const btContactSolverInfo& info) {
  const Islands::Batch batch = islands_.batch(index);
  const auto first = [](auto& items, Islands::Range range) {
    return range.first < items.size() ? &items[range.first] : nullptr;
  };
  load_bodies(batch.bodies, info.m_timeStep);
  solver.direct().count_islands(batch.constrained_islands);
  solver.set_contacts_direct(batch.islands == 1 && batch.joints.count == 0 && batch.contacts.count > 0);
  solver.solveGroup(first(islands_.bodies(), batch.bodies), batch.bodies.count,
                    first(islands_.contacts(), batch.contacts), batch.contacts.count,
                    first(islands_.joints(), batch.joints), batch.joints.count, info, nullptr, getDispatcher());
  if (has_fast_body(islands_.bodies(), batch.bodies, info.m_timeStep)) {
    continuous->mark_fast(index);
  } else {
    move_batch(batch, info.m_timeStep, false);
  }
}

// `may_stop`: its bodies may stop before the end of the substep.
void IslandWorld::move_batch(const Islands::Batch& batch, btScalar h, bool may_stop) {
  const bool any_fast = move_bodies(batch.bodies, h, may_stop);
  end_joints(batch.joints, h, any_fast, may_stop);
}

// Moves the batches with fast bodies.
void IslandWorld::move_fast_batches(btScalar h) {
  if (!continuous->any_fast()) return;
  continuous->begin(awake_);
  for (int i = 0; i < islands_.batch_count(); ++i) {
    if (!continuous->is_fast_batch(i)) continue;
    const Islands::Range range = islands_.batch(i).bodies;
    for (int k = range.first; k < range.end(); ++k) {
      continuous->add(static_cast<btRigidBody&>(*islands_.bodies()[k]), h);
    }
  }
  continuous->find_stops(*broadphase, *dispatcher, h);
  for (int i = 0; i < islands_.batch_count(); ++i) {
    if (continuous->is_fast_batch(i)) move_batch(islands_.batch(i), h, true);
  }
}

void IslandWorld::load_bodies(Islands::Range range, btScalar h) {
  const btAlignedObjectArray<btCollisionObject*>& bodies = islands_.bodies();
  for (int i = range.first; i < range.end(); ++i) {
    // prefetch for the next batch, which takes about as long as this one
    if (i + range.count < bodies.size()) prefetch(bodies[i + range.count], sizeof(btRigidBody));
    btRigidBody& body = static_cast<btRigidBody&>(*bodies[i]);
    if (first_substep_) {
      body.applyGravity();
      reset_clamp(body);
    }
    if (body.getLinearDamping() != 0 || body.getAngularDamping() != 0) body.applyDamping(h);
  }
}

// Returns true if one of the bodies rotates too fast for its joints to count turns without prediction.
bool IslandWorld::move_bodies(Islands::Range range, btScalar h, bool may_stop) {
  bool any_fast = false;
  for (int i = range.first; i < range.end(); ++i) {
    btRigidBody& body = static_cast<btRigidBody&>(*islands_.bodies()[i]);
    if (!body.isActive() || body.isStaticOrKinematicObject()) continue;
    const double moved = static_cast<double>(may_stop ? h * continuous->stop(body) : h);
    const double clamped = move_body(body, moved);
    if (clamped > 0) record_clamp(body, clamped / moved);
    if (last_substep_) {
      body.clearForces();
      sleep_.observe(body, tick_length_);
    }
    any_fast =
        any_fast || static_cast<double>(body.getAngularVelocity().length2() * h * h) > kSlowRotation * kSlowRotation;
    if (find_instability(body, static_cast<double>(h)) != nullptr) unstable_.store(true, std::memory_order_relaxed);
  }
  return any_fast;
}

void IslandWorld::end_joints(Islands::Range range, btScalar h, bool any_fast, bool may_stop) {
  const btAlignedObjectArray<btTypedConstraint*>& joints = islands_.joints();
  for (int i = range.first; i < range.end(); ++i) {
    if (i + range.count < joints.size()) prefetch(joints[i + range.count], sizeof(JointConstraint));
    if (any_fast) predict_angles(*joints[i], may_stop ? h * continuous->stop(*joints[i]) : h, !last_substep_);
    if (last_substep_) end_tick(*joints[i]);
  }
}

// Islands share only static bodies, which solvers never write to.
void IslandWorld::solve_islands(const btContactSolverInfo& info) {
  const BulletMemory::Scope heap(nullptr);  // for the solvers' rows; threads of the pool have no other memory
  const int work = islands_.joints().size() + islands_.contacts().size() + islands_.bodies().size();
  continuous->reset_batches(islands_.batch_count());
  parallel_for(work >= kMinParallelWork ? thread_pool.get() : nullptr, islands_.batch_count(),
               [&](int batch, int thread) { solve_batch(batch, *solvers[static_cast<std::size_t>(thread)], info); });
  move_fast_batches(info.m_timeStep);
}

solver::DirectSolver& IslandWorld::direct() { return solvers.front()->direct(); }

void IslandWorld::set_direct(bool on) {
  for (const auto& solver : solvers) solver->set_direct(on);
}

solver::DirectCounts IslandWorld::direct_counts() const {
  solver::DirectCounts sum;
  for (const auto& solver : solvers) {
    const solver::DirectCounts& counts = solver->direct().counts();
    sum.islands += counts.islands;
    sum.direct += counts.direct;
    sum.too_large += counts.too_large;
    sum.fallbacks += counts.fallbacks;
  }
  return sum;
}

}  // namespace limber::sim::bullet
