// BehaviorType: property tables, the registry of built-in types, and the types of a world.
#include "sim/behavior/behavior_type.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/text.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_group.h"

namespace limber::sim {

namespace {

using namespace properties;
using TypeFactory = BehaviorType (*)();

std::vector<TypeFactory>& type_factories() {
  static std::vector<TypeFactory> list;
  return list;
}

std::vector<Property> with_common(std::vector<Property> common, const std::vector<Property>& parameters) {
  LIMBER_CHECK(common.size() == kCommonBehaviorProperties);
  for (const Property& property : parameters) {
    LIMBER_CHECK(property.kind == PropertyKind::setting && property.on_change == nullptr && !property.computed() &&
                 !property.transient);
    common.push_back(property);
  }
  return common;
}

Property error_property() {
  Property property = text("error", "Error that suspended it; empty: none.");
  property.read_text = [](const void* object) -> std::string_view {
    return static_cast<const Behavior*>(object)->error();
  };
  return property;
}

}  // namespace

std::string normalized_type_name(std::string_view name) {
  constexpr std::string_view kSuffix = "behavior";
  std::string normalized = normalized_name(name);
  if (normalized.size() > kSuffix.size() && normalized.ends_with(kSuffix))
    normalized.resize(normalized.size() - kSuffix.size());
  return normalized;
}

BehaviorType BehaviorType::create(std::string name, std::string doc, BehaviorTargets targets, bool is_group,
                                  std::vector<Property> parameters, std::function<std::unique_ptr<Behavior>()> make) {
  BehaviorType type;
  std::vector<Property> properties = with_common(common_behavior_properties(), parameters);
  properties.push_back(error_property());  // must be last: it has no numeric value, and so no bit in the set of
                                           // explicitly set properties
  type.table =
      &shared_table("behavior", fmt::format("/physics/body/<body>/behavior/<{}>", name), std::move(properties));
  if (is_group) {
    for (Property& property : parameters) property.on_write = &BehaviorGroup::set_on_members;
    type.group_table = &shared_table("group", fmt::format("/physics/group/<{}>", name),
                                     with_common(common_group_properties(), parameters));
  }
  type.name = std::move(name);
  type.doc = std::move(doc);
  type.targets = targets;
  type.is_group = is_group;
  type.make = std::move(make);
  return type;
}

BuiltInBehavior::BuiltInBehavior(TypeFactory factory) { type_factories().push_back(factory); }

BehaviorTypes::BehaviorTypes() {
  for (const TypeFactory factory : type_factories()) {
    BehaviorType type = factory();
    type.is_built_in = true;
    types_.push_back(std::make_shared<const BehaviorType>(std::move(type)));
  }
  std::sort(types_.begin(), types_.end(), [](const auto& a, const auto& b) { return a->name < b->name; });
}

Result<void> BehaviorTypes::add(BehaviorType type) {
  if (const auto fault = name_error(type.name)) return Error{fmt::format("behavior type: {}", *fault)};
  const std::string normalized = normalized_type_name(type.name);
  const auto has_same_name = [&](const auto& t) { return normalized_type_name(t->name) == normalized; };
  const auto existing = std::find_if(types_.begin(), types_.end(), has_same_name);
  if (existing != types_.end() && (*existing)->is_built_in) {
    return Error{fmt::format("'{}' is a built-in behavior type ('{}'); rename the file", printable(type.name),
                             (*existing)->name)};
  }
  auto shared = std::make_shared<const BehaviorType>(std::move(type));
  if (existing != types_.end()) {
    *existing = std::move(shared);
  } else {
    types_.push_back(std::move(shared));
  }
  return {};
}

void BehaviorTypes::remove(std::string_view name) {
  const std::string normalized = normalized_type_name(name);
  std::erase_if(types_, [&](const auto& t) { return !t->is_built_in && normalized_type_name(t->name) == normalized; });
}

std::shared_ptr<const BehaviorType> BehaviorTypes::find(std::string_view name) const {
  const std::string normalized = normalized_type_name(name);
  for (const auto& type : types_) {
    if (normalized_type_name(type->name) == normalized) return type;
  }
  return nullptr;
}

Result<std::shared_ptr<const BehaviorType>> BehaviorTypes::require(std::string_view name) const {
  if (std::shared_ptr<const BehaviorType> type = find(name)) return type;
  std::vector<std::string_view> names;
  for (const auto& type : types_) names.push_back(type->name);
  // search similar names without the suffix of ofxDabPhysics' class names
  const std::string normalized = normalized_type_name(name);
  const std::string_view typed_name = normalized.size() < normalized_name(name).size() ? normalized : name;
  return Error{fmt::format("there is no behavior type '{}'{}", printable(name), name_hint(typed_name, names))};
}

}  // namespace limber::sim
