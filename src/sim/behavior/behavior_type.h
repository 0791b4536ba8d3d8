// BehaviorType: name, targets, parameters and factory of a type of behavior. Built-in types register themselves; the
// script module adds those of behaviors_lua/. [sim]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "properties/property_table.h"

namespace limber::sim {

class Behavior;

/// Normalizes a type name for comparison: by the naming rule, and without a trailing "behavior".
std::string normalized_type_name(std::string_view name);

/// The objects of a body that a type acts on.
enum class BehaviorTargets : std::uint8_t {
  parts,
  pairs,   ///< Parts, in pairs, in the order in which the scene names them.
  motors,  ///< Motors; a selected joint means its motor.
  any,
};

struct BehaviorType {
  std::string name;  ///< snake_case.
  std::string doc;   ///< One line.
  BehaviorTargets targets = BehaviorTargets::any;
  bool is_group = false;  ///< Attached to several bodies at once, with one instance per body.
  bool is_built_in = false;
  const PropertyTable* table = nullptr;  ///< Properties of an instance: the common ones, then the parameters.
  /// Properties of a group: the same; setting one sets it on every member.
  const PropertyTable* group_table = nullptr;
  std::function<std::unique_ptr<Behavior>()> make;

  /// True if this is a newer version of `other`, after a reload.
  bool replaces(const BehaviorType& other) const { return name == other.name && this != &other; }

  /// Creates a type with its property tables, which live as long as the program. `parameters`: at most 61 stored
  /// properties; names must be unique under the naming rule and differ from the common properties.
  static BehaviorType create(std::string name, std::string doc, BehaviorTargets targets, bool is_group,
                             std::vector<Property> parameters, std::function<std::unique_ptr<Behavior>()> make);
  /// The same for a C++ class.
  template <class T>
  static BehaviorType create(std::string name, std::string doc, BehaviorTargets targets,
                             std::vector<Property> parameters) {
    return create(std::move(name), std::move(doc), targets, false, std::move(parameters),
                  [] { return std::make_unique<T>(); });
  }
  template <class T>
  static BehaviorType create_group(std::string name, std::string doc, std::vector<Property> parameters) {
    return create(std::move(name), std::move(doc), BehaviorTargets::parts, true, std::move(parameters),
                  [] { return std::make_unique<T>(); });
  }
};

/// Registers a built-in type: `const BuiltInBehavior registered([] { return BehaviorType::create(…); });` in its file.
class BuiltInBehavior {
 public:
  explicit BuiltInBehavior(BehaviorType (*factory)());
};

/// The types that a world knows.
class BehaviorTypes {
 public:
  /// Starts with the built-in types, in alphabetical order.
  BehaviorTypes();

  /// Adds a type, or replaces a Lua type of the same name; existing instances keep their type until
  /// BehaviorList::replace_instances() replaces them. Errors: the name of a built-in type, a name that can't be
  /// printed.
  Result<void> add(BehaviorType type);
  /// Removes a Lua type; instances continue to exist. Built-in types can't be removed.
  void remove(std::string_view name);
  /// Finds a type by its normalized name; null if there is none.
  std::shared_ptr<const BehaviorType> find(std::string_view name) const;
  /// The same, but returns an error that suggests similar names.
  Result<std::shared_ptr<const BehaviorType>> require(std::string_view name) const;
  const std::vector<std::shared_ptr<const BehaviorType>>& all() const { return types_; }

 private:
  std::vector<std::shared_ptr<const BehaviorType>> types_;
};

}  // namespace limber::sim
