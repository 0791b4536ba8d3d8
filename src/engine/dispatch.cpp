// Dispatch: addresses to rows, names to things, answers.
#include "engine/dispatch.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

Outcome refused(std::string why) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::refused;
  outcome.error = std::move(why);
  return outcome;
}

// the seed's `basis`, `prevpos`, `nextpos` took frames apart; what to use instead
constexpr std::string_view kGone =
    "a joint's frames can't be changed while it lives; move the parts (position, rotation) or make the joint anew";

constexpr std::string_view kGoneAddresses[] = {"/physics/joint/basis", "/physics/joint/prevpos",
                                               "/physics/joint/nextpos"};

std::string text_of(const Arg& name) { return name.is_text() ? name.text : number_text(name.number); }

}  // namespace

Dispatch::Dispatch(World& world) : world_(world), store_(world.store()) {
  for (const Table* table : {&World::table(), &Part::table(), &Joint::table(), &Motor::table()}) {
    for (const Row& row : table->rows()) {
      if (row.kind == RowKind::readout) continue;
      by_name_[plain_name(table->seed() + "/" + row.name)] = {table, &row};
    }
  }
  irregular_["/physics/part/force"] = &Dispatch::part_force;
  irregular_["/get"] = &Dispatch::get;
  for (const char* what : {"bodies", "parts", "joints", "motors", "shapes"}) {
    irregular_[fmt::format("/list/{}", what)] = &Dispatch::list;
  }
}

std::vector<std::string> Dispatch::seed_addresses() const {
  std::vector<std::string> addresses;
  for (const Table* table : {&World::table(), &Part::table(), &Joint::table(), &Motor::table()}) {
    for (const Row& row : table->rows()) {
      if (row.kind != RowKind::readout) addresses.push_back(plain_name(table->seed() + "/" + row.name));
    }
  }
  addresses.emplace_back("/physics/part/force");
  return addresses;
}

Outcome Dispatch::execute(const Message& message) {
  const std::string plain = plain_name(message.address);
  if (const auto found = by_name_.find(plain); found != by_name_.end()) return by_name(found->second, message);
  if (const auto found = irregular_.find(plain); found != irregular_.end()) return (this->*found->second)(message);
  if (std::find(std::begin(kGoneAddresses), std::end(kGoneAddresses), plain) != std::end(kGoneAddresses)) {
    return refused(std::string(kGone));
  }
  return by_path(message);
}

std::span<const NodeId> Dispatch::elements(const Body& body, const Table& table) const {
  return store_.children(store_.child(body.id(), table.name()));
}

Result<std::vector<Place>> Dispatch::places_of(const ByName& entry, std::span<const Arg> names) {
  std::vector<Place> places;
  const Table& table = *entry.table;
  const auto add = [&](const Body& body, std::string_view element) {
    for (const NodeId id : elements(body, table)) {
      if (element.empty() || pattern_match(element, store_.name(id))) places.push_back({id, entry.row});
    }
  };
  if (names.empty()) {
    for (const auto& body : world_.bodies()) add(*body, "");
    return places;
  }
  const std::string first = text_of(names[0]);
  if (names.size() == 2) {
    const std::string second = text_of(names[1]);
    std::vector<std::string_view> near;
    for (const auto& body : world_.bodies()) {
      if (!pattern_match(first, body->name())) continue;
      add(*body, second);
      if (near.empty()) {
        for (const NodeId id : elements(*body, table)) near.push_back(store_.name(id));
      }
    }
    if (!places.empty()) return places;
    if (world_.find_body(first) == nullptr && !is_pattern(first)) {
      return Error{fmt::format("there is no body '{}'{}", first, name_hint(first, world_.body_names()))};
    }
    return Error{fmt::format("no {} '{}' in '{}'{}", table.name(), second, first, name_hint(second, near))};
  }
  // one name: a body's, else an element's in every body
  for (const auto& body : world_.bodies()) {
    if (pattern_match(first, body->name())) add(*body, "");
  }
  if (!places.empty() || world_.find_body(first) != nullptr) return places;
  for (const auto& body : world_.bodies()) add(*body, first);
  if (!places.empty()) return places;
  std::vector<std::string_view> near = world_.body_names();
  if (!world_.bodies().empty()) {
    for (const NodeId id : elements(*world_.bodies().front(), table)) near.push_back(store_.name(id));
  }
  return Error{fmt::format("there is no body or {} '{}'{}", table.name(), first, name_hint(first, near))};
}

Outcome Dispatch::by_name(const ByName& entry, const Message& message) {
  const std::span<const Arg> args = message.args;
  const Result<std::size_t> count = value_count(*entry.row, args);
  if (!count) return refused(count.error());
  const std::span<const Arg> names = args.first(args.size() - *count);
  const std::span<const Arg> value = args.last(*count);
  if (entry.table == &World::table()) {
    if (!names.empty()) return refused(fmt::format("takes {} and no names", takes_text(*entry.row)));
    const std::vector<Place> places{{world_.id(), entry.row}};
    return entry.row->kind == RowKind::action ? act(places, value) : apply(places, true, value);
  }
  if (names.size() > 2)
    return refused(fmt::format("takes a body, a {} and {}", entry.table->name(), takes_text(*entry.row)));
  for (const Arg& name : names) {
    if (name.kind == Arg::Kind::nil) return refused("nothing stands where a name is expected");
  }
  const Result<std::vector<Place>> places = places_of(entry, names);
  if (!places) return refused(places.error());
  const bool only_one = names.size() == 2 && !is_pattern(text_of(names[0])) && !is_pattern(text_of(names[1]));
  return entry.row->kind == RowKind::action ? act(*places, value) : apply(*places, only_one, value);
}

Outcome Dispatch::by_path(const Message& message) {
  const bool pattern = is_pattern(message.address) || message.address.find("//") != std::string::npos;
  Result<std::vector<Place>> places = match_places(store_, message.address);
  if (!places) return unknown(message);
  std::erase_if(*places, [&](const Place& place) {
    return place.row == nullptr || (pattern && place.row->kind == RowKind::readout);
  });
  if (places->empty()) return pattern ? refused("this pattern matches nothing that can be set") : unknown(message);
  const Row& row = *places->front().row;
  if (row.kind == RowKind::action) return act(*places, message.args);
  if (!row.writable()) return refused("this can be read, not set");
  return apply(*places, !pattern, message.args);
}

Outcome Dispatch::apply(const std::vector<Place>& places, bool only_one, std::span<const Arg> value) {
  // first everything is looked at, then everything is set: nothing of a refused message is applied
  struct Write {
    Place place;
    RowValues values;
  };
  std::vector<Write> writes;
  Outcome outcome;
  const Row* read_for = nullptr;
  Result<RowValues> given = RowValues{};
  for (const Place& place : places) {
    if (place.row->kind == RowKind::action)
      return refused(fmt::format("{} is an action among values", place.row->name));
    if (place.row != read_for) given = coerce(*place.row, value);
    read_for = place.row;
    if (!given) return refused(given.error());
    const Result<RowValues> values = spread(store_, place.node, *place.row, *given);
    const Result<void> may = !values || place.row->refuse == nullptr
                                 ? Result<void>{}
                                 : place.row->refuse(store_.thing(place.node), values->values.data());
    if (!values || !may) {
      // many things at once leave out those that can't; one by its own name is refused with the reason
      if (!only_one) continue;
      return refused(fmt::format("{}: {}", store_.path(place.node), values ? may.error() : values.error()));
    }
    writes.push_back({place, *values});
  }
  for (const Write& write : writes) {
    const Result<SetOutcome> set =
        store_.set(write.place.node, *write.place.row, {write.values.values.data(), write.values.count});
    if (!set) return refused(set.error());
    outcome.clamped = outcome.clamped || set->clamped;
    outcome.kept = outcome.kept || write.place.row->kind == RowKind::property;
  }
  return outcome;
}

Outcome Dispatch::act(const std::vector<Place>& places, std::span<const Arg> value) {
  std::vector<double> numbers;
  for (const Arg& arg : value) {
    if (!arg.is_numeric() || !std::isfinite(arg.number))
      return refused(fmt::format("takes {}", takes_text(*places.front().row)));
    numbers.push_back(arg.number);
  }
  for (const Place& place : places) {
    const std::size_t n = numbers.size();
    if (place.row->act == nullptr) return refused(fmt::format("{} is a value among actions", place.row->name));
    if (n < place.row->min_args || n > place.row->max_args || (place.row->max_args >= 3 && n % 3 != 0)) {
      return refused(fmt::format("takes {}, not {}", takes_text(*place.row), n));
    }
  }
  for (const Place& place : places) {
    if (!store_.alive(place.node)) continue;  // an action before may have removed it
    const Result<void> done = place.row->act(store_.thing(place.node), numbers);
    if (!done) return refused(done.error());
  }
  return {};
}

Outcome Dispatch::part_force(const Message& message) {
  // the seed's: a force of 3 numbers, and where it acts relative to the centre of mass, world axes
  std::size_t numbers = 0;
  const std::span<const Arg> args = message.args;
  while (numbers < args.size() && args[args.size() - 1 - numbers].is_numeric()) numbers++;
  if (numbers != 3 && numbers != 6) return refused(fmt::format("takes 3 numbers, or 6 with a place, not {}", numbers));
  double v[6] = {};
  for (std::size_t i = 0; i < numbers; i++) {
    v[i] = args[args.size() - numbers + i].number;
    if (!std::isfinite(v[i])) return refused(fmt::format("takes numbers; {} is none", v[i]));
  }
  if (args.size() - numbers > 2) return refused("takes a body, a part and 3 or 6 numbers");
  const ByName entry{&Part::table(), &Part::table().at("apply_force")};
  const Result<std::vector<Place>> places = places_of(entry, args.first(args.size() - numbers));
  if (!places) return refused(places.error());
  for (const Place& place : *places) {
    Part& part = *static_cast<Part*>(store_.thing(place.node));
    part.apply_force_at({v[0], v[1], v[2]}, part.center() + Vec3(v[3], v[4], v[5]));
  }
  return {};
}

Outcome Dispatch::list(const Message& message) {
  const std::string kind = plain_name(message.address).substr(6);
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message answer{"/list/" + kind, {}};
  if (kind == "bodies" || kind == "shapes") {
    if (kind == "bodies") {
      for (const auto& body : world_.bodies()) answer.args.push_back(Arg::of(body->name()));
    } else {
      for (const auto& shape : world_.shapes()) answer.args.push_back(Arg::of(shape->name()));
    }
    outcome.answers.push_back(std::move(answer));
    return outcome;
  }
  if (message.args.size() != 1) return refused("takes the name of a body");
  const std::string name = text_of(message.args[0]);
  const Body* body = world_.find_body(name);
  if (body == nullptr)
    return refused(fmt::format("there is no body '{}'{}", name, name_hint(name, world_.body_names())));
  answer.args.push_back(Arg::of(name));
  const std::string group = kind.substr(0, kind.size() - 1);
  for (const NodeId id : store_.children(store_.child(body->id(), group)))
    answer.args.push_back(Arg::of(store_.name(id)));
  outcome.answers.push_back(std::move(answer));
  return outcome;
}

Outcome Dispatch::get(const Message& message) {
  if (message.args.size() != 1 || !message.args[0].is_text())
    return refused("takes a path, such as /physics/sim/gravity");
  const Result<std::vector<Place>> places = match_places(store_, message.args[0].text, 256);
  if (!places) return refused(places.error());
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  for (const Place& place : *places) {
    if (place.row == nullptr || place.row->kind == RowKind::action) continue;
    std::array<double, 4> values{};
    store_.get(place.node, *place.row, values.data());
    Message answer{store_.path(place.node) + "/" + place.row->name, {}};
    for (std::uint32_t i = 0; i < place.row->width; i++) answer.args.push_back(Arg::of(values[i]));
    outcome.answers.push_back(std::move(answer));
  }
  if (outcome.answers.empty()) return refused(fmt::format("'{}' is no value", message.args[0].text));
  return outcome;
}

Outcome Dispatch::unknown(const Message& message) const {
  Outcome outcome;
  outcome.kind = Outcome::Kind::unknown;
  // for a path the catalog says which part of it fails; else near addresses by name
  const Result<Place> place = find_place(store_, message.address);
  if (!place && message.address.starts_with("/physics/body/")) {
    outcome.error = place.error();
    return outcome;
  }
  outcome.error = fmt::format("there is no address {}{}", message.address,
                              name_hint(plain_name(message.address), seed_addresses()));
  return outcome;
}

}  // namespace limber
