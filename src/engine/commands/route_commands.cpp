// Messages that add, connect and remove routes.
#include "engine/commands/route_commands.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/commands/selector.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine {

namespace {

Outcome override_if(const Result<void>& done) {
  if (!done) return Outcome::rejected(done.error());
  Outcome outcome;
  outcome.sets_override = true;
  return outcome;
}

Outcome unknown_route(const sim::RouteList& routes, const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& route : routes.list()) names.push_back(route->name());
  return Outcome::rejected(fmt::format("there is no route '{}'{}", printable(name), name_hint(name, names)));
}

}  // namespace

Outcome edit_routes(sim::World& world, std::string_view address, std::span<const Arg> args) {
  sim::RouteList& routes = world.behaviors().routes();
  const bool removes = address == "/route/remove";
  const bool valid = removes ? args.size() == 1 : args.size() == 3 && args[1].is_text() && args[2].is_text();
  if (!valid || args[0].kind == Arg::Kind::nil)
    return Outcome::rejected(removes ? "takes the name of a route"
                                     : "takes a name and two addresses: the source and the target of the route");
  const std::string name = Selector::name_text(args[0]);
  if (address == "/route/add") {
    const Result<sim::Route*> added = routes.add(name, args[1].text, args[2].text);
    return override_if(added ? Result<void>() : Error{added.error()});
  }
  sim::Route* const route = routes.find(name);
  if (route == nullptr) return unknown_route(routes, name);
  if (!removes) return override_if(routes.connect(*route, args[1].text, args[2].text));
  routes.remove(*route);
  return override_if({});
}

}  // namespace limber::engine
