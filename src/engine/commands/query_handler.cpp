// Answers to queries, read from the store.
#include "engine/commands/query_handler.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/behavior/behavior_list.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxValues = 256;  // maximum number of values in the answers to one /get

// Appends an empty text if the answer has no more arguments than the query: an answer must not look like a query, or
// two programs that send to each other would query each other forever.
Outcome answered(Message answer, std::size_t query_args) {
  if (answer.args.size() == query_args) answer.args.push_back(Arg::of(""));
  Outcome outcome = Outcome::answered();
  outcome.answers.push_back(std::move(answer));
  return outcome;
}

}  // namespace

Outcome QueryHandler::list(std::string_view kind, std::span<const Arg> args) const {
  const bool of_world = kind == "bodies" || kind == "shapes" || kind == "gears" || kind == "groups" ||
                        kind == "fixtures" || kind == "routes";
  if (!of_world) return list_of_body(kind, args);
  if (!args.empty()) return Outcome::rejected("takes no arguments");
  Message answer{fmt::format("/list/{}", kind), {}};
  const auto add_names = [&](const auto& objects) {
    for (const auto& object : objects) answer.args.push_back(Arg::of(object->name()));
  };
  if (kind == "bodies") add_names(world_.bodies());
  if (kind == "shapes") add_names(world_.shapes().list());
  if (kind == "gears") add_names(world_.gears().list());
  if (kind == "fixtures") add_names(world_.visuals().fixtures().list());
  if (kind == "groups") add_names(world_.behaviors().groups());
  if (kind == "routes") add_names(world_.behaviors().routes().list());
  return answered(std::move(answer), 0);
}

Outcome QueryHandler::list_of_body(std::string_view kind, std::span<const Arg> args) const {
  if (args.size() != 1 || args[0].kind == Arg::Kind::nil) return Outcome::rejected("takes the name of a body");
  const std::string name = Selector::name_text(args[0]);
  const sim::Body* body = world_.find_body(name);
  if (body == nullptr) {
    return Outcome::rejected(fmt::format("there is no body '{}'{}", printable(name),
                                         hints_.consume() ? name_hint(name, world_.body_names()) : ""));
  }
  Message answer{fmt::format("/list/{}", kind), {Arg::of(name)}};
  const Store& store = world_.store();
  if (kind == "behaviors") {
    const sim::BehaviorList& list = world_.behaviors();
    std::vector<const sim::Behavior*> behaviors(body->behaviors().list().begin(), body->behaviors().list().end());
    std::ranges::sort(behaviors, {}, [&](const sim::Behavior* behavior) { return list.order().place(*behavior); });
    for (const sim::Behavior* behavior : behaviors) answer.args.push_back(Arg::of(behavior->name()));
    return answered(std::move(answer), 1);
  }
  const std::string_view group = kind.substr(0, kind.size() - 1);
  for (const NodeId id : store.children(store.child(body->id(), group))) answer.args.push_back(Arg::of(store.name(id)));
  return answered(std::move(answer), 1);
}

Outcome QueryHandler::get(std::span<const Arg> args) const {
  if (args.size() != 1 || !args[0].is_text()) return Outcome::rejected("takes a path, such as /physics/sim/gravity");
  const Store& store = world_.store();
  const std::string& path = args[0].text;
  const Result<std::vector<PropertyRef>> refs = match_properties(store, path, budget_, kMaxValues + 1);
  if (!refs) return Outcome::rejected(refs.error());
  if (refs->size() > kMaxValues) {
    return Outcome::rejected(
        fmt::format("'{}' matches more than {} values; query fewer at a time", printable(path), kMaxValues));
  }
  Outcome outcome = Outcome::answered();
  for (const PropertyRef& ref : *refs) {
    if (ref.property == nullptr || ref.property->kind == PropertyKind::action) continue;
    std::array<double, 4> values{};
    store.get(ref.node, *ref.property, values.data());
    Message& answer = outcome.answers.emplace_back();
    answer.address = store.path(ref.node) + "/" + ref.property->name;
    for (std::uint32_t i = 0; i < ref.property->width; i++) answer.args.push_back(Arg::of(values[i]));
    if (ref.property->type == PropertyType::text)
      answer.args.push_back(Arg::of(ref.property->read_text(store.object(ref.node))));
  }
  if (outcome.answers.empty()) return Outcome::rejected(fmt::format("'{}' is not a property", printable(path)));
  return outcome;
}

std::string QueryHandler::address_hint(std::string_view address, const std::vector<std::string>& by_name) const {
  if (!hints_.consume()) return "";
  std::vector<std::string> candidates = by_name;
  const Store& store = world_.store();
  for (const NodeId id : store.children(store.root())) {
    for (const Property& property : store.table(id).properties())
      candidates.push_back(store.path(id) + "/" + property.name);
  }
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  const std::string_view nearest = nearest_name(normalized_name(address), views);
  return nearest.empty() ? "; `limber describe` lists all" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace limber::engine
