// Forwards the world's calls to script functions.
#include "script/behaviors/lua_behavior.h"

#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "sim/behavior/behavior_group.h"
#include "sim/world/body.h"

namespace limber::script {

LuaBehavior::LuaBehavior(std::shared_ptr<BehaviorScripts> scripts, std::int32_t file)
    : scripts_(std::move(scripts)), file_(file) {}

LuaBehavior::~LuaBehavior() {
  if (number_ != 0) scripts_->release(number_);
}

bool LuaBehavior::check(sim::BehaviorFault fault) {
  if (fault.text.empty()) return true;
  fail(std::move(fault));
  return false;
}

// registers in the Vm and restores the inherited state
bool LuaBehavior::prepare() {
  if (number_ == 0) number_ = scripts_->create(*this, file_);
  if (number_ == 0) return false;
  if (!inherited_) return true;
  const InheritedState inherited = *std::exchange(inherited_, std::nullopt);
  return check(scripts_->restore(number_, inherited.state, inherited.source_text != file().text));
}

void LuaBehavior::start() {
  started_ = false;
  if (prepare()) started_ = check(scripts_->start(number_));
}

void LuaBehavior::step(double dt) {
  // retry after a failed start
  if (!started_) start();
  if (started_ && prepare()) check(scripts_->step(number_, dt));
}

// number of a member that only needs its step; 0: must be handled individually
std::int32_t LuaBehavior::batch_number(const sim::Behavior& member) const {
  const auto& other = static_cast<const LuaBehavior&>(member);
  const bool only_steps = other.started_ && !other.inherited_;
  return only_steps && other.scripts_ == scripts_ && other.file_ == file_ ? other.number_ : 0;
}

void LuaBehavior::step_group(std::span<sim::Behavior* const> members, double dt) {
  // thousands of members are scattered in memory, so they are visited only after something has changed
  if (std::exchange(numbered_at_, group()->members_version()) != group()->members_version()) {
    numbers_.clear();
    for (const auto& member : group()->members()) numbers_.push_back(batch_number(*member));
  }
  const std::span<const std::uint32_t> running = group()->running_indices();
  running_numbers_.clear();
  for (const std::uint32_t index : running) running_numbers_.push_back(numbers_[index]);
  bool changed = false;
  for (std::size_t i = 0; i < members.size();) {
    std::size_t end = i;
    while (end < members.size() && running_numbers_[end] != 0) end++;
    if (end > i) {
      BehaviorScripts::StepBatch batch{members.subspan(i, end - i), std::span(running_numbers_).subspan(i, end - i),
                                       changed};
      scripts_->step_all(batch, dt);
      changed = batch.changed;
      i += batch.next;
    } else {
      if (members[i]->runs()) members[i]->step(dt);
      numbers_[running[i]] = batch_number(*members[i]);
      changed = true;
      i++;
    }
  }
}

void LuaBehavior::adopt_state(sim::Behavior& previous) {
  auto* const old = dynamic_cast<LuaBehavior*>(&previous);
  if (old == nullptr) return;
  started_ = old->started_;
  if (old->inherited_) {
    inherited_ = std::move(old->inherited_);
  } else if (old->number_ != 0) {
    Result<std::string> state = old->state();
    if (state) {
      inherited_ = {std::move(*state), old->file().text};
    } else {
      started_ = false;
      log_warning("behavior '{}/{}' restarts with an empty state: {}", body().name(), name(), state.error());
    }
  }
}

void LuaBehavior::serialize(Archive& archive) {
  bool inherits = inherited_.has_value();
  archive.serialize_all(number_, started_, inherits);
  if (inherits) {
    InheritedState& inherited = inherited_ ? *inherited_ : inherited_.emplace();
    archive.serialize_all(inherited.state, inherited.source_text);
  } else {
    inherited_.reset();
  }
  if (archive.loading()) numbered_at_ = 0;
}

Result<std::string> LuaBehavior::state() const { return scripts_->state(number_); }

}  // namespace limber::script
