// From the world's calls to the script's functions.
#include "script/lua_behavior.h"

#include <utility>

#include <fmt/format.h>

#include "base/key_bytes.h"
#include "base/log.h"
#include "sim/behavior_group.h"
#include "sim/body.h"

namespace limber {

LuaBehavior::LuaBehavior(std::shared_ptr<BehaviorScripts> scripts, std::int32_t file)
    : scripts_(std::move(scripts)), file_(file) {}

LuaBehavior::~LuaBehavior() {
  if (number_ != 0) scripts_->drop(number_);
}

bool LuaBehavior::well(BehaviorFault fault) {
  if (fault.text.empty()) return true;
  fail(std::move(fault));
  return false;
}

// known to the Vm, with the state that it has inherited
bool LuaBehavior::ready() {
  if (number_ == 0) number_ = scripts_->make(*this, file_);
  if (number_ == 0) return false;
  if (!inherited_) return true;
  const Inheritance given = *std::exchange(inherited_, std::nullopt);
  return well(scripts_->restore(number_, given.state, given.from != file().text));
}

void LuaBehavior::start() {
  started_ = false;
  if (ready()) started_ = well(scripts_->start(number_));
}

void LuaBehavior::step(double dt) {
  // one that failed in its start tries that again first
  if (!started_) start();
  if (started_ && ready()) well(scripts_->step(number_, dt));
}

// the number of one that needs no more than its step; 0: of one that is to be looked at by itself
std::int32_t LuaBehavior::number_in_row(const Behavior& member) const {
  const auto& other = static_cast<const LuaBehavior&>(member);
  const bool only_steps = other.started_ && !other.inherited_;
  return only_steps && other.scripts_ == scripts_ && other.file_ == file_ ? other.number_ : 0;
}

void LuaBehavior::step_group(std::span<Behavior* const> members, double dt) {
  // thousands of members lie far from each other: they are looked at only after something happened to them
  if (std::exchange(numbered_at_, group()->prepared()) != group()->prepared()) {
    numbers_.clear();
    for (const auto& member : group()->members()) numbers_.push_back(number_in_row(*member));
  }
  const std::span<const std::uint32_t> places = group()->running();
  row_.clear();
  for (const std::uint32_t place : places) row_.push_back(numbers_[place]);
  bool changed = false;
  for (std::size_t i = 0; i < members.size();) {
    std::size_t end = i;
    while (end < members.size() && row_[end] != 0) end++;
    if (end > i) {
      BehaviorScripts::StepRow row{members.subspan(i, end - i), std::span(row_).subspan(i, end - i), changed};
      scripts_->step_all(row, dt);
      changed = row.changed;
      i += row.next;
    } else {
      if (members[i]->runs()) members[i]->step(dt);
      numbers_[places[i]] = number_in_row(*members[i]);
      changed = true;
      i++;
    }
  }
}

void LuaBehavior::take_over(Behavior& before) {
  auto* const old = dynamic_cast<LuaBehavior*>(&before);
  if (old == nullptr) return;
  started_ = old->started_;
  if (old->inherited_) {
    inherited_ = std::move(old->inherited_);
  } else if (old->number_ != 0) {
    Result<std::string> kept = old->state();
    if (kept) {
      inherited_ = {std::move(*kept), old->file().text};
    } else {
      started_ = false;
      log_warning("behavior '{}/{}' begins anew: {}", body().name(), name(), kept.error());
    }
  }
}

void LuaBehavior::pass_memory(KeyBytes& key) {
  bool inherits = inherited_.has_value();
  key.pass_all(number_, started_, inherits);
  if (inherits) {
    Inheritance& inherited = inherited_ ? *inherited_ : inherited_.emplace();
    key.pass_all(inherited.state, inherited.from);
  } else {
    inherited_.reset();
  }
  if (key.bringing()) numbered_at_ = 0;
}

Result<std::string> LuaBehavior::state() const { return scripts_->state(number_); }

}  // namespace limber
