// Dispatch: addresses to rows, values through the door.
#include "engine/dispatch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kMostPaths = 16384;  // exact paths that are remembered

// the classes whose things messages name by arguments
std::array<const Table*, 6> named_classes() {
  return {&World::table(), &Part::table(), &Joint::table(), &Motor::table(), &Camera::table(), &Shape::table()};
}

constexpr Irregular kIrregulars[] = {
    {"/physics/part/force", "[body] [part] x y z [rx ry rz]",
     "Force in N for one tick, world axes; rx ry rz: where, from the centre of mass."},
    {"/physics/part/hold", "body part x y z tx ty tz",
     "A spring pulls the point x y z, in the part's frame, to tx ty tz in the world; for half a second without "
     "another."},
    {"/physics/part/release", "body part", "Lets go of a part that is held."},
    {"/physics/behavior/parameter", "[body] behavior parameter value",
     "Sets a parameter, or active, of the behaviour of that name, in every body or one."},
    {"/visuals/camera/projection", "fovy aspect near far",
     "Sets these four of the camera; an aspect of 0: the window's."},
    {"/get", "path", "Answers with the row's address and value; a pattern with each."},
    {"/list/bodies", "", "Answers with all bodies' names, in the order of the streams."},
    {"/list/parts", "body", "Answers with the body and its parts' names."},
    {"/list/joints", "body", "Answers with the body and its joints' names, in the order of the streams."},
    {"/list/motors", "body", "Answers with the body and its motors' names."},
    {"/list/behaviors", "body", "Answers with the body and its behaviours' names, in the order in which they act."},
    {"/list/gears", "", "Answers with the names of the gears."},
    {"/list/groups", "", "Answers with the names of the group behaviours."},
    {"/list/shapes", "", "Answers with the names of the scene's shapes."},
    {"/list/scenes", "", "Answers with the names of the scenes in the folder of the one that plays."},
    {"/transport/scene", "scene", "Another scene of that folder plays from its start; the performer's values go."},
    {"/list/health", "",
     "Answers with what was dropped, reduced, disabled or lost: of each its name, how many, and how many seconds ago "
     "it began."},
    {"/list/presets", "", "Answers with the names of the presets, in their order."},
    {"/preset/store", "name [pattern ...] [behaviors] [looks] [poses] [velocities] [except pattern ...]",
     "Keeps every property, or what is named, as it is now, under that name."},
    {"/preset/recall", "name [seconds [easing]]",
     "Brings that back, at once or over seconds: smooth, linear, in or out."},
    {"/preset/morph", "preset preset amount", "What lies between two, 0: the first, 1: the second."},
    {"/preset/delete", "name", "Forgets a preset."},
    {"/take/record", "[name]", "From the scene's start on, all that comes in is recorded, so that it can be replayed."},
    {"/take/stop", "", "The take that is recorded ends, and its file is whole; or the one that plays does."},
    {"/take/play", "[name]",
     "Plays a take of the show's folder in the place of the show, the newest one if none is named."},
};

// the seed's that took a joint's frames apart; refused with the reason
constexpr const char* kGone[] = {"/physics/joint/basis", "/physics/joint/prevpos", "/physics/joint/nextpos"};

// an address in the form that is compared, without a copy on the heap; empty when it is longer than any of ours
std::string_view plain_address(std::string_view address, std::array<char, 96>& buffer) {
  if (address.size() > 1 && address.back() == '/') address.remove_suffix(1);
  std::size_t n = 0;
  for (const char c : address) {
    if (c == '_') continue;
    if (n == buffer.size()) return {};
    buffer[n++] = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return {buffer.data(), n};
}

// "part 'arm/base'", as all texts name things
std::string thing_text(const Store& store, NodeId id) {
  const std::string& word = store.table(id).name();
  const NodeId owner = store.parent(store.parent(id));  // a part stands in its body's group of parts
  if (!owner.null() && &store.table(owner) == &Body::table())
    return fmt::format("{} '{}/{}'", word, store.name(owner), store.name(id));
  return &store.table(id) == &Body::table() || word == "group" ? fmt::format("{} '{}'", word, store.name(id))
                                                               : store.path(id);
}

// how a button tells that it was let go; nothing is to be done then
bool released(std::span<const Arg> value) {
  if (value.size() != 1 || value[0].kind == Arg::Kind::nil) return false;
  return value[0].is_text() ? parse_number(value[0].text) == 0.0 : value[0].number == 0;
}

}  // namespace

std::string Dispatch::seed_address(const Table& table, const Row& row) {
  if (table.seed().empty() || row.kind == RowKind::readout) return {};
  return plain_name(table.seed() + "/" + row.name);
}

std::span<const Irregular> Dispatch::irregulars() { return kIrregulars; }

Dispatch::Dispatch(World& world, Presets* presets, std::span<const Table* const> more)
    : world_(world), presets_(presets), store_(world.store()) {
  for (const Table* table : named_classes()) add_class(*table);
  for (const Table* table : more) add_class(*table);
  for (const Irregular& irregular : kIrregulars) {
    const bool of_presets = irregular.address.starts_with("/preset/");
    const bool of_takes = irregular.address.starts_with("/take/");
    by_name_[std::string(irregular.address)].irregular = of_presets ? &Dispatch::preset
                                                         : of_takes ? &Dispatch::take
                                                                    : &Dispatch::list;
  }
  // those that are neither
  by_name_["/list/presets"].irregular = &Dispatch::preset;
  by_name_["/physics/part/force"].irregular = &Dispatch::part_force;
  by_name_["/physics/part/hold"].irregular = &Dispatch::part_hold;
  by_name_["/physics/part/release"].irregular = &Dispatch::part_release;
  by_name_["/physics/behavior/parameter"].irregular = &Dispatch::behavior_parameter;
  by_name_["/visuals/camera/projection"].irregular = &Dispatch::projection;
  by_name_["/get"].irregular = &Dispatch::get;
  by_name_["/list/health"].irregular = &Dispatch::health;
  by_name_["/list/scenes"].irregular = &Dispatch::scenes;
  by_name_["/transport/scene"].irregular = &Dispatch::scenes;
  for (const auto& [address, entry] : by_name_) addresses_.push_back(address);
  for (const char* address : kGone) by_name_[address].irregular = &Dispatch::gone;
  std::sort(addresses_.begin(), addresses_.end());
}

void Dispatch::add_class(const Table& table) {
  for (const Row& row : table.rows()) {
    if (std::string address = seed_address(table, row); !address.empty()) by_name_[address] = {&table, &row, nullptr};
  }
}

Outcome Dispatch::execute(const Message& message) {
  const int most = std::min(PatternBudget::kMessage, std::max(work_.left, 0));
  message_work_.left = most;
  Outcome outcome = execute_one(message);
  work_.left -= most - message_work_.left;
  return outcome;
}

Outcome Dispatch::execute_one(const Message& message) {
  writes_.clear();
  std::array<char, 96> buffer;
  const auto found = by_name_.find(plain_address(message.address, buffer));
  if (found == by_name_.end()) return by_path(message);
  const ByName& entry = found->second;
  return entry.irregular != nullptr ? (this->*entry.irregular)(message) : by_name(entry, message);
}

NodeId Dispatch::only_thing(const Table& table) const {
  if (&table == &World::table()) return world_.id();
  return &table == &Camera::table() ? world_.visuals().camera().id() : NodeId{};
}

Outcome Dispatch::by_name(const ByName& entry, const Message& message) {
  const std::span<const Arg> args = message.args;
  const Row& row = *entry.row;
  places_.clear();
  const bool acts = row.kind == RowKind::action;
  if (const NodeId only = only_thing(*entry.table); !only.null()) {
    places_.push_back({only, &row});
    return acts ? act(args) : apply(true, args);
  }
  const bool shapes = entry.table == &Shape::table();
  const Result<ValueSplit> split = split_value(row, args);
  if (!split) return Outcome::refused(split.error());
  const std::span<const Arg> names = args.first(args.size() - split->count);
  if (names.size() > (shapes ? 1 : 2)) {
    return Outcome::refused(fmt::format("takes a {}{} and {}; here are {} names", shapes ? "" : "body, a ",
                                        entry.table->name(), takes_text(row), names.size()));
  }
  for (const Arg& name : names) {
    if (name.kind == Arg::Kind::nil) return Outcome::refused("nothing stands where a name is expected");
  }
  const Result<void> selected =
      shapes ? selector_.select_shapes(row, names, places_) : selector_.select(*entry.table, row, names, places_);
  if (!selected) {
    return Outcome::refused(split->guessed ? fmt::format("takes {}, not {}", takes_text(row), args.size())
                                           : selected.error());
  }
  const std::span<const Arg> value = args.last(split->count);
  return acts ? act(value) : apply(Selector::single(names, shapes ? 1 : 2), value);
}

Outcome Dispatch::by_path(const Message& message) {
  const std::string_view address = message.address;
  if (is_pattern(address) || address.find("//") != std::string_view::npos) return by_pattern(message);
  if (paths_version_ != store_.structure_version() || paths_.size() > kMostPaths) {
    paths_.clear();
    paths_version_ = store_.structure_version();
  }
  auto known = paths_.find(address);
  if (known == paths_.end()) {
    const Result<Place> place = find_place(store_, address, false);
    if (!place) {
      const bool shape = address.starts_with("/visuals/shape/") && std::ranges::count(address, '/') > 3;
      const bool ours = shape || address.starts_with("/physics/body/") || address.starts_with("/physics/group/") ||
                        !address.starts_with("/");
      if (ours) return Outcome::unknown(hints_.take() ? find_place(store_, address).error() : place.error());
      return Outcome::unknown(
          fmt::format("there is no address {}{}", printable(address), answers_.near_address(address, addresses_)));
    }
    known = paths_.emplace(std::string(address), *place).first;
  }
  const Place place = known->second;
  if (place.row == nullptr) {
    return Outcome::refused(fmt::format("this is a thing, not a value{}",
                                        hints_.take() ? name_hint("", store_.table(place.node).row_names()) : ""));
  }
  places_.assign(1, place);
  if (place.row->kind == RowKind::action) return act(message.args);
  if (!place.row->writable()) return Outcome::refused("this can be read, not set");
  return apply(true, message.args);
}

Outcome Dispatch::by_pattern(const Message& message) {
  Result<std::vector<Place>> places = match_places(store_, message.address, message_work_);
  if (!places) return message_work_.over() ? Outcome::refused(places.error()) : Outcome::unknown(places.error());
  std::erase_if(*places, [](const Place& p) { return p.row == nullptr || p.row->kind == RowKind::readout; });
  if (places->empty()) return Outcome::refused("this pattern matches nothing that can be set");
  places_ = std::move(*places);
  return places_.front().row->kind == RowKind::action ? act(message.args) : apply(false, message.args);
}

Outcome Dispatch::apply(bool single, std::span<const Arg> value) {
  // first everything is looked at, then everything is set: nothing of a refused message is applied
  Outcome outcome = collect_writes(single, value);
  return outcome.kind == Outcome::Kind::refused ? outcome : set_all();
}

Outcome Dispatch::set_all() {
  Outcome outcome;
  const std::uint64_t before = store_.kept_version();
  for (const Write& write : writes_) {
    const Result<SetOutcome> set =
        store_.set(write.place.node, *write.place.row, {write.values.values.data(), write.values.count});
    if (!set) return Outcome::refused(set.error());
    if (set->clamped) outcome.clamped = write.place.row;
  }
  // through a view (a motor's target) a property may have been set as well
  outcome.kept = store_.kept_version() != before;
  return outcome;
}

Outcome Dispatch::collect_writes(bool single, std::span<const Arg> value) {
  writes_.clear();
  const Row* coerced = nullptr;
  Result<RowValues> given = RowValues{};
  std::string left_out;
  for (const Place& place : places_) {
    const Row& row = *place.row;
    if (row.kind == RowKind::action) return Outcome::refused(fmt::format("{} is an action among values", row.name));
    if (&row != coerced) given = coerce(row, value);
    coerced = &row;
    if (!given) return Outcome::refused(given.error());
    Result<RowValues> values = spread(store_, place.node, row, *given);
    if (values && row.refuse != nullptr) {
      if (Result<void> may = row.refuse(store_.thing(place.node), values->values.data()); !may)
        values = Error{may.error()};
    }
    if (values) {
      writes_.push_back({place, *values});
    } else if (single || left_out.empty()) {
      left_out = fmt::format("{}: {}", thing_text(store_, place.node), values.error());
    }
  }
  // many things leave out those that can't; one that was meant by its name, or all of them, is an answer
  if (writes_.empty() && !left_out.empty()) return Outcome::refused(std::move(left_out));
  return {};
}

Outcome Dispatch::act(std::span<const Arg> value) {
  const bool any_may_be_pressed =
      std::all_of(places_.begin(), places_.end(), [](const Place& p) { return p.row->min_args == 0; });
  if (any_may_be_pressed && released(value)) return {};
  std::vector<double> numbers;
  for (const Arg& arg : value) {
    // an argument without a value (N, I) is a bang
    if (arg.kind == Arg::Kind::nil && any_may_be_pressed) continue;
    const std::optional<double> number = arg.is_text() ? parse_number(arg.text) : std::optional(arg.number);
    if (!number || arg.kind == Arg::Kind::nil || !std::isfinite(*number))
      return Outcome::refused(fmt::format("takes {}, each a number", takes_text(*places_.front().row)));
    numbers.push_back(*number);
  }
  for (const Place& place : places_) {
    if (place.row->act == nullptr) return Outcome::refused(fmt::format("{} is a value among actions", place.row->name));
    // a button without arguments is pressed by any one number
    if (place.row->max_args == 0 && numbers.size() == 1) numbers.clear();
    if (!takes_count(*place.row, numbers.size()))
      return Outcome::refused(fmt::format("takes {}, not {}", takes_text(*place.row), numbers.size()));
  }
  for (const Place& place : places_) {
    if (!store_.alive(place.node)) continue;  // an action before may have removed it
    const Result<void> done = place.row->act(store_.thing(place.node), numbers);
    if (!done) return Outcome::refused(done.error());
  }
  return {};
}

Outcome Dispatch::part_force(const Message& message) {
  // the seed's: a force of 3 numbers, and where it acts relative to the centre of mass, world axes
  static const Row& row = Part::table().at("apply_force");
  const Result<ValueSplit> split = split_value(row, message.args);
  if (!split) return Outcome::refused("takes 3 numbers, or 6 with a place");
  const std::span<const Arg> names = std::span(message.args).first(message.args.size() - split->count);
  if (names.size() > 2) return Outcome::refused("takes a body, a part and 3 or 6 numbers");
  double v[6] = {};
  for (std::size_t i = 0; i < split->count; i++) {
    const Arg& arg = message.args[names.size() + i];
    v[i] = arg.is_text() ? parse_number(arg.text).value_or(0) : arg.number;
    if (!std::isfinite(v[i])) return Outcome::refused(fmt::format("takes numbers; {} is none", v[i]));
  }
  places_.clear();
  if (const Result<void> selected = selector_.select(Part::table(), row, names, places_); !selected)
    return Outcome::refused(selected.error());
  if (Selector::single(names, 2) && static_cast<Part*>(store_.thing(places_.front().node))->is_static())
    return Outcome::refused(fmt::format("{} is static and never moves", thing_text(store_, places_.front().node)));
  for (const Place& place : places_) {
    Part& part = *static_cast<Part*>(store_.thing(place.node));
    part.apply_force_at({v[0], v[1], v[2]}, part.center() + Vec3(v[3], v[4], v[5]));
  }
  return {};
}

Outcome Dispatch::part_hold(const Message& message) {
  static const Row& row = Part::table().at("position");
  constexpr std::size_t kNames = 2;
  constexpr std::size_t kNumbers = 6;
  const std::span<const Arg> args = message.args;
  if (args.size() != kNames + kNumbers || !Selector::single(args.first(kNames), kNames))
    return Outcome::refused("takes a body, a part, a point x y z of it and where that is pulled to, x y z");
  double v[kNumbers] = {};
  for (std::size_t i = 0; i < kNumbers; i++) {
    const Arg& arg = args[kNames + i];
    v[i] = arg.number;
    if (!arg.is_numeric() || !std::isfinite(v[i])) return Outcome::refused("takes six numbers behind the names");
  }
  places_.clear();
  if (const Result<void> selected = selector_.select(Part::table(), row, args.first(kNames), places_); !selected)
    return Outcome::refused(selected.error());
  const NodeId id = places_.front().node;
  if (static_cast<Part*>(store_.thing(id))->is_static())
    return Outcome::refused(fmt::format("{} is static and never moves", thing_text(store_, id)));
  if (!grips_.hold(world_, id, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}))
    return Outcome::refused(fmt::format("{} parts are held already", Grips::kMost));
  return {};
}

Outcome Dispatch::part_release(const Message& message) {
  static const Row& row = Part::table().at("position");
  if (message.args.size() != 2) return Outcome::refused("takes a body and a part");
  places_.clear();
  if (const Result<void> selected = selector_.select(Part::table(), row, message.args, places_); !selected)
    return Outcome::refused(selected.error());
  for (const Place& place : places_) grips_.let_go(place.node);
  return {};
}

Outcome Dispatch::behavior_parameter(const Message& message) {
  // names end with the last text; where no value follows, that text is the value: a label, "true", a number
  const std::span<const Arg> args = message.args;
  std::size_t names = args.size();
  while (names > 0 && !args[names - 1].is_text()) names--;
  if (names == args.size() && names > 0) names--;
  if (names < 2 || names > 3)
    return Outcome::refused("takes a body or none, a behavior, the name of its parameter, and the parameter's value");
  for (const Arg& arg : args.first(names)) {
    if (arg.kind == Arg::Kind::nil) return Outcome::refused("nothing stands where a name is expected");
  }
  places_.clear();
  const std::span<const Arg> things = args.first(names - 1);
  if (const Result<void> selected = selector_.select_behaviors(things, args[names - 1], places_); !selected)
    return Outcome::refused(selected.error());
  return apply(Selector::single(things, 2), args.subspan(names));
}

Outcome Dispatch::projection(const Message& message) {
  constexpr const char* kRows[] = {"fovy", "aspect", "near", "far"};
  if (message.args.size() != std::size(kRows))
    return Outcome::refused("takes 4 numbers: fovy (degrees) aspect near far");
  std::vector<Write> writes;
  const NodeId camera = world_.visuals().camera().id();
  for (std::size_t i = 0; i < std::size(kRows); i++) {
    const Row& row = Camera::table().at(kRows[i]);
    const Result<RowValues> value = coerce(row, std::span(message.args).subspan(i, 1));
    if (!value) return Outcome::refused(fmt::format("{}: {}", row.name, value.error()));
    writes.push_back({{camera, &row}, *value});
  }
  if (writes[3].values.values[0] <= writes[2].values.values[0])
    return Outcome::refused("what is far must be further away than what is near");
  writes_ = std::move(writes);
  return set_all();
}

Outcome Dispatch::list(const Message& message) {
  std::array<char, 96> buffer;
  return answers_.list(plain_address(message.address, buffer).substr(std::string_view("/list/").size()), message.args);
}

Outcome Dispatch::scenes(const Message& message) {
  std::array<char, 96> buffer;
  if (plain_address(message.address, buffer).starts_with("/list/")) {
    if (!message.args.empty()) return Outcome::refused("takes no arguments");
  } else if (message.args.size() != 1 || message.args[0].kind == Arg::Kind::nil || message.args[0].is_numeric()) {
    return Outcome::refused("takes the name of a scene; /list/scenes answers with all");
  }
  Outcome outcome;
  outcome.kind = Outcome::Kind::scenes;
  outcome.error = "scenes are changed while a show plays (limber play, without --fast)";  // for who can't
  return outcome;
}

Outcome Dispatch::health(const Message& message) {
  if (!message.args.empty()) return Outcome::refused("takes no arguments");
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message& answer = outcome.answers.emplace_back(Message{"/list/health", {}});
  if (health_ != nullptr) answer = health_->answer("/list/health");
  if (answer.args.empty()) answer.args.push_back(Arg::of(""));  // no answer looks like a question
  return outcome;
}

Outcome Dispatch::get(const Message& message) { return answers_.get(message.args); }

Outcome Dispatch::preset(const Message& message) {
  if (presets_ == nullptr) return Outcome::refused("there are no presets here");
  std::array<char, 96> buffer;
  const std::string_view address = plain_address(message.address, buffer);
  return presets_->execute(address.substr(address.find_last_of('/') + 1), message, world_);
}

Outcome Dispatch::take(const Message& message) {
  std::array<char, 96> buffer;
  const std::span<const Arg> args = message.args;
  if (plain_address(message.address, buffer) != "/take/stop") {
    if (args.size() > 1 || (args.size() == 1 && !args[0].is_text()))
      return Outcome::refused("takes the name of the take, or nothing");
  } else if (released(args)) {
    return {};
  } else if (args.size() > 1 || (args.size() == 1 && args[0].is_text())) {
    return Outcome::refused("takes no arguments");
  }
  Outcome outcome;
  outcome.kind = Outcome::Kind::takes;
  return outcome;
}

Outcome Dispatch::gone(const Message&) {
  return Outcome::refused(
      "a joint's frames can't be changed while it lives; move the parts (position, rotation) or make the joint anew");
}

}  // namespace limber
