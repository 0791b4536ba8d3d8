// IslandWorld: finds islands, sorts their bodies, joints and contacts by counting, and solves them in batches.
#include "sim/bullet/island_world.h"

#include <algorithm>
#include <utility>

#include "base/memory/prefetch.h"
#include "sim/bullet/spin.h"
#include "sim/collision/dispatcher.h"
#include "sim/world/stability.h"

namespace limber {
namespace {

/// A batch is complete with this many joints and contact pairs, or this many bodies; results don't depend on it.
constexpr int kBatchConstraints = 16;
constexpr int kBatchBodies = 64;
/// Least number of joints, contact pairs and bodies in a step for which threads are woken; results don't depend on it.
constexpr int kMinParallelWork = 128;
/// Number of objects to prefetch ahead.
constexpr int kObjectsAhead = 8;
/// Contact pairs per block of Bullet's pool.
constexpr int kManifoldPoolSize = 64;

// Turns counts per island in start[1..] into start indices and copies them to cursor.
void to_start_indices(btAlignedObjectArray<int>& start, btAlignedObjectArray<int>& cursor) {
  for (int i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  cursor.copyFromArray(start);
}

void fill_with_zeros(btAlignedObjectArray<int>& a, int size) {
  a.resizeNoInitialize(size);
  for (int i = 0; i < size; ++i) a[i] = 0;
}

void disable_bullet_gyroscopic_torque(btRigidBody& body) {
  body.setFlags(body.getFlags() & ~(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT | BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                    BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY));
}

void end_tick(btTypedConstraint& joint) {
  if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).end_tick();
  if (is_gear(joint)) static_cast<GearConstraint&>(joint).end_tick();
}

// Advances the predicted angles of a joint with fast parts (spin.h); `refresh`: also reads the joint's pose.
void predict_angles(btTypedConstraint& constraint, btScalar h, bool refresh) {
  if (constraint.getConstraintType() != JointConstraint::kType) return;
  JointConstraint& joint = static_cast<JointConstraint&>(constraint);
  joint.predict_angles(h);
  if (refresh) joint.refresh();
}

}  // namespace

WorldParts::WorldParts(const WorldSetup& setup) : memory(BulletMemory::current()), thread_pool(setup.thread_pool) {
  // Bullet's default pools of 4096 contact pairs take 4 MB, which each checkpoint would have to compare; exceeding a
  // smaller pool costs no measurable time (arms-1000)
  btDefaultCollisionConstructionInfo pools;
  pools.m_defaultMaxPersistentManifoldPoolSize = pools.m_defaultMaxCollisionAlgorithmPoolSize = kManifoldPoolSize;
  configuration = std::make_unique<btDefaultCollisionConfiguration>(pools);
  dispatcher = std::make_unique<Dispatcher>(configuration.get());
  broadphase = std::make_unique<Broadphase>(setup.broadphase_margin, setup.thread_pool.get());
  const BulletMemory::Scope heap(nullptr);
  for (int i = 0; i < (setup.thread_pool ? setup.thread_pool->thread_count() : 1); ++i) {
    solvers.push_back(std::make_unique<IslandSolver>());
  }
}

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
    if (structure_cached_ && awake_.size() == 0 && awake_joints_.size() == 0 && !sleep_.any_wake_requested()) {
      sleeping_step();
    } else {
      internalSingleStepSimulation(step_length);
    }
  }
  first_substep_ = last_substep_ = false;
  if (structure_cached_ && sleep_.end_tick({awake_index_, awake_, awake_joints_})) structure_cached_ = false;
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
  structure_cached_ = false;
  sleep_.wake(constraint->getRigidBodyA());
  sleep_.wake(constraint->getRigidBodyB());
  btDiscreteDynamicsWorld::addConstraint(constraint, disable_collisions);
  if (disable_collisions) update_pairs(*constraint);
}

void IslandWorld::addRigidBody(btRigidBody* body) {
  const BulletMemory::Scope scope(memory);
  structure_cached_ = false;
  disable_bullet_gyroscopic_torque(*body);
  btDiscreteDynamicsWorld::addRigidBody(body);
}

void IslandWorld::addRigidBody(btRigidBody* body, int group, int mask) {
  const BulletMemory::Scope scope(memory);
  structure_cached_ = false;
  disable_bullet_gyroscopic_torque(*body);
  btDiscreteDynamicsWorld::addRigidBody(body, group, mask);
}

void IslandWorld::addCollisionObject(btCollisionObject* object, int group, int mask) {
  btDiscreteDynamicsWorld::addCollisionObject(object, group, mask);
  sleep_.add(*object);
}

void IslandWorld::removeRigidBody(btRigidBody* body) {
  structure_cached_ = false;
  sleep_.remove(*body);
  btDiscreteDynamicsWorld::removeRigidBody(body);
}

void IslandWorld::wake_all() {
  if (sleep_.sleeping() > 0) structure_cached_ = false;
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
  structure_cached_ = false;
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
  if (sleep_.execute_wakes(!first_substep_)) structure_cached_ = false;
  if (!structure_cached_) cache_structure();
  static_cast<Dispatcher&>(*dispatcher).set_sleeping(sleep_.sleeping() > 0);
}
void IslandWorld::integrateTransforms(btScalar) {}

void IslandWorld::createPredictiveContacts(btScalar) {}  // no continuous collision

void IslandWorld::updateAabbs() {
  BT_PROFILE("updateAabbs");
  if (!structure_cached_ || awake_index_.size() != getNumCollisionObjects()) cache_structure();
  const int count = with_aabb_.size();
  left_aabb_.resizeNoInitialize(count);
  for_each(with_aabb_, [&](int i, btCollisionObject& object) {
    if (i + kObjectsAhead / 2 < count) Broadphase::prefetch_proxy(*with_aabb_[i + kObjectsAhead / 2]);
    left_aabb_[i] =
        Broadphase::left_aabb(object, getDispatchInfo().m_timeStep) ? object.getBroadphaseHandle() : nullptr;
  });
  int left_count = 0;
  for (int i = 0; i < count; ++i) {
    if (left_aabb_[i] == nullptr) continue;
    if (with_aabb_[i]->isStaticObject()) sleep_.wake(*with_aabb_[i]);
    left_aabb_[left_count++] = left_aabb_[i];
  }
  if (sleep_.execute_wakes(!first_substep_)) structure_cached_ = false;
  if (left_count > 0) broadphase->update_aabbs({&left_aabb_[0], static_cast<std::size_t>(left_count)});
}

void IslandWorld::updateActivationState(btScalar) { sleep_.end_step(); }

void IslandWorld::solveConstraints(btContactSolverInfo& info) {
  sort_contacts();
  gather_batches(info.m_minimumSolverBatchSize);
  solve_islands(info);
}

int IslandWorld::root_of(btAlignedObjectArray<int>& parent, int index) {
  while (parent[index] != index) index = parent[index] = parent[parent[index]];
  return index;
}

void IslandWorld::unite(btAlignedObjectArray<int>& parent, int a, int b) {
  if (a >= 0 && b >= 0) parent[root_of(parent, a)] = root_of(parent, b);
}

// Caches the structure of the world, so that steps don't iterate over all objects.
void IslandWorld::cache_structure() {
  awake_index_.resizeNoInitialize(getNumCollisionObjects());
  for (int i = 0; i < awake_index_.size(); ++i) awake_index_[i] = -1;
  awake_.resizeNoInitialize(0);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    awake_index_[body.getWorldArrayIndex()] = awake_.size();
    awake_.push_back(&body);
  }
  const auto is_asleep = [](const btCollisionObject& object) { return !object.isStaticObject() && !object.isActive(); };
  with_aabb_.resizeNoInitialize(0);
  for (int i = 0; i < m_collisionObjects.size(); ++i) {
    if (!is_asleep(*m_collisionObjects[i])) with_aabb_.push_back(m_collisionObjects[i]);
  }
  joint_parent_.resizeNoInitialize(awake_.size());
  for (int i = 0; i < joint_parent_.size(); ++i) joint_parent_[i] = i;
  joint_bodies_.resizeNoInitialize(0);
  awake_joints_.resizeNoInitialize(0);
  for (int i = 0; i < m_constraints.size(); ++i) {
    const btRigidBody& a = m_constraints[i]->getRigidBodyA();
    const btRigidBody& b = m_constraints[i]->getRigidBodyB();
    if (is_asleep(a) || is_asleep(b)) continue;
    joint_bodies_.push_back({awake_index(a), awake_index(b)});
    awake_joints_.push_back(m_constraints[i]);
    unite(joint_parent_, awake_index(a), awake_index(b));
  }
  structure_cached_ = true;
}

// Unites bodies that are joined or whose boxes overlap.
void IslandWorld::calculateSimulationIslands() {
  BT_PROFILE("calculateSimulationIslands");
  if (sleep_.wake_touched(!first_substep_)) structure_cached_ = false;
  if (!structure_cached_ || awake_index_.size() != getNumCollisionObjects()) cache_structure();
  parent_.copyFromArray(joint_parent_);
  const btBroadphasePairArray& pairs = getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    const auto index_of = [&](const btBroadphaseProxy* proxy) {
      return awake_index(*static_cast<const btCollisionObject*>(proxy->m_clientObject));
    };
    unite(parent_, index_of(pairs[i].m_pProxy0), index_of(pairs[i].m_pProxy1));
  }
  sort_bodies();
  sort_joints();
}

void IslandWorld::sort_bodies() {
  // islands are numbered in the order of their first body
  const int count = awake_.size();
  island_of_root_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) island_of_root_[i] = -1;
  island_.resizeNoInitialize(count);
  island_count_ = 0;
  fill_with_zeros(body_start_, count + 1);
  for (int i = 0; i < count; ++i) {
    int& island = island_of_root_[root_of(parent_, i)];
    if (island < 0) island = island_count_++;
    island_[i] = island;
    ++body_start_[island + 1];
  }
  body_start_.resizeNoInitialize(island_count_ + 1);
  to_start_indices(body_start_, cursor_);
  bodies_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) bodies_[cursor_[island_[i]]++] = awake_[i];
}

void IslandWorld::sort_joints() {
  const int count = awake_joints_.size();
  const auto island = [&](int joint) {
    const JointBodies& bodies = joint_bodies_[joint];
    return bodies.a < 0 && bodies.b < 0 ? -1 : island_[bodies.a >= 0 ? bodies.a : bodies.b];
  };
  fill_with_zeros(joint_start_, island_count_ + 1);
  for (int i = 0; i < count; ++i) {
    if (island(i) >= 0) ++joint_start_[island(i) + 1];
  }
  to_start_indices(joint_start_, cursor_);
  joints_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    if (island(i) >= 0) {
      joints_[cursor_[island(i)]++] = awake_joints_[i];
    } else if (last_substep_) {
      end_tick(*awake_joints_[i]);
    }
  }
}

void IslandWorld::sort_contacts() {
  btDispatcher* dispatch = getDispatcher();
  ordered_manifolds_.resizeNoInitialize(0);
  const int manifolds = dispatch->getNumManifolds();
  for (int i = 0; i < manifolds; ++i) {
    if (i + kObjectsAhead < manifolds) prefetch_end(*dispatch->getManifoldByIndexInternal(i + kObjectsAhead));
    btPersistentManifold* manifold = dispatch->getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() == 0) continue;
    const btCollisionObject* a = manifold->getBody0();
    const btCollisionObject* b = manifold->getBody1();
    const int index = std::max(awake_index(*a), awake_index(*b));
    if (index < 0 || !dispatch->needsResponse(a, b)) continue;
    ordered_manifolds_.push_back(
        {island_[index], a->getBroadphaseHandle()->m_uniqueId, b->getBroadphaseHandle()->m_uniqueId, manifold});
  }
  // Bullet's order of manifolds depends on the history of all islands; the age of the parts doesn't
  const int count = ordered_manifolds_.size();
  if (count > 1) {
    std::sort(&ordered_manifolds_[0], &ordered_manifolds_[0] + count,
              [](const OrderedManifold& x, const OrderedManifold& y) {
                if (x.island != y.island) return x.island < y.island;
                return x.first != y.first ? x.first < y.first : x.second < y.second;
              });
  }
  fill_with_zeros(contact_start_, island_count_ + 1);
  contacts_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    contacts_[i] = ordered_manifolds_[i].manifold;
    ++contact_start_[ordered_manifolds_[i].island + 1];
  }
  to_start_indices(contact_start_, cursor_);
}

void IslandWorld::gather_batches(int min_work) {
  batches_.resizeNoInitialize(0);
  batches_.push_back(0);
  for (int last = 1; last <= island_count_; ++last) {
    const int first = batches_[batches_.size() - 1];
    const int joints = joint_start_[last] - joint_start_[first];
    const int contacts = contact_start_[last] - contact_start_[first];
    // the direct solver counts and falls back per island
    const bool one_island =
        solvers.front()->direct_enabled() && (joints + contacts > 0 || (last < island_count_ && has_work(last)));
    const int bodies = body_start_[last] - body_start_[first];
    if (one_island || joints + contacts >= min_work || bodies >= kBatchBodies || last == island_count_)
      batches_.push_back(last);
  }
}

// Does all the work of a step on the bodies and joints of one batch while they are in the cache.
void IslandWorld::solve_batch(int batch, IslandSolver& solver, const btContactSolverInfo& info) {
  const auto range = [](auto& items, int first) { return first < items.size() ? &items[first] : nullptr; };
  const int first = batches_[batch];
  const int last = batches_[batch + 1];
  const auto count = [&](const btAlignedObjectArray<int>& start) { return start[last] - start[first]; };
  load_bodies(first, last, info.m_timeStep);
  for (int island = first; island < last; ++island) {
    if (has_work(island)) solver.direct().count_islands(1);
  }
  solver.set_contacts_direct(last - first == 1 && count(joint_start_) == 0 && count(contact_start_) > 0);
  solver.solveGroup(range(bodies_, body_start_[first]), count(body_start_), range(contacts_, contact_start_[first]),
                    count(contact_start_), range(joints_, joint_start_[first]), count(joint_start_), info, nullptr,
                    getDispatcher());
  move_bodies(first, last, info.m_timeStep);
}

void IslandWorld::load_bodies(int first, int last, btScalar h) {
  const int batch_size = body_start_[last] - body_start_[first];
  for (int i = body_start_[first]; i < body_start_[last]; ++i) {
    // prefetch for the next batch, which takes about as long as this one
    if (i + batch_size < body_start_[island_count_]) prefetch(bodies_[i + batch_size], sizeof(btRigidBody));
    btRigidBody& body = static_cast<btRigidBody&>(*bodies_[i]);
    if (first_substep_) {
      body.applyGravity();
      reset_clamp(body);
    }
    if (body.getLinearDamping() != 0 || body.getAngularDamping() != 0) body.applyDamping(h);
  }
}

void IslandWorld::move_bodies(int first, int last, btScalar h) {
  bool any_fast = false;
  for (int i = body_start_[first]; i < body_start_[last]; ++i) {
    btRigidBody& body = static_cast<btRigidBody&>(*bodies_[i]);
    if (!body.isActive() || body.isStaticOrKinematicObject()) continue;
    const double clamped = move_body(body, static_cast<double>(h));
    if (clamped > 0) record_clamp(body, clamped / static_cast<double>(h));
    if (last_substep_) {
      body.clearForces();
      sleep_.observe(body, tick_length_);
    }
    any_fast =
        any_fast || static_cast<double>(body.getAngularVelocity().length2() * h * h) > kSlowRotation * kSlowRotation;
    if (find_instability(body, static_cast<double>(h)) != nullptr) unstable_.store(true, std::memory_order_relaxed);
  }
  const int batch_size = joint_start_[last] - joint_start_[first];
  for (int i = joint_start_[first]; i < joint_start_[last]; ++i) {
    if (i + batch_size < joint_start_[island_count_]) prefetch(joints_[i + batch_size], sizeof(JointConstraint));
    if (any_fast) predict_angles(*joints_[i], h, !last_substep_);
    if (last_substep_) end_tick(*joints_[i]);
  }
}

// Islands share only static bodies, which solvers never write to (none is kinematic).
void IslandWorld::solve_islands(const btContactSolverInfo& info) {
  const BulletMemory::Scope heap(nullptr);  // for the solvers' rows; threads of the pool have no other memory
  ThreadPool* const pool =
      joints_.size() + contacts_.size() + bodies_.size() >= kMinParallelWork ? thread_pool.get() : nullptr;
  parallel_for(pool, batches_.size() - 1,
               [&](int batch, int thread) { solve_batch(batch, *solvers[static_cast<std::size_t>(thread)], info); });
}

void IslandWorld::set_direct(bool on) {
  for (const auto& solver : solvers) solver->set_direct(on);
}

DirectCounts IslandWorld::direct_counts() const {
  DirectCounts sum;
  for (const auto& solver : solvers) {
    const DirectCounts& counts = solver->direct().counts();
    sum.islands += counts.islands;
    sum.direct += counts.direct;
    sum.too_large += counts.too_large;
    sum.fallbacks += counts.fallbacks;
  }
  return sum;
}

}  // namespace limber
