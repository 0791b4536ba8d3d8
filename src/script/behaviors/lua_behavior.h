// LuaBehavior: a behavior with its start, step and migrate functions in a file in behaviors_lua/. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "script/behaviors/behavior_scripts.h"
#include "sim/behavior/behavior.h"

namespace limber::script {

class LuaBehavior final : public sim::Behavior {
 public:
  /// `file`: index of the type's file in BehaviorScripts.
  LuaBehavior(std::shared_ptr<BehaviorScripts> scripts, std::int32_t file);
  ~LuaBehavior() override;

  void start() override;
  void step(double dt) override;
  /// Steps members that need nothing but their step in one call of the Vm.
  void step_group(std::span<sim::Behavior* const> members, double dt) override;
  /// Takes over the state of the previous instance, through `migrate` if the file has changed. If the state can't be
  /// transferred, logs a warning and starts with an empty one.
  void adopt_state(sim::Behavior& previous) override;
  void serialize(Archive& archive) override;

  /// Returns its `state` serialized as text. The error names the key of a value that is not plain data.
  Result<std::string> state() const;
  const BehaviorFile& file() const { return scripts_->file(file_); }

  using sim::Behavior::fail;  // for BehaviorScripts, which steps several in one call

 private:
  bool prepare();
  std::int32_t batch_number(const sim::Behavior& member) const;
  bool check(sim::BehaviorFault fault);

  /// State taken over from another instance, and the source text of that instance's file.
  struct InheritedState {
    std::string state;
    std::string source_text;
  };

  std::shared_ptr<BehaviorScripts> scripts_;
  std::int32_t file_;
  std::int32_t number_ = 0;  // in the Vm; 0: not registered yet
  bool started_ = false;
  std::optional<InheritedState> inherited_;
  // only used by the member that steps its group
  std::uint64_t numbered_at_ = 0;              // BehaviorGroup::members_version() of `numbers_`
  std::vector<std::int32_t> numbers_;          // of all members
  std::vector<std::int32_t> running_numbers_;  // scratch: numbers of the running members
};

}  // namespace limber::script
