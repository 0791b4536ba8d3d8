// Questions from outside, answered from the store.
#include "engine/answers.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kMostValues = 256;  // values that one /get answers with

// no answer looks like a question: else two programs that are aimed at each other would ask for ever
Outcome answered(Message answer, std::size_t question) {
  if (answer.args.size() == question) answer.args.push_back(Arg::of(""));
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  outcome.answers.push_back(std::move(answer));
  return outcome;
}

}  // namespace

Outcome Answers::list(std::string_view kind, std::span<const Arg> args) const {
  Message answer{fmt::format("/list/{}", kind), {}};
  if (kind == "bodies" || kind == "shapes" || kind == "gears" || kind == "groups") {
    if (!args.empty()) return Outcome::refused("takes no arguments");
    for (const auto& body : world_.bodies()) {
      if (kind == "bodies") answer.args.push_back(Arg::of(body->name()));
    }
    for (const auto& shape : world_.shapes()) {
      if (kind == "shapes") answer.args.push_back(Arg::of(shape->name()));
    }
    for (const auto& gear : world_.gears()) {
      if (kind == "gears") answer.args.push_back(Arg::of(gear->name()));
    }
    for (const BehaviorGroup* group : world_.behaviors().groups()) {
      if (kind == "groups") answer.args.push_back(Arg::of(group->name()));
    }
    return answered(std::move(answer), 0);
  }
  if (args.size() != 1 || args[0].kind == Arg::Kind::nil) return Outcome::refused("takes the name of a body");
  const std::string name = Selector::text(args[0]);
  const Body* body = world_.find_body(name);
  if (body == nullptr) {
    return Outcome::refused(fmt::format("there is no body '{}'{}", printable(name),
                                        hints_.take() ? name_hint(name, world_.body_names()) : ""));
  }
  answer.args.push_back(Arg::of(name));
  const Store& store = world_.store();
  if (kind == "behaviors") {
    const BehaviorList& list = world_.behaviors();
    std::vector<const Behavior*> behaviors(body->behaviors().begin(), body->behaviors().end());
    std::ranges::sort(behaviors, {}, [&](const Behavior* behavior) { return list.place(*behavior); });
    for (const Behavior* behavior : behaviors) answer.args.push_back(Arg::of(behavior->name()));
    return answered(std::move(answer), 1);
  }
  const std::string_view group = kind.substr(0, kind.size() - 1);
  for (const NodeId id : store.children(store.child(body->id(), group))) answer.args.push_back(Arg::of(store.name(id)));
  return answered(std::move(answer), 1);
}

Outcome Answers::get(std::span<const Arg> args) const {
  if (args.size() != 1 || !args[0].is_text()) return Outcome::refused("takes a path, such as /physics/sim/gravity");
  const Store& store = world_.store();
  const std::string& path = args[0].text;
  const Result<std::vector<Place>> places = match_places(store, path, work_, kMostValues + 1);
  if (!places) return Outcome::refused(places.error());
  if (places->size() > kMostValues) {
    return Outcome::refused(
        fmt::format("'{}' is more than {} values; ask for fewer at a time", printable(path), kMostValues));
  }
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  for (const Place& place : *places) {
    if (place.row == nullptr || place.row->kind == RowKind::action) continue;
    std::array<double, 4> values{};
    store.get(place.node, *place.row, values.data());
    Message& answer = outcome.answers.emplace_back();
    answer.address = store.path(place.node) + "/" + place.row->name;
    for (std::uint32_t i = 0; i < place.row->width; i++) answer.args.push_back(Arg::of(values[i]));
    if (place.row->type == RowType::text) answer.args.push_back(Arg::of(place.row->say(store.thing(place.node))));
  }
  if (outcome.answers.empty()) return Outcome::refused(fmt::format("'{}' is no value", printable(path)));
  return outcome;
}

std::string Answers::near_address(std::string_view address, const std::vector<std::string>& by_name) const {
  if (!hints_.take()) return "";
  std::vector<std::string> all = by_name;
  const Store& store = world_.store();
  for (const NodeId id : store.children(store.root())) {
    for (const Row& row : store.table(id).rows()) all.push_back(store.path(id) + "/" + row.name);
  }
  const std::vector<std::string_view> views(all.begin(), all.end());
  const std::string_view near = nearest_name(plain_name(address), views);
  return near.empty() ? "; `limber describe` lists all" : fmt::format("; did you mean '{}'?", near);
}

}  // namespace limber
