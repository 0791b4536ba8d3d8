// What a guarded call did to the world, newest last.
#include "sim/world_undo.h"

#include <utility>

#include "base/check.h"
#include "sim/world.h"

namespace limber {

struct WorldUndo::Forces {
  Part* part;
  PartLoads::Load load;
  PartLoads::Kick kick;
};

struct WorldUndo::BodyState {
  Body* body;
  Pose planned;
  std::size_t good_poses;
  bool moved, restored_once;
};

struct WorldUndo::Motion {
  Part* part;
  btTransform pose, interpolated;
  btVector3 linear, angular;
  bool waking;
};

struct WorldUndo::Hidden {
  std::unique_ptr<Body> body;
  NodeId id;
  std::size_t place;          // among the bodies
  std::size_t place_in_tree;  // among its node's siblings
};

struct WorldUndo::HiddenGear {
  std::unique_ptr<Gear> gear;
  NodeId id;
  std::size_t place;          // among the gears
  std::size_t place_in_tree;  // among its node's siblings
};

WorldUndo::WorldUndo(World& world) : world_(world) {}

WorldUndo::~WorldUndo() = default;

void WorldUndo::begin() {
  LIMBER_CHECK(!active_);
  active_ = true;
  call_++;
  entries_.clear();
  forces_.clear();
  bodies_.clear();
  motions_.clear();
  reset_asked_ = world_.reset_asked_;
  panic_asked_ = world_.panic_asked_;
  world_.behaviors_->undo().begin();
  world_.store_.begin_undo();
}

void WorldUndo::end() {
  active_ = false;
  world_.store_.end_undo();
  world_.behaviors_->undo().end();
  for (HiddenGear& hidden : hidden_gears_) {
    hidden.gear.reset();
    world_.store_.drop_hidden(hidden.id);
  }
  hidden_gears_.clear();
  for (Hidden& hidden : hidden_) {
    hidden.body.reset();
    world_.store_.drop_hidden(hidden.id);
  }
  hidden_.clear();
}

void WorldUndo::take_back() {
  // what is made or removed from here on is so for good
  active_ = false;
  // first what was made and removed, so that the store finds again the things whose values it kept
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) entry->step(entry->owner, entry->value);
  world_.store_.take_back();
  world_.reset_asked_ = reset_asked_;
  world_.panic_asked_ = panic_asked_;
}

bool WorldUndo::untouched() const {
  return entries_.empty() && world_.store_.undo_untouched() && world_.reset_asked_ == reset_asked_ &&
         world_.panic_asked_ == panic_asked_;
}

void WorldUndo::note(Step step, void* owner, std::size_t value) {
  if (active_) entries_.push_back({step, owner, value});
}

bool WorldUndo::first_time(std::uint64_t& kept_in) const { return std::exchange(kept_in, call_) != call_; }

void WorldUndo::keep(Part& part) {
  if (!first_time(part.kept_in_)) return;
  forces_.push_back({&part, world_.loads().load(part.load_), world_.loads().kick(part.load_)});
  note(
      [](void* undo, std::size_t at) {
        auto& self = *static_cast<WorldUndo*>(undo);
        const Forces& kept = self.forces_[at];
        self.world_.loads().load(kept.part->load_) = kept.load;
        self.world_.loads().kick(kept.part->load_) = kept.kick;
      },
      this, forces_.size() - 1);
}

void WorldUndo::keep(Body& body) {
  if (!first_time(body.kept_in_)) return;
  bodies_.push_back({&body, body.planned_, body.good_poses_, body.moved_, body.restored_once_});
  note(
      [](void* undo, std::size_t at) {
        const BodyState& kept = static_cast<WorldUndo*>(undo)->bodies_[at];
        kept.body->planned_ = kept.planned;
        kept.body->good_poses_ = kept.good_poses;
        kept.body->moved_ = kept.moved;
        kept.body->restored_once_ = kept.restored_once;
      },
      this, bodies_.size() - 1);
}

void WorldUndo::keep(CameraMoves& moves) {
  if (!active_ || !first_time(moves.kept_in_)) return;
  moves_ = moves.state_;
  note(
      [](void* undo, std::size_t) {
        const auto& self = *static_cast<WorldUndo*>(undo);
        self.world_.camera_moves_.state_ = self.moves_;
      },
      this);
}

void WorldUndo::keep(Shape& shape) {
  note([](void* owner, std::size_t count) { static_cast<Shape*>(owner)->keep_children(count); }, &shape,
       shape.child_count());
}

void WorldUndo::keep_motion(Part& part) {
  const btRigidBody& rigid = part.rigid();
  motions_.push_back({&part, rigid.getWorldTransform(), rigid.getInterpolationWorldTransform(),
                      rigid.getLinearVelocity(), rigid.getAngularVelocity(), world_.bullet().sleep().waking(rigid)});
  note(
      [](void* undo, std::size_t at) {
        auto& self = *static_cast<WorldUndo*>(undo);
        const Motion& kept = self.motions_[at];
        btRigidBody& rigid = kept.part->rigid();
        rigid.setWorldTransform(kept.pose);
        rigid.setInterpolationWorldTransform(kept.interpolated);
        rigid.setLinearVelocity(kept.linear);
        rigid.setAngularVelocity(kept.angular);
        rigid.updateInertiaTensor();
        if (!kept.waking) self.world_.bullet().sleep().cancel(rigid);
      },
      this, motions_.size() - 1);
}

void WorldUndo::made_body() {
  note([](void* world, std::size_t) { static_cast<World*>(world)->bodies_.pop_back(); }, &world_);
}

void WorldUndo::made_gear() {
  note([](void* world, std::size_t) { static_cast<World*>(world)->gears_.pop_back(); }, &world_);
}

void WorldUndo::made_shape() {
  note([](void* world, std::size_t) { static_cast<World*>(world)->shapes_.pop_back(); }, &world_);
}

void WorldUndo::made_part(Body& body) {
  note(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.parts_.pop_back();
        body.structure_++;
      },
      &body);
}

void WorldUndo::made_joint(Body& body) {
  note(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.joints_.pop_back();
        body.structure_++;
      },
      &body);
}

void WorldUndo::made_motor(Body& body) {
  note(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        body.motors_.pop_back();
        body.structure_++;
      },
      &body);
}

void WorldUndo::hide(std::unique_ptr<Gear> gear, std::size_t place) {
  const NodeId id = gear->id();
  hidden_gears_.push_back({std::move(gear), id, place, world_.store_.hide(id)});
  note(
      [](void* owner, std::size_t) {
        auto& undo = *static_cast<WorldUndo*>(owner);
        HiddenGear& last = undo.hidden_gears_.back();
        undo.world_.store_.show(last.id, last.place_in_tree);
        auto& gears = undo.world_.gears_;
        gears.insert(gears.begin() + static_cast<std::ptrdiff_t>(last.place), std::move(last.gear));
        undo.hidden_gears_.pop_back();
      },
      this);
}

void WorldUndo::hide(std::unique_ptr<Body> body, std::size_t place) {
  const NodeId id = body->id();
  hidden_.push_back({std::move(body), id, place, world_.store_.hide(id)});
  note(
      [](void* owner, std::size_t) {
        auto& undo = *static_cast<WorldUndo*>(owner);
        Hidden& last = undo.hidden_.back();
        undo.world_.store_.show(last.id, last.place_in_tree);
        auto& bodies = undo.world_.bodies_;
        bodies.insert(bodies.begin() + static_cast<std::ptrdiff_t>(last.place), std::move(last.body));
        undo.hidden_.pop_back();
      },
      this);
}

}  // namespace limber
