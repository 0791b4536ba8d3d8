// Routes in presets.
#include "engine/presets/routes.h"

#include <string>
#include <unordered_set>

#include "base/log/log.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine {

namespace {

constexpr const char* kGroup = "/physics/route";

void restore(sim::RouteList& routes, const Preset& preset) {
  for (const PresetRoute& wanted : preset.routes) {
    Result<void> done;
    if (sim::Route* const known = routes.find(wanted.name)) {
      done = routes.connect(*known, wanted.from, wanted.to);
    } else if (const Result<sim::Route*> added = routes.add(wanted.name, wanted.from, wanted.to); !added) {
      done = Error{added.error()};
    }
    if (!done) log_warning("preset '{}': {}", preset.name, done.error());
  }
}

}  // namespace

std::vector<PresetRoute> routes_of(const sim::World& world, const PresetSchema& schema) {
  std::vector<PresetRoute> found;
  const sim::RouteList& routes = world.behaviors().routes();
  if (routes.list().empty()) return found;
  std::unordered_set<std::string_view> stored;
  for (const PresetSchema::Node& node : schema.nodes()) {
    if (schema.layout(node) != nullptr && schema.path(node.parent) == kGroup) stored.insert(schema.name(node));
  }
  for (const auto& route : routes.list()) {
    if (stored.contains(route->name())) found.push_back({route->name(), route->from(), route->to()});
  }
  return found;
}

void restore_routes(sim::World& world, const Blend& blend) {
  restore(world.behaviors().routes(), *blend.a);
  if (blend.b != nullptr && blend.b != blend.a) restore(world.behaviors().routes(), *blend.b);
}

}  // namespace limber::engine
