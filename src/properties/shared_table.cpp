// Property tables that are defined at run time; they live until the program exits.
#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "properties/property_table.h"

namespace limber {

namespace {

bool same_property(const Property& a, const Property& b) {
  return a.name == b.name && a.type == b.type && a.kind == b.kind && a.unit == b.unit && a.min == b.min &&
         a.max == b.max && a.axis_min == b.axis_min && a.axis_max == b.axis_max && a.step == b.step &&
         a.initial == b.initial && a.doc == b.doc && a.choices == b.choices && a.own_axis == b.own_axis &&
         a.euler == b.euler && a.transient == b.transient && a.on_change == b.on_change && a.read == b.read &&
         a.write == b.write && a.read_text == b.read_text && a.validate == b.validate && a.invoke == b.invoke &&
         a.on_write == b.on_write && a.min_args == b.min_args && a.max_args == b.max_args;
}

}  // namespace

const PropertyTable& shared_table(std::string name, std::string path, std::vector<Property> properties) {
  static std::mutex mutex;
  static auto& tables =
      *new std::vector<std::unique_ptr<const PropertyTable>>;  // never destroyed: a store may outlive static objects
  const std::scoped_lock lock(mutex);
  for (const auto& table : tables) {
    if (table->name() != name || table->path() != path) continue;
    if (std::equal(properties.begin(), properties.end(), table->properties().begin(), table->properties().end(),
                   same_property))
      return *table;
  }
  tables.push_back(std::make_unique<const PropertyTable>(std::move(name), std::move(path), "", std::move(properties)));
  return *tables.back();
}

}  // namespace limber
