// BehaviorType: what a kind of behaviour is called, what it acts on, its parameters, how one is made. The built-in ones
// register themselves; the script room adds those of behaviors_lua/. [sim]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "params/table.h"

namespace limber {

class Behavior;

/// The form in which types' names are compared: the naming rule, and a trailing "behavior" dropped.
std::string plain_type_name(std::string_view name);

/// What of a body a type acts on.
enum class BehaviorTargets : std::uint8_t {
  parts,
  pairs,   ///< Parts, two by two, in the order in which the scene names them.
  motors,  ///< Motors, or joints, whose motors are meant.
  any,
};

struct BehaviorType {
  std::string name;  ///< snake_case.
  std::string doc;   ///< One line.
  BehaviorTargets targets = BehaviorTargets::any;
  bool is_group = false;  ///< Attached to several bodies at once, one instance a body.
  bool is_built_in = false;
  const Table* table = nullptr;        ///< Rows of an instance: the common ones, then the parameters.
  const Table* group_table = nullptr;  ///< Rows of a group: the same; what is written goes to every member.
  std::function<std::unique_ptr<Behavior>()> make;

  /// A type with its tables, which live as long as the program. `parameters`: at most 61 properties, no two alike by
  /// the naming rule, none called like a common row.
  static BehaviorType of(std::string name, std::string doc, BehaviorTargets targets, bool is_group,
                         std::vector<Row> parameters, std::function<std::unique_ptr<Behavior>()> make);
  /// The same for a class of ours.
  template <class T>
  static BehaviorType of(std::string name, std::string doc, BehaviorTargets targets, std::vector<Row> parameters) {
    return of(std::move(name), std::move(doc), targets, false, std::move(parameters),
              [] { return std::make_unique<T>(); });
  }
  template <class T>
  static BehaviorType of_group(std::string name, std::string doc, std::vector<Row> parameters) {
    return of(std::move(name), std::move(doc), BehaviorTargets::parts, true, std::move(parameters),
              [] { return std::make_unique<T>(); });
  }
};

/// Registers a built-in type: `const BuiltInBehavior registered([] { return BehaviorType::of(…); });` in its file.
class BuiltInBehavior {
 public:
  explicit BuiltInBehavior(BehaviorType (*describe)());
};

/// The types that a world knows.
class BehaviorTypes {
 public:
  /// The built-in ones, by alphabet.
  BehaviorTypes();

  /// Adds a type, or puts it in the place of the one of that name; instances keep the type that they were made of until
  /// they are renewed (BehaviorList::renew). Errors: the name of a built-in type, a name that can't be printed.
  Result<void> add(BehaviorType type);
  /// Instances live on. A built-in type stays.
  void remove(std::string_view name);
  /// By the naming rule, a trailing "behavior" dropped; null: there is none.
  std::shared_ptr<const BehaviorType> find(std::string_view name) const;
  /// The same; the error names near ones.
  Result<std::shared_ptr<const BehaviorType>> require(std::string_view name) const;
  const std::vector<std::shared_ptr<const BehaviorType>>& all() const { return types_; }

 private:
  std::vector<std::shared_ptr<const BehaviorType>> types_;
};

}  // namespace limber
