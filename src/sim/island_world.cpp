// Islands: found here, sorted by counting, solved batch by batch.
#include "sim/island_world.h"

#include <algorithm>
#include <utility>

#include "base/prefetch.h"
#include "sim/dispatcher.h"
#include "sim/health.h"
#include "sim/spin.h"

namespace limber {
namespace {

/// Islands are solved together until this many joints and contact pairs, or so many bodies, are in a batch; it changes
/// no result.
constexpr int kBatch = 16;
constexpr int kBodies = 64;
/// Joints, contact pairs and bodies of a step that are worth waking others for; it changes no result.
constexpr int kTeamWork = 128;
/// So many objects ahead their memory is asked for.
constexpr int kAhead = 8;
/// Contact pairs in Bullet's pool.
constexpr int kPool = 64;

// Counts per island in start[1..] become starts, and cursor their copy.
void accumulate(btAlignedObjectArray<int>& start, btAlignedObjectArray<int>& cursor) {
  for (int i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  cursor.copyFromArray(start);
}

void zero(btAlignedObjectArray<int>& a, int size) {
  a.resizeNoInitialize(size);
  for (int i = 0; i < size; ++i) a[i] = 0;
}

void leave_gyroscopic_torque_to_us(btRigidBody& body) {
  body.setFlags(body.getFlags() & ~(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT | BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                    BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY));
}

void end_tick(btTypedConstraint& joint) {
  if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).end_tick();
  if (is_gear(joint)) static_cast<GearConstraint&>(joint).end_tick();
}

// The axes of fast parts' joints are read at each step's end: spin.h.
void predict_angles(btTypedConstraint& constraint, btScalar h, bool refresh) {
  if (constraint.getConstraintType() != JointConstraint::kType) return;
  JointConstraint& joint = static_cast<JointConstraint&>(constraint);
  joint.predict_angles(h);
  if (refresh) joint.refresh();
}

}  // namespace

WorldParts::WorldParts(const WorldSetup& setup) : memory(BulletMemory::current()), team(setup.team) {
  // Bullet's own pools of 4096 contact pairs take 4 MB, which each key state would look through; more pairs than a
  // pool holds cost no measurable time (arms-1000)
  btDefaultCollisionConstructionInfo pools;
  pools.m_defaultMaxPersistentManifoldPoolSize = pools.m_defaultMaxCollisionAlgorithmPoolSize = kPool;
  configuration = std::make_unique<btDefaultCollisionConfiguration>(pools);
  dispatcher = std::make_unique<Dispatcher>(configuration.get());
  broadphase = std::make_unique<Broadphase>(setup.broadphase_margin, setup.team.get());
  const BulletMemory::Scope heap(nullptr);
  for (int i = 0; i < (setup.team ? setup.team->members() : 1); ++i) {
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
  info.m_minimumSolverBatchSize = kBatch;
  getDispatchInfo().m_useContinuous = false;
}

IslandWorld::~IslandWorld() = default;

// Calls work(object) for each, side by side where there is a team; the work must be the same in any order.
template <class Object, class Work>
void IslandWorld::for_each(const btAlignedObjectArray<Object*>& objects, Work&& work) {
  const int count = objects.size();
  share_out_places(team.get(), count, [&](int, int first, int end) {
    for (int i = first; i < end; ++i) {
      if (i + kAhead < count) prefetch(objects[i + kAhead], sizeof *objects[i]);
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
    first_ = i == 0;
    last_ = i + 1 == substeps;
    for (const auto& solver : solvers) solver->set_substep(substeps - i, substeps);
    if (joints_known_ && awake_.size() == 0 && linked_.size() == 0 && !sleep_.any_waking()) {
      rest_step();
    } else {
      internalSingleStepSimulation(step_length);
    }
  }
  first_ = last_ = false;
  if (joints_known_ && sleep_.end_tick({places_, awake_, linked_})) joints_known_ = false;
}

// An internal step in which everything sleeps.
void IslandWorld::rest_step() {
  ails_.store(false, std::memory_order_relaxed);
  if (m_internalTickCallback != nullptr) m_internalTickCallback(this, step_length_);
}

void IslandWorld::refresh_joints() {
  for_each(m_constraints, [](int, btTypedConstraint& joint) {
    if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).refresh();
  });
}

void IslandWorld::addConstraint(btTypedConstraint* constraint, bool disable_collisions) {
  const BulletMemory::Scope scope(memory);
  joints_known_ = false;
  sleep_.wake(constraint->getRigidBodyA());
  sleep_.wake(constraint->getRigidBodyB());
  btDiscreteDynamicsWorld::addConstraint(constraint, disable_collisions);
  if (disable_collisions) look_anew(*constraint);
}

void IslandWorld::addRigidBody(btRigidBody* body) {
  const BulletMemory::Scope scope(memory);
  joints_known_ = false;
  leave_gyroscopic_torque_to_us(*body);
  btDiscreteDynamicsWorld::addRigidBody(body);
}

void IslandWorld::addRigidBody(btRigidBody* body, int group, int mask) {
  const BulletMemory::Scope scope(memory);
  joints_known_ = false;
  leave_gyroscopic_torque_to_us(*body);
  btDiscreteDynamicsWorld::addRigidBody(body, group, mask);
}

void IslandWorld::addCollisionObject(btCollisionObject* object, int group, int mask) {
  btDiscreteDynamicsWorld::addCollisionObject(object, group, mask);
  sleep_.add(*object);
}

void IslandWorld::removeRigidBody(btRigidBody* body) {
  joints_known_ = false;
  sleep_.remove(*body);
  btDiscreteDynamicsWorld::removeRigidBody(body);
}

void IslandWorld::wake_all() {
  if (sleep_.sleeping() > 0) joints_known_ = false;
  sleep_.wake_all();
}

void IslandWorld::setGravity(const btVector3& gravity) {
  if (gravity != getGravity()) wake_all();  // Bullet leaves out what sleeps
  btDiscreteDynamicsWorld::setGravity(gravity);
}

void IslandWorld::set_filter(btCollisionObject& object, const CollisionFilter& filter) {
  if (filter.store(object)) look_anew(object);
}

// Bullet's lists may hold an object more than once: each entry counts, those of joints too.
void IslandWorld::exclude_pair(btCollisionObject& a, btCollisionObject& b) {
  const BulletMemory::Scope scope(memory);
  a.setIgnoreCollisionCheck(&b, true);
  b.setIgnoreCollisionCheck(&a, true);
  look_anew(a);
  look_anew(b);
}

void IslandWorld::include_pair(btCollisionObject& a, btCollisionObject& b) {
  const BulletMemory::Scope scope(memory);
  a.setIgnoreCollisionCheck(&b, false);
  b.setIgnoreCollisionCheck(&a, false);
  look_anew(a);
  look_anew(b);
}

void IslandWorld::removeConstraint(btTypedConstraint* constraint) {
  const int count = m_constraints.size();
  const int index = m_constraints.findLinearSearch(constraint);
  if (index == count) return;
  joints_known_ = false;
  for (int i = index; i + 1 < count; ++i) m_constraints[i] = m_constraints[i + 1];
  m_constraints.pop_back();
  const BulletMemory::Scope scope(memory);
  constraint->getRigidBodyA().removeConstraintRef(constraint);
  constraint->getRigidBodyB().removeConstraintRef(constraint);
  sleep_.wake(constraint->getRigidBodyA());
  sleep_.wake(constraint->getRigidBodyB());
  look_anew(*constraint);
}

// whether its parts may collide has changed
void IslandWorld::look_anew(btTypedConstraint& joint) {
  look_anew(joint.getRigidBodyA());
  look_anew(joint.getRigidBodyB());
}

void IslandWorld::look_anew(btCollisionObject& object) {
  sleep_.wake(object);
  if (object.getBroadphaseHandle() == nullptr) return;
  const BulletMemory::Scope scope(memory);
  broadphase->look_anew(object.getBroadphaseHandle());
}

// Islands' own work, and that of what stands nobody's: solve_batch().
void IslandWorld::predictUnconstraintMotion(btScalar) {
  ails_.store(false, std::memory_order_relaxed);
  if (sleep_.apply_wakes(!first_)) joints_known_ = false;
  if (!joints_known_) learn_joints();
  static_cast<Dispatcher&>(*dispatcher).set_some_sleep(sleep_.sleeping() > 0);
}
void IslandWorld::integrateTransforms(btScalar) {}

void IslandWorld::createPredictiveContacts(btScalar) {}  // no continuous collision

void IslandWorld::updateAabbs() {
  BT_PROFILE("updateAabbs");
  if (!joints_known_ || places_.size() != getNumCollisionObjects()) learn_joints();
  const int count = looked_.size();
  left_.resizeNoInitialize(count);
  for_each(looked_, [&](int i, btCollisionObject& object) {
    if (i + kAhead / 2 < count) Broadphase::fetch(*looked_[i + kAhead / 2]);
    left_[i] = Broadphase::look(object, getDispatchInfo().m_timeStep) ? object.getBroadphaseHandle() : nullptr;
  });
  int left = 0;
  for (int i = 0; i < count; ++i) {
    if (left_[i] == nullptr) continue;
    if (looked_[i]->isStaticObject()) sleep_.wake(*looked_[i]);
    left_[left++] = left_[i];
  }
  if (sleep_.apply_wakes(!first_)) joints_known_ = false;
  if (left > 0) broadphase->leave({&left_[0], static_cast<std::size_t>(left)});
}

void IslandWorld::updateActivationState(btScalar) { sleep_.end_step(); }

void IslandWorld::solveConstraints(btContactSolverInfo& info) {
  sort_contacts();
  gather_batches(info.m_minimumSolverBatchSize);
  solve_islands(info);
}

int IslandWorld::root_of(btAlignedObjectArray<int>& above, int place) {
  while (above[place] != place) place = above[place] = above[above[place]];
  return place;
}

void IslandWorld::unite(btAlignedObjectArray<int>& above, int a, int b) {
  if (a >= 0 && b >= 0) above[root_of(above, a)] = root_of(above, b);
}

// Once they stand, no step has to go through all of them for it.
void IslandWorld::learn_joints() {
  places_.resizeNoInitialize(getNumCollisionObjects());
  for (int i = 0; i < places_.size(); ++i) places_[i] = -1;
  awake_.resizeNoInitialize(0);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    places_[body.getWorldArrayIndex()] = awake_.size();
    awake_.push_back(&body);
  }
  const auto sleeps = [](const btCollisionObject& object) { return !object.isStaticObject() && !object.isActive(); };
  looked_.resizeNoInitialize(0);
  for (int i = 0; i < m_collisionObjects.size(); ++i) {
    if (!sleeps(*m_collisionObjects[i])) looked_.push_back(m_collisionObjects[i]);
  }
  joined_.resizeNoInitialize(awake_.size());
  for (int i = 0; i < joined_.size(); ++i) joined_[i] = i;
  ends_.resizeNoInitialize(0);
  linked_.resizeNoInitialize(0);
  for (int i = 0; i < m_constraints.size(); ++i) {
    const btRigidBody& a = m_constraints[i]->getRigidBodyA();
    const btRigidBody& b = m_constraints[i]->getRigidBodyB();
    if (sleeps(a) || sleeps(b)) continue;
    ends_.push_back({place_of(a), place_of(b)});
    linked_.push_back(m_constraints[i]);
    unite(joined_, place_of(a), place_of(b));
  }
  joints_known_ = true;
}

// Who is joined, or may meet.
void IslandWorld::calculateSimulationIslands() {
  BT_PROFILE("calculateSimulationIslands");
  if (sleep_.wake_touched(!first_)) joints_known_ = false;
  if (!joints_known_ || places_.size() != getNumCollisionObjects()) learn_joints();
  above_.copyFromArray(joined_);
  const btBroadphasePairArray& pairs = getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    const auto place = [&](const btBroadphaseProxy* proxy) {
      return place_of(*static_cast<const btCollisionObject*>(proxy->m_clientObject));
    };
    unite(above_, place(pairs[i].m_pProxy0), place(pairs[i].m_pProxy1));
  }
  sort_bodies();
  sort_joints();
}

void IslandWorld::sort_bodies() {
  // islands get numbers in the order of their first body
  const int count = awake_.size();
  island_of_root_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) island_of_root_[i] = -1;
  island_.resizeNoInitialize(count);
  island_count_ = 0;
  zero(body_start_, count + 1);
  for (int i = 0; i < count; ++i) {
    int& island = island_of_root_[root_of(above_, i)];
    if (island < 0) island = island_count_++;
    island_[i] = island;
    ++body_start_[island + 1];
  }
  body_start_.resizeNoInitialize(island_count_ + 1);
  accumulate(body_start_, cursor_);
  bodies_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) bodies_[cursor_[island_[i]]++] = awake_[i];
}

void IslandWorld::sort_joints() {
  const int count = linked_.size();
  const auto island = [&](int joint) {
    const Ends& ends = ends_[joint];
    return ends.a < 0 && ends.b < 0 ? -1 : island_[ends.a >= 0 ? ends.a : ends.b];
  };
  zero(joint_start_, island_count_ + 1);
  for (int i = 0; i < count; ++i) {
    if (island(i) >= 0) ++joint_start_[island(i) + 1];
  }
  accumulate(joint_start_, cursor_);
  joints_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    if (island(i) >= 0) {
      joints_[cursor_[island(i)]++] = linked_[i];
    } else if (last_) {
      end_tick(*linked_[i]);
    }
  }
}

void IslandWorld::sort_contacts() {
  btDispatcher* dispatch = getDispatcher();
  touches_.resizeNoInitialize(0);
  const int manifolds = dispatch->getNumManifolds();
  for (int i = 0; i < manifolds; ++i) {
    if (i + kAhead < manifolds) prefetch_end(*dispatch->getManifoldByIndexInternal(i + kAhead));
    btPersistentManifold* manifold = dispatch->getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() == 0) continue;
    const btCollisionObject* a = manifold->getBody0();
    const btCollisionObject* b = manifold->getBody1();
    const int place = std::max(place_of(*a), place_of(*b));
    if (place < 0 || !dispatch->needsResponse(a, b)) continue;
    touches_.push_back(
        {island_[place], a->getBroadphaseHandle()->m_uniqueId, b->getBroadphaseHandle()->m_uniqueId, manifold});
  }
  // Bullet keeps manifolds in an order that depends on all islands' history; the parts' age does not
  const int count = touches_.size();
  if (count > 1) {
    std::sort(&touches_[0], &touches_[0] + count, [](const Touch& x, const Touch& y) {
      if (x.island != y.island) return x.island < y.island;
      return x.first != y.first ? x.first < y.first : x.second < y.second;
    });
  }
  zero(contact_start_, island_count_ + 1);
  contacts_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    contacts_[i] = touches_[i].manifold;
    ++contact_start_[touches_[i].island + 1];
  }
  accumulate(contact_start_, cursor_);
}

void IslandWorld::gather_batches(int least) {
  batches_.resizeNoInitialize(0);
  batches_.push_back(0);
  for (int last = 1; last <= island_count_; ++last) {
    const int first = batches_[batches_.size() - 1];
    const int joints = joint_start_[last] - joint_start_[first];
    const int contacts = contact_start_[last] - contact_start_[first];
    // the direct solver counts and falls back island by island
    const bool alone =
        solvers.front()->direct_wanted() && (joints + contacts > 0 || (last < island_count_ && has_work(last)));
    const int bodies = body_start_[last] - body_start_[first];
    if (alone || joints + contacts >= least || bodies >= kBodies || last == island_count_) batches_.push_back(last);
  }
}

// All that a step does to an island's bodies and joints, one thing after the other while they are at hand.
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
  const int ahead = body_start_[last] - body_start_[first];
  for (int i = body_start_[first]; i < body_start_[last]; ++i) {
    // those of the next batch, which come as long as this one takes
    if (i + ahead < body_start_[island_count_]) prefetch(bodies_[i + ahead], sizeof(btRigidBody));
    btRigidBody& body = static_cast<btRigidBody&>(*bodies_[i]);
    if (first_) {
      body.applyGravity();
      begin_clamps(body);
    }
    if (body.getLinearDamping() != 0 || body.getAngularDamping() != 0) body.applyDamping(h);
  }
}

void IslandWorld::move_bodies(int first, int last, btScalar h) {
  bool fast = false;
  for (int i = body_start_[first]; i < body_start_[last]; ++i) {
    btRigidBody& body = static_cast<btRigidBody&>(*bodies_[i]);
    if (!body.isActive() || body.isStaticOrKinematicObject()) continue;
    const double clamped = move_body(body, static_cast<double>(h));
    if (clamped > 0) note_clamp(body, clamped / static_cast<double>(h));
    if (last_) {
      body.clearForces();
      sleep_.observe(body, tick_length_);
    }
    fast = fast || static_cast<double>(body.getAngularVelocity().length2() * h * h) > kSlowTurn * kSlowTurn;
    if (ailment(body, static_cast<double>(h)) != nullptr) ails_.store(true, std::memory_order_relaxed);
  }
  const int ahead = joint_start_[last] - joint_start_[first];
  for (int i = joint_start_[first]; i < joint_start_[last]; ++i) {
    if (i + ahead < joint_start_[island_count_]) prefetch(joints_[i + ahead], sizeof(JointConstraint));
    if (fast) predict_angles(*joints_[i], h, !last_);
    if (last_) end_tick(*joints_[i]);
  }
}

// Islands share bodies that don't move alone, which solvers only read (none is kinematic: those would be written to).
void IslandWorld::solve_islands(const btContactSolverInfo& info) {
  const BulletMemory::Scope heap(nullptr);  // the solvers' rows; helpers of a team have no other memory
  Team* const helpers = joints_.size() + contacts_.size() + bodies_.size() >= kTeamWork ? team.get() : nullptr;
  share_out(helpers, batches_.size() - 1,
            [&](int batch, int member) { solve_batch(batch, *solvers[static_cast<std::size_t>(member)], info); });
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
    sum.plain += counts.plain;
    sum.fallbacks += counts.fallbacks;
  }
  return sum;
}

}  // namespace limber
