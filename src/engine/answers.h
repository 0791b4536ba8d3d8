// Answers: the messages that ask: /list/… and /get; and what is said to an address that there is not. [sim]
#pragma once

#include "base/message.h"
#include "engine/outcome.h"
#include "engine/select.h"
#include "sim/world.h"

namespace limber {

class Answers {
 public:
  /// `work` is what patterns of a question may cost.
  Answers(World& world, HintBudget& hints, PatternBudget& work) : world_(world), hints_(hints), work_(work) {}

  /// /list/bodies, /list/shapes, /list/gears, /list/groups; /list/parts, joints, motors, behaviors of a body: names in
  /// the streams' order; an empty text where there is none.
  Outcome list(std::string_view kind, std::span<const Arg> args) const;
  /// /get: the row's address and value; a pattern answers for each.
  Outcome get(std::span<const Arg> args) const;
  /// What else an address may have meant, among `by_name` and the rows of /transport, /osc, /scene.
  std::string near_address(std::string_view address, const std::vector<std::string>& by_name) const;

 private:
  World& world_;
  HintBudget& hints_;
  PatternBudget& work_;
};

}  // namespace limber
