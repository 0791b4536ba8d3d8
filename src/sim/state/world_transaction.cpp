// WorldTransaction: the log of a guarded call's changes, newest last.
#include "sim/state/world_transaction.h"

#include <cstring>
#include <utility>

#include "base/check.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/gears/gear.h"
#include "sim/shapes/shape.h"
#include "sim/tendons/tendon.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

struct WorldTransaction::SavedForces {
  std::uint32_t accumulator;
  ForceAccumulators::Wrench wrench;
  ForceAccumulators::Impulse impulse;
};

struct WorldTransaction::SavedMotion {
  Part* part;
  btTransform pose, interpolation_pose;
  btVector3 linear, angular;
  bool wake_requested;
};

template <class T>
struct WorldTransaction::Hidden {
  std::vector<std::unique_ptr<T>>* list;
  std::unique_ptr<T> object;
  NodeId id;
  std::size_t index;          // index in the list
  std::size_t sibling_index;  // index among its node's siblings
};

WorldTransaction::WorldTransaction(World& world) : world_(world) {}

WorldTransaction::~WorldTransaction() = default;

void WorldTransaction::begin() {
  LIMBER_CHECK(!active_);
  active_ = true;
  call_++;
  entries_.clear();
  saved_bytes_.clear();
  forces_.clear();
  motions_.clear();
  requests_ = world_.requests();
  world_.behaviors().transaction().begin();
  world_.store().begin_transaction();
}

void WorldTransaction::commit() {
  active_ = false;
  world_.store().commit_transaction();
  world_.behaviors().transaction().commit();
  world_.behaviors().routes().destroy_hidden();
  destroy(hidden_gears_);
  destroy(hidden_tendons_);
  destroy(hidden_bodies_);
}

template <class T>
void WorldTransaction::destroy(std::vector<Hidden<T>>& hidden) {
  for (Hidden<T>& each : hidden) {
    each.object.reset();
    world_.store().remove_hidden(each.id);
  }
  hidden.clear();
}

void WorldTransaction::rollback() {
  // from here on, additions and removals are final
  active_ = false;
  // restore the structure first, so that the store finds the objects that it saved values of
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    if (entry->undo != nullptr) {
      entry->undo(entry->owner, entry->value);
    } else {
      std::memcpy(entry->owner, saved_bytes_.data() + entry->value, saved_bytes_.size() - entry->value);
      saved_bytes_.resize(entry->value);
    }
  }
  world_.store().rollback();
  world_.sensing().parts().invalidate_bodies();
  world_.requests() = requests_;
}

bool WorldTransaction::is_empty() const {
  return entries_.empty() && world_.store().transaction_is_empty() && world_.requests() == requests_;
}

void WorldTransaction::record(UndoFunction undo, void* owner, std::size_t value) {
  if (active_) entries_.push_back({undo, owner, value});
}

void WorldTransaction::save_bytes(void* field, std::size_t size) {
  entries_.push_back({nullptr, field, saved_bytes_.size()});
  const auto* const bytes = static_cast<const std::byte*>(field);
  saved_bytes_.insert(saved_bytes_.end(), bytes, bytes + size);
}

void WorldTransaction::save_forces(const Part& part) {
  ForceAccumulators& accumulators = world_.force_accumulators();
  const std::uint32_t index = part.accumulator_index();
  forces_.push_back({index, accumulators.wrench(index), accumulators.impulse(index)});
  record(
      [](void* transaction, std::size_t at) {
        auto& self = *static_cast<WorldTransaction*>(transaction);
        const SavedForces& saved = self.forces_[at];
        self.world_.force_accumulators().wrench(saved.accumulator) = saved.wrench;
        self.world_.force_accumulators().impulse(saved.accumulator) = saved.impulse;
      },
      this, forces_.size() - 1);
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

template <auto kHidden, class T>
void WorldTransaction::hide_in(std::vector<std::unique_ptr<T>>& list, std::size_t index) {
  const auto at = list.begin() + static_cast<std::ptrdiff_t>(index);
  const NodeId id = (*at)->id();
  (this->*kHidden).push_back({&list, std::move(*at), id, index, world_.store().hide(id)});
  list.erase(at);
  record(
      [](void* owner, std::size_t) {
        auto& self = *static_cast<WorldTransaction*>(owner);
        Hidden<T>& last = (self.*kHidden).back();
        self.world_.store().show(last.id, last.sibling_index);
        last.list->insert(last.list->begin() + static_cast<std::ptrdiff_t>(last.index), std::move(last.object));
        (self.*kHidden).pop_back();
      },
      this);
}

void WorldTransaction::hide(std::vector<std::unique_ptr<Body>>& list, std::size_t index) {
  hide_in<&WorldTransaction::hidden_bodies_>(list, index);
}

void WorldTransaction::hide(std::vector<std::unique_ptr<Gear>>& list, std::size_t index) {
  hide_in<&WorldTransaction::hidden_gears_>(list, index);
}

void WorldTransaction::hide(std::vector<std::unique_ptr<Tendon>>& list, std::size_t index) {
  hide_in<&WorldTransaction::hidden_tendons_>(list, index);
}

}  // namespace limber::sim
