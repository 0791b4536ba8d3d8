// WorldTransaction: the log of a guarded call's changes, newest last.
#include "sim/state/world_transaction.h"

#include <utility>

#include "base/check.h"
#include "sim/bullet/island_world.h"
#include "sim/world/world.h"

namespace limber {

struct WorldTransaction::SavedForces {
  Part* part;
  ForceAccumulators::Wrench wrench;
  ForceAccumulators::Impulse impulse;
};

struct WorldTransaction::SavedBody {
  Body* body;
  Pose initial_pose;
  std::size_t good_pose_count;
  bool joints_dirty, restored_once;
};

struct WorldTransaction::SavedMotion {
  Part* part;
  btTransform pose, interpolation_pose;
  btVector3 linear, angular;
  bool wake_requested;
};

struct WorldTransaction::HiddenBody {
  std::unique_ptr<Body> body;
  NodeId id;
  std::size_t index;          // index among the bodies
  std::size_t sibling_index;  // index among its node's siblings
};

struct WorldTransaction::HiddenGear {
  std::unique_ptr<Gear> gear;
  NodeId id;
  std::size_t index;          // index among the gears
  std::size_t sibling_index;  // index among its node's siblings
};

WorldTransaction::WorldTransaction(World& world) : world_(world) {}

WorldTransaction::~WorldTransaction() = default;

void WorldTransaction::begin() {
  LIMBER_CHECK(!active_);
  active_ = true;
  call_++;
  entries_.clear();
  forces_.clear();
  bodies_.clear();
  motions_.clear();
  reset_requested_ = world_.reset_requested_;
  panic_requested_ = world_.panic_requested_;
  panic_end_requested_ = world_.panic_end_requested_;
  world_.behaviors_->transaction().begin();
  world_.store_.begin_transaction();
}

void WorldTransaction::commit() {
  active_ = false;
  world_.store_.commit_transaction();
  world_.behaviors_->transaction().commit();
  for (HiddenGear& hidden : hidden_gears_) {
    hidden.gear.reset();
    world_.store_.remove_hidden(hidden.id);
  }
  hidden_gears_.clear();
  for (HiddenBody& hidden : hidden_bodies_) {
    hidden.body.reset();
    world_.store_.remove_hidden(hidden.id);
  }
  hidden_bodies_.clear();
}

void WorldTransaction::rollback() {
  // from here on, additions and removals are final
  active_ = false;
  // restore the structure first, so that the store finds the objects that it saved values of
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) entry->undo(entry->owner, entry->value);
  world_.store_.rollback();
  world_.reset_requested_ = reset_requested_;
  world_.panic_requested_ = panic_requested_;
  world_.panic_end_requested_ = panic_end_requested_;
}

bool WorldTransaction::is_empty() const {
  return entries_.empty() && world_.store_.transaction_is_empty() && world_.reset_requested_ == reset_requested_ &&
         world_.panic_requested_ == panic_requested_ && world_.panic_end_requested_ == panic_end_requested_;
}

void WorldTransaction::record(UndoFunction undo, void* owner, std::size_t value) {
  if (active_) entries_.push_back({undo, owner, value});
}

bool WorldTransaction::first_in_call(std::uint64_t& saved_in_call) const {
  return std::exchange(saved_in_call, call_) != call_;
}

void WorldTransaction::save(Part& part) {
  if (!first_in_call(part.saved_in_call_)) return;
  forces_.push_back({&part, world_.force_accumulators().wrench(part.accumulator_),
                     world_.force_accumulators().impulse(part.accumulator_)});
  record(
      [](void* transaction, std::size_t index) {
        auto& self = *static_cast<WorldTransaction*>(transaction);
        const SavedForces& saved = self.forces_[index];
        self.world_.force_accumulators().wrench(saved.part->accumulator_) = saved.wrench;
        self.world_.force_accumulators().impulse(saved.part->accumulator_) = saved.impulse;
      },
      this, forces_.size() - 1);
}

void WorldTransaction::save(Body& body) {
  if (!first_in_call(body.saved_in_call_)) return;
  bodies_.push_back({&body, body.initial_pose_, body.good_pose_count_, body.joints_dirty_, body.restored_once_});
  record(
      [](void* transaction, std::size_t index) {
        const SavedBody& saved = static_cast<WorldTransaction*>(transaction)->bodies_[index];
        saved.body->initial_pose_ = saved.initial_pose;
        saved.body->good_pose_count_ = saved.good_pose_count;
        saved.body->joints_dirty_ = saved.joints_dirty;
        saved.body->restored_once_ = saved.restored_once;
      },
      this, bodies_.size() - 1);
}

void WorldTransaction::save(CameraMoves& camera_moves) {
  if (!active_ || !first_in_call(camera_moves.saved_in_call_)) return;
  camera_moves_ = camera_moves.state_;
  record(
      [](void* transaction, std::size_t) {
        const auto& self = *static_cast<WorldTransaction*>(transaction);
        self.world_.camera_moves_.state_ = self.camera_moves_;
      },
      this);
}

void WorldTransaction::save(Shape& shape) {
  record([](void* owner, std::size_t count) { static_cast<Shape*>(owner)->truncate_children(count); }, &shape,
         shape.child_count());
}

void WorldTransaction::save_motion(Part& part) {
  const btRigidBody& rigid = part.rigid();
  motions_.push_back({&part, rigid.getWorldTransform(), rigid.getInterpolationWorldTransform(),
                      rigid.getLinearVelocity(), rigid.getAngularVelocity(),
                      world_.bullet().sleep().wake_requested(rigid)});
  record(
      [](void* transaction, std::size_t index) {
        auto& self = *static_cast<WorldTransaction*>(transaction);
        const SavedMotion& saved = self.motions_[index];
        btRigidBody& rigid = saved.part->rigid();
        rigid.setWorldTransform(saved.pose);
        rigid.setInterpolationWorldTransform(saved.interpolation_pose);
        rigid.setLinearVelocity(saved.linear);
        rigid.setAngularVelocity(saved.angular);
        rigid.updateInertiaTensor();
        if (!saved.wake_requested) self.world_.bullet().sleep().cancel_wake(rigid);
      },
      this, motions_.size() - 1);
}

void WorldTransaction::body_added() {
  record([](void* world, std::size_t) { static_cast<World*>(world)->bodies_.pop_back(); }, &world_);
}

void WorldTransaction::gear_added() {
  record([](void* world, std::size_t) { static_cast<World*>(world)->gears_.pop_back(); }, &world_);
}

void WorldTransaction::shape_added() {
  record([](void* world, std::size_t) { static_cast<World*>(world)->shapes_.pop_back(); }, &world_);
}

void WorldTransaction::part_added(Body& body) {
  record(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.parts_.pop_back();
        body.structure_version_++;
      },
      &body);
}

void WorldTransaction::joint_added(Body& body) {
  record(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.joints_.pop_back();
        body.structure_version_++;
      },
      &body);
}

void WorldTransaction::motor_added(Body& body) {
  record(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.motors_.pop_back();
        body.structure_version_++;
      },
      &body);
}

void WorldTransaction::hide(std::unique_ptr<Gear> gear, std::size_t index) {
  const NodeId id = gear->id();
  hidden_gears_.push_back({std::move(gear), id, index, world_.store_.hide(id)});
  record(
      [](void* owner, std::size_t) {
        auto& transaction = *static_cast<WorldTransaction*>(owner);
        HiddenGear& last = transaction.hidden_gears_.back();
        transaction.world_.store_.show(last.id, last.sibling_index);
        auto& gears = transaction.world_.gears_;
        gears.insert(gears.begin() + static_cast<std::ptrdiff_t>(last.index), std::move(last.gear));
        transaction.hidden_gears_.pop_back();
      },
      this);
}

void WorldTransaction::hide(std::unique_ptr<Body> body, std::size_t index) {
  const NodeId id = body->id();
  hidden_bodies_.push_back({std::move(body), id, index, world_.store_.hide(id)});
  record(
      [](void* owner, std::size_t) {
        auto& transaction = *static_cast<WorldTransaction*>(owner);
        HiddenBody& last = transaction.hidden_bodies_.back();
        transaction.world_.store_.show(last.id, last.sibling_index);
        auto& bodies = transaction.world_.bodies_;
        bodies.insert(bodies.begin() + static_cast<std::ptrdiff_t>(last.index), std::move(last.body));
        transaction.hidden_bodies_.pop_back();
      },
      this);
}

}  // namespace limber
