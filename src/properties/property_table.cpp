// Property tables: layout of the properties in blocks, lookup by name, tables that are defined at run time, builders.
#include "properties/property_table.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/hash.h"
#include "base/text.h"
#include "properties/units.h"

namespace limber {

std::uint32_t width_of(PropertyType type) {
  switch (type) {
    case PropertyType::vec3:
    case PropertyType::flags3:
      return 3;
    case PropertyType::quat:
      return 4;
    case PropertyType::none:
    case PropertyType::text:
      return 0;
    default:
      return 1;
  }
}

std::string_view type_name(PropertyType type) {
  constexpr std::string_view kNames[] = {"number", "integer", "boolean", "choice", "vec3",
                                         "flags3", "quat",    "action",  "text"};
  return kNames[static_cast<std::size_t>(type)];
}

std::string_view kind_name(PropertyKind kind) {
  constexpr std::string_view kNames[] = {"property", "state", "readout", "action"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string range_text(const Property& property) {
  if (property.axis_min.empty() || property.axis_max.empty())
    return fmt::format("{} .. {}", property.min, property.max);
  return fmt::format("{} .. {}", fmt::join(property.axis_min, " "), fmt::join(property.axis_max, " "));
}

PropertyTable::PropertyTable(std::string name, std::string path, std::string legacy_prefix,
                             std::vector<Property> properties, void (*prefetch)(const void* object))
    : name_(std::move(name)),
      path_(std::move(path)),
      legacy_prefix_(std::move(legacy_prefix)),
      properties_(std::move(properties)),
      prefetch_(prefetch) {
  LIMBER_CHECK(properties_.size() <= 64);
  for (std::uint32_t i = 0; i < properties_.size(); i++) {
    Property& property = properties_[i];
    property.index = i;
    property.width = width_of(property.type);
    normalized_names_.push_back(normalized_name(property.name));
    LIMBER_CHECK(known_unit(property.unit));
    LIMBER_CHECK(property.axis_min.empty() || property.axis_min.size() == property.width);
    LIMBER_CHECK(property.axis_max.empty() || property.axis_max.size() == property.width);
    if (!property.stored()) continue;
    std::uint32_t& width = property.transient ? transient_width_ : persistent_width_;
    property.offset = width;
    width += property.width;
    property.hashed = property.hashed || property.writable();
    std::uint64_t key = hash_bytes(property.name);
    for (std::uint32_t number = 0; number < property.width; number++) {
      const std::uint64_t next = splitmix64(key);
      (property.transient ? hashed_transient_ : hashed_persistent_)
          .push_back({property.hashed ? next : 0, std::bit_cast<std::uint64_t>(property.initial[number])});
    }
  }
}

const Property* PropertyTable::find(std::string_view name) const {
  for (std::size_t i = 0; i < properties_.size(); i++) {
    if (properties_[i].name == name || same_name(normalized_names_[i], name)) return &properties_[i];
  }
  return nullptr;
}

const Property& PropertyTable::at(std::string_view name) const {
  for (const Property& property : properties_) {
    if (property.name == name) return property;
  }
  LIMBER_CHECK(!"the class has this property");
  return properties_.front();
}

std::vector<std::string_view> PropertyTable::property_names() const {
  std::vector<std::string_view> names;
  for (const Property& property : properties_) names.push_back(property.name);
  return names;
}

namespace {

// The fields that declare a property.
auto declaration(const Property& p) {
  return std::tie(p.name, p.type, p.kind, p.unit, p.min, p.max, p.axis_min, p.axis_max, p.step, p.initial, p.doc,
                  p.choices, p.own_axis, p.euler, p.transient, p.on_change, p.read, p.write, p.read_text, p.validate,
                  p.invoke, p.on_write, p.min_args, p.max_args);
}

}  // namespace

const PropertyTable& shared_table(std::string name, std::string path, std::vector<Property> properties) {
  static std::mutex mutex;
  static auto& tables =
      *new std::vector<std::unique_ptr<const PropertyTable>>;  // never destroyed: a store may outlive static objects
  const std::scoped_lock lock(mutex);
  for (const auto& table : tables) {
    if (table->name() != name || table->path() != path) continue;
    if (std::ranges::equal(properties, table->properties(), {}, declaration, declaration)) return *table;
  }
  tables.push_back(std::make_unique<const PropertyTable>(std::move(name), std::move(path), "", std::move(properties)));
  return *tables.back();
}

namespace properties {

namespace {
Property make(std::string name, PropertyType type, std::string unit, double min, double max, std::string doc) {
  Property property;
  property.name = std::move(name);
  property.type = type;
  property.unit = std::move(unit);
  property.min = min;
  property.max = max;
  property.doc = std::move(doc);
  return property;
}
}  // namespace

Property number(std::string name, std::string unit, double initial, double min, double max, std::string doc) {
  Property property = make(std::move(name), PropertyType::number, std::move(unit), min, max, std::move(doc));
  property.initial[0] = initial;
  return property;
}

Property integer(std::string name, double initial, double min, double max, std::string doc) {
  Property property = make(std::move(name), PropertyType::integer, "", min, max, std::move(doc));
  property.initial[0] = initial;
  return property;
}

Property boolean(std::string name, bool initial, std::string doc) {
  Property property = make(std::move(name), PropertyType::boolean, "", 0, 1, std::move(doc));
  property.initial[0] = initial ? 1 : 0;
  return property;
}

Property choice(std::string name, std::vector<std::string> labels, std::uint32_t initial, std::string doc) {
  Property property =
      make(std::move(name), PropertyType::choice, "", 0, static_cast<double>(labels.size()) - 1, std::move(doc));
  property.initial[0] = initial;
  property.choices = std::move(labels);
  return property;
}

Property vec3(std::string name, std::string unit, std::array<double, 3> initial, double min, double max,
              std::string doc) {
  Property property = make(std::move(name), PropertyType::vec3, std::move(unit), min, max, std::move(doc));
  property.initial = {initial[0], initial[1], initial[2], 0};
  return property;
}

Property flags3(std::string name, std::array<bool, 3> initial, std::string doc) {
  Property property = make(std::move(name), PropertyType::flags3, "", 0, 1, std::move(doc));
  for (std::size_t i = 0; i < 3; i++) property.initial[i] = initial[i] ? 1 : 0;
  return property;
}

Property quat(std::string name, std::string doc) {
  Property property = make(std::move(name), PropertyType::quat, "", -1, 1, std::move(doc));
  property.initial = {0, 0, 0, 1};
  return property;
}

Property text(std::string name, std::string doc) {
  Property property = make(std::move(name), PropertyType::text, "", 0, 0, std::move(doc));
  property.kind = PropertyKind::readout;
  return property;
}

Property action(std::string name, std::uint32_t min_args, std::uint32_t max_args, std::string doc) {
  Property property = make(std::move(name), PropertyType::none, "", 0, 0, std::move(doc));
  property.kind = PropertyKind::action;
  property.min_args = min_args;
  property.max_args = max_args;
  return property;
}

Property state(Property property) {
  property.kind = PropertyKind::state;
  return property;
}

Property readout(Property property) {
  property.kind = PropertyKind::readout;
  return property;
}

Property transient(Property property) {
  property.transient = true;
  return property;
}

Property axes(Property property) {
  property.own_axis = true;
  return property;
}

Property hashed(Property property) {
  property.hashed = true;
  return property;
}

Property euler_angles(Property property) {
  property.euler = true;
  return property;
}

Property independent(Property property) {
  property.independent = true;
  return property;
}

}  // namespace properties
}  // namespace limber
