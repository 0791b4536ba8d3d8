// Selector: resolves the names in the arguments of a message to objects: none, a body or an element, body and element.
// [sim]
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "properties/catalog.h"
#include "sim/world/world.h"

namespace limber::sim {
class Behavior;
}  // namespace limber::sim

namespace limber::engine {

/// Limits the number of "did you mean" hints per pass: searching similar names among a thousand bodies costs far more
/// than the message itself, and a flood of wrong names must not delay the tick.
struct HintBudget {
  static constexpr int kPerPass = 32;
  int remaining = kPerPass;
  bool consume() { return remaining > 0 && remaining-- > 0; }
};

class Selector {
 public:
  /// `budget`: the budget of the patterns of a message. Exceeding it is an error, and the contents of `out` are
  /// invalid.
  Selector(sim::World& world, HintBudget& hints, PatternBudget& budget)
      : world_(world), hints_(hints), budget_(budget) {}

  /// Appends the property of all elements selected by `names` to `out`, in stream order. No name: every element of
  /// every body; one: all elements of that body, or if there is no such body, the elements of that name in every body;
  /// two: body and element. Names may be patterns.
  Result<void> select(const PropertyTable& table, const Property& property, std::span<const Arg> names,
                      std::vector<PropertyRef>& out) const;

  /// Appends the property of the shape of that name, or of all shapes without a name.
  Result<void> select_shapes(const Property& property, std::span<const Arg> names, std::vector<PropertyRef>& out) const;

  /// Appends a parameter of behaviors. `names`: a behavior, in every body, or a body and a behavior. Behaviors without
  /// this parameter are skipped; it is an error if none has it.
  Result<void> select_behaviors(std::span<const Arg> names, const Arg& parameter, std::vector<PropertyRef>& out) const;

  /// Returns a name as text; bodies may be named by numbers.
  static std::string name_text(const Arg& name);
  /// True if the names can select one object only: all `count` names are given, and none is a pattern.
  static bool is_single(std::span<const Arg> names, std::size_t count);

 private:
  void add_elements(const sim::Body& body, const PropertyTable& table, const Property& property,
                    std::string_view element, std::vector<PropertyRef>& out) const;
  /// Visits the body of that name, or all bodies that match it as a pattern (`any`: all) while the budget suffices.
  /// Returns false if there is none.
  template <class Visit>
  bool visit_bodies(std::string_view name, bool any, Visit visit) const;
  Error no_such_behavior(std::string_view name) const;
  Error no_such_name(std::string_view kind, std::string_view name) const;
  Error no_such_element(std::string_view kind, std::string_view body, std::string_view element) const;
  Error no_parameter(const sim::Behavior& behavior, std::string_view parameter) const;
  void add_names(const sim::Body& body, std::string_view kind, std::vector<std::string_view>& out) const;
  std::string hint(std::string_view name, const std::vector<std::string_view>& names) const;

  static Error budget_exceeded();

  sim::World& world_;
  HintBudget& hints_;
  PatternBudget& budget_;
};

}  // namespace limber::engine
