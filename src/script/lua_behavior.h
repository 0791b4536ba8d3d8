// LuaBehavior: a behaviour whose start, step and migrate are functions of a file in behaviors_lua/. From outside it is
// like any other. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "script/behavior_scripts.h"
#include "sim/behavior.h"

namespace limber {

class LuaBehavior final : public Behavior {
 public:
  /// `file`: the number of its type's file among those that the scripts have loaded.
  LuaBehavior(std::shared_ptr<BehaviorScripts> scripts, std::int32_t file);
  ~LuaBehavior() override;

  void start() override;
  void step(double dt) override;
  /// Those that need no more than their step are stepped in one call of the Vm.
  void step_group(std::span<Behavior* const> members, double dt) override;
  /// Takes the state of the one before it, through `migrate` when the file has changed. What can't be kept is said, and
  /// the state starts anew.
  void take_over(Behavior& before) override;
  void pass_memory(KeyBytes& key) override;

  /// Its `state` as text, for another instance. The error names the key that holds what is no plain data.
  Result<std::string> state() const;
  const BehaviorFile& file() const { return scripts_->file(file_); }

  using Behavior::fail;  // for BehaviorScripts, which steps several in one call

 private:
  bool ready();
  std::int32_t number_in_row(const Behavior& member) const;
  bool well(BehaviorFault fault);

  /// A state on its way from another instance, and the text of the file whose it was.
  struct Inheritance {
    std::string state;
    std::string from;
  };

  std::shared_ptr<BehaviorScripts> scripts_;
  std::int32_t file_;
  std::int32_t number_ = 0;  // in the Vm; 0: not there yet
  bool started_ = false;
  std::optional<Inheritance> inherited_;
  // of the one that speaks for its group
  std::uint64_t numbered_at_ = 0;      // what BehaviorGroup::prepared() was then
  std::vector<std::int32_t> numbers_;  // of all members
  std::vector<std::int32_t> row_;      // scratch: of those that run
};

}  // namespace limber
