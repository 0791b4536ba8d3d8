// BehaviorCalls: calls into the instances of behaviors_lua/. A fault without text means success. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/id.h"
#include "base/result.h"
#include "sim/behavior/behavior.h"

namespace limber::script {

class Vm;

class BehaviorCalls {
 public:
  explicit BehaviorCalls(Vm& vm) : vm_(vm) {}
  BehaviorCalls(const BehaviorCalls&) = delete;
  BehaviorCalls& operator=(const BehaviorCalls&) = delete;

  /// Stores references to the functions that the prelude exports; their table is on top of the stack.
  void store_exports();

  /// Creates the `self` of an instance and returns its number, from 1.
  std::int32_t make(std::int32_t file, NodeId id);
  sim::BehaviorFault start(std::int32_t number);
  sim::BehaviorFault step(std::int32_t number, double dt);
  /// Steps the instances that BehaviorScripts::next_step() returns, until it returns 0 or one fails. `stepping`: number
  /// of the current one, updated by next_step().
  sim::BehaviorFault step_all(double dt, const std::int32_t& stepping);
  /// Sets the instance's `state` from text; `migrate`: through its `migrate` function, if it has one.
  sim::BehaviorFault restore(std::int32_t number, std::string_view state, bool migrate);
  /// Returns the instance's `state` serialized as text. The error names the key of a value that can't be serialized.
  Result<std::string> state(std::int32_t number);
  /// Releases the instance's data. Its number is not used again.
  void drop(std::int32_t number);

 private:
  bool push(int functions, std::int32_t number);
  sim::BehaviorFault guarded_call(int arguments, int results);

  Vm& vm_;
  int make_ = -1;  // registry references of exported functions
  int clear_lists_ = -1;
  int restore_ = -1;
  int accept_migrated_state_ = -1;
  int step_all_ = -1;
  int state_ = -1;
  int drop_ = -1;
  int self_of_ = -1;  // tables indexed by the instance's number
  int start_of_ = -1;
  int step_of_ = -1;
  int migrate_of_ = -1;
};

}  // namespace limber::script
