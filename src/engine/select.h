// Selector: which things a message means by the names it carries: all, a body's or an element's, body and element.
// [sim]
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "params/catalog.h"
#include "sim/world.h"

namespace limber {

/// How many texts with near names may be made before the next tick: looking for near ones among a thousand bodies
/// costs far more than the message, and a flood of wrong names must not hold up the tick.
struct HintBudget {
  static constexpr int kPerTick = 32;
  int left = kPerTick;
  bool take() { return left > 0 && left-- > 0; }
};

class Selector {
 public:
  /// `work` is what patterns of a message may cost; one that costs more is an error, and `out` then counts for nothing.
  Selector(World& world, HintBudget& hints, PatternBudget& work) : world_(world), hints_(hints), work_(work) {}

  /// `row` of all elements that `names` mean, in stream order, appended to `out`: none: every element of every body;
  /// one: a body's, else an element's in every body; two: body and element. Patterns may stand for names.
  Result<void> select(const Table& table, const Row& row, std::span<const Arg> names, std::vector<Place>& out) const;

  /// `row` of the shapes that a name or none means.
  Result<void> select_shapes(const Row& row, std::span<const Arg> names, std::vector<Place>& out) const;

  /// A parameter's row of behaviours: of one name in every body, or `names`: body and behaviour. Those that have no
  /// such parameter are left out, unless none has it.
  Result<void> select_behaviors(std::span<const Arg> names, const Arg& parameter, std::vector<Place>& out) const;

  /// A name as it was sent: text, or the number that a body is called.
  static std::string text(const Arg& name);
  /// Whether the names mean one thing only: all `count` that it has, without a pattern.
  static bool single(std::span<const Arg> names, std::size_t count);

 private:
  void add(const Body& body, const Table& table, const Row& row, std::string_view element,
           std::vector<Place>& out) const;
  Error nothing_called(std::string_view kind, std::string_view name) const;
  Error nothing_in(std::string_view kind, std::string_view body, std::string_view element) const;
  Error no_parameter(const Behavior& behavior, std::string_view parameter) const;
  void add_names(const Body& body, std::string_view kind, std::vector<std::string_view>& out) const;
  std::string hint(std::string_view written, const std::vector<std::string_view>& names) const;

  static Error too_much();

  World& world_;
  HintBudget& hints_;
  PatternBudget& work_;
};

}  // namespace limber
