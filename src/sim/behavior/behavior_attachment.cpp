// BehaviorAttachment: resolves the selections of a scene to the parts, joints and motors of a body.
#include "sim/behavior/behavior_attachment.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Returns the names of a body's parts, joints or motors.
template <class T>
std::vector<std::string_view> names_of(std::span<const std::unique_ptr<T>> objects) {
  std::vector<std::string_view> names;
  for (const auto& object : objects) names.push_back(object->name());
  return names;
}

bool can_move(const Part& part) { return !part.is_static(); }
bool can_move(const Joint&) { return true; }

// Returns the selected objects in stream order; "all" selects only those that can move.
template <class T>
std::vector<T*> selected(const Selection& selection, std::span<const std::unique_ptr<T>> objects) {
  std::vector<T*> list;
  for (const auto& object : objects) {
    if (selection.selects(object->name(), can_move(*object))) list.push_back(object.get());
  }
  return list;
}

// Returns the selected parts in the order of the selection's words, by which the scene defines the pairs.
std::vector<Part*> selected_in_order(const Selection& selection, std::span<const std::unique_ptr<Part>> parts) {
  if (selection.is_default()) return selected(selection, parts);
  std::vector<Part*> list;
  for (const std::string& word : selection.words()) {
    const std::vector<Part*> matches = selected(Selection({word}), parts);
    list.insert(list.end(), matches.begin(), matches.end());
  }
  return list;
}

template <class T>
Result<void> check_names(const Body& body, std::string_view kind, const Selection& selection,
                         std::span<const std::unique_ptr<T>> objects) {
  if (!selection.has_names()) return {};
  const std::vector<std::string_view> names = names_of(objects);
  const std::string_view missing = selection.first_missing(names);
  if (missing.empty()) return {};
  return Error{
      fmt::format("body '{}' has no {} '{}'{}", body.name(), kind, printable(missing), name_hint(missing, names))};
}

}  // namespace

const std::string& BehaviorAttachment::name() const { return store().name(id_); }
Store& BehaviorAttachment::store() const { return world_->store(); }

void BehaviorAttachment::attach_to(Body& body, std::shared_ptr<const BehaviorType> type,
                                   std::shared_ptr<const BehaviorSetup> setup, BehaviorGroup* group) {
  world_ = &body.world();
  body_ = &body;
  type_ = std::move(type);
  setup_ = std::move(setup);
  group_ = group;
}

// If a type acts on motors, a selection of joints adds the motors of these joints to the selected motors, or replaces
// "all".
bool BehaviorAttachment::selects_motors_by_joint() const {
  return type_->targets == BehaviorTargets::motors && !setup_->joints.is_default();
}

BehaviorAttachment::Targets BehaviorAttachment::selected_targets() const {
  const BehaviorSetup& s = *setup_;
  Targets targets;
  targets.parts = type_->targets == BehaviorTargets::pairs ? selected_in_order(s.parts, body_->parts())
                                                           : selected(s.parts, body_->parts());
  targets.joints = selected(s.joints, body_->joints());
  const bool by_joints = selects_motors_by_joint();
  const bool by_name = !by_joints || !s.motors.is_default();
  for (const auto& motor : body_->motors()) {
    if ((by_name && s.motors.selects(motor->name())) || (by_joints && s.joints.selects(motor->joint().name())))
      targets.motors.push_back(motor.get());
  }
  return targets;
}

Result<void> BehaviorAttachment::check_selected_names() const {
  if (group_ != nullptr) return {};
  const BehaviorSetup& s = *setup_;
  if (Result<void> exist = check_names(*body_, "part", s.parts, body_->parts()); !exist) return exist;
  if (Result<void> exist = check_names(*body_, "joint", s.joints, body_->joints()); !exist) return exist;
  if (Result<void> exist = check_names(*body_, "motor", s.motors, body_->motors()); !exist) return exist;
  if (!selects_motors_by_joint()) return {};
  const std::vector<std::string>& words = s.joints.words();
  for (const Joint* joint : targets_.joints) {
    if (joint->motor() != nullptr || std::ranges::find(words, joint->name()) == words.end()) continue;
    return Error{fmt::format("joint '{}/{}' has no motor; add one with add_motor", body_->name(), joint->name())};
  }
  return {};
}

}  // namespace limber::sim
