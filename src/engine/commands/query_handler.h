// QueryHandler: executes the queries /list/… and /get, and suggests similar addresses for unknown ones. [sim]
#pragma once

#include "base/message.h"
#include "engine/commands/outcome.h"
#include "engine/commands/selector.h"
#include "sim/world/world.h"

namespace limber::engine {

class QueryHandler {
 public:
  /// `hints`: limits the number of "did you mean" hints per tick. `budget`: limits the work of the patterns in a
  /// query.
  QueryHandler(sim::World& world, HintBudget& hints, PatternBudget& budget)
      : world_(world), hints_(hints), budget_(budget) {}

  /// Answers /list/bodies, shapes, gears and groups, and /list/parts, joints, motors and behaviors of a body, with
  /// names in stream order, or with an empty text if there are none.
  Outcome list(std::string_view kind, std::span<const Arg> args) const;
  /// Answers /get with address and value of each property that the path or pattern matches.
  Outcome get(std::span<const Arg> args) const;
  /// Returns a hint to append to the error about an unknown address: the most similar one of `by_name` and of the
  /// properties of the top-level nodes (/transport, /scene, …), else how to list all. Empty once the hints of the tick
  /// are used up.
  std::string address_hint(std::string_view address, const std::vector<std::string>& by_name) const;

 private:
  Outcome list_of_body(std::string_view kind, std::span<const Arg> args) const;

  sim::World& world_;
  HintBudget& hints_;
  PatternBudget& budget_;
};

}  // namespace limber::engine
