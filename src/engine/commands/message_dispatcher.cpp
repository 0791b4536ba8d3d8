// MessageDispatcher: resolves addresses to properties, validates values and sets them.
#include "engine/commands/message_dispatcher.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/commands/route_commands.h"
#include "engine/commands/service_requests.h"
#include "sim/mocap/mocap_list.h"
#include "sim/shapes/shape.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxPaths = 16384;  // size of the cache of exact paths

// the classes with legacy addresses
std::array<const PropertyTable*, 6> legacy_classes() {
  return {&sim::World::table(), &sim::Part::table(),   &sim::Joint::table(),
          &sim::Motor::table(), &sim::Camera::table(), &sim::Shape::table()};
}

// The error for an unknown path that begins with one of these names the objects that exist.
constexpr std::string_view kObjectPaths[] = {"/physics/body/", "/physics/group/", "/physics/mocap/", "/physics/route/",
                                             "/lighting/fixture/"};

// legacy addresses that changed the frames of a joint; no longer supported
constexpr const char* kUnsupported[] = {"/physics/joint/basis", "/physics/joint/prevpos", "/physics/joint/nextpos"};

// A request that another part executes; where there is none, it is rejected with this error.
Outcome request_of(Outcome::Kind kind, const char* error) {
  Outcome outcome = Outcome::rejected(error);
  outcome.kind = kind;
  return outcome;
}

// Returns the address in lower case, without underscores and a trailing slash, in `buffer`; empty if it does not fit,
// because it is longer than any known address.
std::string_view normalized_address(std::string_view address, std::array<char, 96>& buffer) {
  if (address.size() > 1 && address.back() == '/') address.remove_suffix(1);
  std::size_t n = 0;
  for (const char c : address) {
    if (c == '_') continue;
    if (n == buffer.size()) return {};
    buffer[n++] = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return {buffer.data(), n};
}

// Returns the name of an object for messages, such as "part 'arm/base'".
std::string object_text(const Store& store, NodeId id) {
  const std::string& kind = store.table(id).name();
  const NodeId owner = store.parent(store.parent(id));  // body / group "part" / part
  if (!owner.null() && &store.table(owner) == &sim::Body::table())
    return fmt::format("{} '{}/{}'", kind, store.name(owner), store.name(id));
  return &store.table(id) == &sim::Body::table() || kind == "group" ? fmt::format("{} '{}'", kind, store.name(id))
                                                                    : store.path(id);
}

// Why a part can't be pushed or pulled.
std::string immovable_text(const Store& store, NodeId part) {
  const bool kinematic = static_cast<const sim::Part*>(store.object(part))->motion() == sim::PartMotion::kinematic;
  return fmt::format("{} is {}", object_text(store, part),
                     kinematic ? "kinematic: no force moves it; set its position" : "static and never moves");
}

// True for the single argument 0, which a button sends when it is released and which triggers nothing.
bool is_button_release(std::span<const Arg> value) {
  if (value.size() != 1 || value[0].kind == Arg::Kind::nil) return false;
  return value[0].is_text() ? parse_number(value[0].text) == 0.0 : value[0].number == 0;
}

// Returns the arguments of an action; nothing if one is not a finite number. `is_trigger`: an argument without a value
// (OSC types N, I) is a trigger without arguments.
std::optional<std::vector<double>> action_numbers(std::span<const Arg> args, bool is_trigger) {
  std::vector<double> numbers;
  for (const Arg& arg : args) {
    if (arg.kind == Arg::Kind::nil && is_trigger) continue;
    const std::optional<double> number = arg.is_text() ? parse_number(arg.text) : std::optional(arg.number);
    if (!number || arg.kind == Arg::Kind::nil || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

std::string MessageDispatcher::legacy_address(const PropertyTable& table, const Property& property) {
  if (table.legacy_prefix().empty() || property.kind == PropertyKind::readout) return {};
  return normalized_name(table.legacy_prefix() + "/" + property.name);
}

std::span<const SpecialAddress> MessageDispatcher::special_addresses() { return kSpecialAddresses; }

MessageDispatcher::MessageDispatcher(sim::World& world, Presets* presets,
                                     std::span<const PropertyTable* const> extra_classes)
    : world_(world), presets_(presets), store_(world.store()) {
  for (const PropertyTable* table : legacy_classes()) add_class(*table);
  for (const PropertyTable* table : extra_classes) add_class(*table);
  for (const SpecialAddress& special : kSpecialAddresses) {
    const auto is_of = [&](std::string_view group) { return special.address.starts_with(group); };
    entries_[std::string(special.address)].handler = is_of("/preset/")  ? &MessageDispatcher::execute_preset
                                                     : is_of("/take/")  ? &MessageDispatcher::request_take
                                                     : is_of("/route/") ? &MessageDispatcher::execute_route
                                                     : is_of("/midi/")  ? &MessageDispatcher::request_service
                                                     : is_of("/osc/")   ? &MessageDispatcher::request_service
                                                     : is_of("/cue/")   ? &MessageDispatcher::request_cue_edit
                                                                        : &MessageDispatcher::answer_list;
  }
  entries_["/list/presets"].handler = &MessageDispatcher::execute_preset;
  entries_["/physics/part/force"].handler = &MessageDispatcher::part_force;
  entries_["/physics/part/hold"].handler = &MessageDispatcher::part_hold;
  entries_["/physics/part/release"].handler = &MessageDispatcher::part_release;
  entries_["/physics/behavior/parameter"].handler = &MessageDispatcher::behavior_parameter;
  entries_["/visuals/camera/projection"].handler = &MessageDispatcher::projection;
  entries_["/get"].handler = &MessageDispatcher::answer_get;
  entries_["/list/health"].handler = &MessageDispatcher::answer_health;
  entries_["/list/cues"].handler = &MessageDispatcher::answer_cues;
  entries_["/cue/jump"].handler = &MessageDispatcher::request_cue;
  entries_["/list/targets"].handler = &MessageDispatcher::request_service;
  entries_["/list/scenes"].handler = &MessageDispatcher::request_scene;
  entries_["/transport/scene"].handler = &MessageDispatcher::request_scene;
  for (const auto& [address, entry] : entries_) addresses_.push_back(address);
  for (const char* address : kUnsupported) entries_[address].handler = &MessageDispatcher::reject_unsupported;
  std::sort(addresses_.begin(), addresses_.end());
}

void MessageDispatcher::add_class(const PropertyTable& table) {
  for (const Property& property : table.properties()) {
    if (std::string address = legacy_address(table, property); !address.empty())
      entries_[address] = {&table, &property, nullptr};
  }
}

Outcome MessageDispatcher::execute(const Message& message) {
  const int budget = std::min(PatternBudget::kStepsPerMessage, std::max(pass_budget_.remaining, 0));
  message_budget_.remaining = budget;
  Outcome outcome = execute_one(message);
  pass_budget_.remaining -= budget - message_budget_.remaining;
  return outcome;
}

Outcome MessageDispatcher::execute_one(const Message& message) {
  writes_.clear();
  if (const std::optional<Result<void>> frame = world_.sensing().mocap().accept(message))
    return *frame ? Outcome{} : Outcome::rejected(frame->error());
  std::array<char, 96> buffer;
  const auto found = entries_.find(normalized_address(message.address, buffer));
  if (found == entries_.end()) return execute_path(message);
  const AddressEntry& entry = found->second;
  return entry.handler != nullptr ? (this->*entry.handler)(message) : execute_named(entry, message);
}

NodeId MessageDispatcher::singleton(const PropertyTable& table) const {
  if (&table == &sim::World::table()) return world_.id();
  return &table == &sim::Camera::table() ? world_.visuals().camera().id() : NodeId{};
}

Outcome MessageDispatcher::execute_named(const AddressEntry& entry, const Message& message) {
  const std::span<const Arg> args = message.args;
  const Property& property = *entry.property;
  refs_.clear();
  const bool is_action = property.kind == PropertyKind::action;
  if (const NodeId singleton_id = singleton(*entry.table); !singleton_id.null()) {
    refs_.push_back({singleton_id, &property});
    return is_action ? execute_action(args) : apply(true, args);
  }
  const bool shapes = entry.table == &sim::Shape::table();
  const Result<ValueSplit> split = split_value(property, args);
  if (!split) return Outcome::rejected(split.error());
  const std::span<const Arg> names = args.first(args.size() - split->count);
  if (names.size() > (shapes ? 1 : 2)) {
    return Outcome::rejected(fmt::format("takes a {}{} and {}, got {} names", shapes ? "" : "body, a ",
                                         entry.table->name(), expected_text(property), names.size()));
  }
  for (const Arg& name : names) {
    if (name.kind == Arg::Kind::nil) return Outcome::rejected("a name is missing: the argument is nil");
  }
  const Result<void> selected =
      shapes ? selector_.select_shapes(property, names, refs_) : selector_.select(*entry.table, property, names, refs_);
  if (!selected) {
    return Outcome::rejected(split->ambiguous ? fmt::format("takes {}, not {}", expected_text(property), args.size())
                                              : selected.error());
  }
  const std::span<const Arg> value = args.last(split->count);
  return is_action ? execute_action(value) : apply(Selector::is_single(names, shapes ? 1 : 2), value);
}

Outcome MessageDispatcher::execute_path(const Message& message) {
  const std::string_view address = message.address;
  if (is_pattern(address) || address.find("//") != std::string_view::npos) return execute_pattern(message);
  if (paths_version_ != store_.structure_version() || paths_.size() > kMaxPaths) {
    paths_.clear();
    paths_version_ = store_.structure_version();
  }
  auto known = paths_.find(address);
  if (known == paths_.end()) {
    const Result<PropertyRef> ref = find_property(store_, address, false);
    if (!ref) return unknown_path(address, ref.error());
    known = paths_.emplace(std::string(address), *ref).first;
  }
  const PropertyRef ref = known->second;
  if (ref.property == nullptr) {
    std::string error = fmt::format("this is an object, not a property{}",
                                    hints_.consume() ? name_hint("", store_.table(ref.node).property_names()) : "");
    // scenes have handlers of the address /cue that are older than this object
    const bool may_be_handled = address == "/cue";
    return may_be_handled ? Outcome::unknown(std::move(error)) : Outcome::rejected(std::move(error));
  }
  refs_.assign(1, ref);
  if (ref.property->kind == PropertyKind::action) return execute_action(message.args);
  if (!ref.property->writable()) return Outcome::rejected("this property is read-only");
  return apply(true, message.args);
}

// `error`: without hints.
Outcome MessageDispatcher::unknown_path(std::string_view address, const std::string& error) {
  const bool shape = address.starts_with("/visuals/shape/") && std::ranges::count(address, '/') > 3;
  const bool is_own_path = shape || !address.starts_with("/") ||
                           std::ranges::any_of(kObjectPaths, [&](auto path) { return address.starts_with(path); });
  if (is_own_path) return Outcome::unknown(hints_.consume() ? find_property(store_, address).error() : error);
  return Outcome::unknown(
      fmt::format("there is no address {}{}", printable(address), query_handler_.address_hint(address, addresses_)));
}

Outcome MessageDispatcher::execute_pattern(const Message& message) {
  Result<std::vector<PropertyRef>> refs = match_properties(store_, message.address, message_budget_);
  if (!refs) return message_budget_.exceeded() ? Outcome::rejected(refs.error()) : Outcome::unknown(refs.error());
  std::erase_if(
      *refs, [](const PropertyRef& p) { return p.property == nullptr || p.property->kind == PropertyKind::readout; });
  if (refs->empty()) return Outcome::rejected("this pattern matches nothing that can be set");
  refs_ = std::move(*refs);
  return refs_.front().property->kind == PropertyKind::action ? execute_action(message.args)
                                                              : apply(false, message.args);
}

Outcome MessageDispatcher::apply(bool single, std::span<const Arg> value) {
  // validate all values before the first is set, so that a rejected message has no effect
  Outcome outcome = collect_writes(single, value);
  return outcome.kind == Outcome::Kind::rejected ? outcome : write_all();
}

Outcome MessageDispatcher::write_all() {
  Outcome outcome;
  const std::uint64_t before = store_.persistent_version();
  for (const Write& write : writes_) {
    const Result<SetOutcome> set =
        store_.set(write.ref.node, *write.ref.property, {write.values.values.data(), write.values.count});
    if (!set) return Outcome::rejected(set.error());
    if (set->clamped) outcome.clamped = write.ref.property;
  }
  // setting a computed property (such as a motor's target) may have set a persistent property too
  outcome.sets_override = store_.persistent_version() != before;
  return outcome;
}

Outcome MessageDispatcher::collect_writes(bool single, std::span<const Arg> value) {
  writes_.clear();
  const Property* coerced = nullptr;
  Result<PropertyValues> given = PropertyValues{};
  std::string rejected;
  for (const PropertyRef& ref : refs_) {
    const Property& property = *ref.property;
    if (property.kind == PropertyKind::action)
      return Outcome::rejected(fmt::format("this matches both values and the action {}", property.name));
    if (&property != coerced) given = coerce(property, value);
    coerced = &property;
    if (!given) return Outcome::rejected(given.error());
    Result<PropertyValues> values = expand(store_, ref.node, property, *given);
    if (values && property.validate != nullptr) {
      if (Result<void> valid = property.validate(store_.object(ref.node), values->values.data()); !valid)
        values = Error{valid.error()};
    }
    if (values) {
      writes_.push_back({ref, *values});
    } else if (single || rejected.empty()) {
      rejected = fmt::format("{}: {}", object_text(store_, ref.node), values.error());
    }
  }
  // skipped objects are no error unless all were skipped
  if (writes_.empty() && !rejected.empty()) return Outcome::rejected(std::move(rejected));
  return {};
}

Outcome MessageDispatcher::execute_action(std::span<const Arg> value) {
  const bool all_triggers =
      std::all_of(refs_.begin(), refs_.end(), [](const PropertyRef& p) { return p.property->min_args == 0; });
  if (all_triggers && is_button_release(value)) return {};
  std::optional<std::vector<double>> given = action_numbers(value, all_triggers);
  if (!given) return Outcome::rejected(fmt::format("takes {}, each a number", expected_text(*refs_.front().property)));
  std::vector<double>& numbers = *given;
  for (const PropertyRef& ref : refs_) {
    if (ref.property->invoke == nullptr)
      return Outcome::rejected(fmt::format("this matches both actions and the value {}", ref.property->name));
    // a trigger without arguments accepts any one number, as buttons send it
    if (ref.property->max_args == 0 && numbers.size() == 1) numbers.clear();
    if (!action_accepts_count(*ref.property, numbers.size()))
      return Outcome::rejected(fmt::format("takes {}, not {}", expected_text(*ref.property), numbers.size()));
  }
  for (const PropertyRef& ref : refs_) {
    if (!store_.alive(ref.node)) continue;  // a previous action may have removed it
    const Result<void> result = ref.property->invoke(store_.object(ref.node), numbers);
    if (!result) return Outcome::rejected(result.error());
  }
  return {};
}

Outcome MessageDispatcher::part_force(const Message& message) {
  // as in ofxDabPhysics: a force, and optionally its point of application relative to the center of mass, world axes
  static const Property& property = sim::Part::table().at("apply_force");
  const Result<ValueSplit> split = split_value(property, message.args);
  if (!split) return Outcome::rejected("takes 3 numbers, or 6 with a point of application");
  const std::span<const Arg> names = std::span(message.args).first(message.args.size() - split->count);
  if (names.size() > 2) return Outcome::rejected("takes a body, a part and 3 or 6 numbers");
  double numbers[6] = {};
  for (std::size_t i = 0; i < split->count; i++) {
    const Arg& arg = message.args[names.size() + i];
    numbers[i] = arg.is_text() ? parse_number(arg.text).value_or(0) : arg.number;
    if (!std::isfinite(numbers[i]))
      return Outcome::rejected(fmt::format("takes numbers; {} is not finite", numbers[i]));
  }
  refs_.clear();
  if (const Result<void> selected = selector_.select(sim::Part::table(), property, names, refs_); !selected)
    return Outcome::rejected(selected.error());
  if (Selector::is_single(names, 2) && static_cast<sim::Part*>(store_.object(refs_.front().node))->is_static())
    return Outcome::rejected(immovable_text(store_, refs_.front().node));
  for (const PropertyRef& ref : refs_) {
    sim::Part& part = *static_cast<sim::Part*>(store_.object(ref.node));
    part.apply_force_at({numbers[0], numbers[1], numbers[2]}, part.center() + Vec3(numbers[3], numbers[4], numbers[5]));
  }
  return {};
}

Outcome MessageDispatcher::part_hold(const Message& message) {
  static const Property& property = sim::Part::table().at("position");
  constexpr std::size_t kNames = 2;
  constexpr std::size_t kNumbers = 6;
  const std::span<const Arg> args = message.args;
  if (args.size() != kNames + kNumbers || !Selector::is_single(args.first(kNames), kNames))
    return Outcome::rejected("takes a body, a part, a point x y z of the part and a target x y z");
  double numbers[kNumbers] = {};
  for (std::size_t i = 0; i < kNumbers; i++) {
    const Arg& arg = args[kNames + i];
    numbers[i] = arg.number;
    if (!arg.is_numeric() || !std::isfinite(numbers[i])) return Outcome::rejected("takes six numbers after the names");
  }
  refs_.clear();
  if (const Result<void> selected = selector_.select(sim::Part::table(), property, args.first(kNames), refs_);
      !selected)
    return Outcome::rejected(selected.error());
  const NodeId id = refs_.front().node;
  if (static_cast<sim::Part*>(store_.object(id))->motion() == sim::PartMotion::fixed)
    return Outcome::rejected(immovable_text(store_, id));
  if (!mouse_springs_.attach(world_, id, {numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}))
    return Outcome::rejected(fmt::format("the maximum of {} springs is reached", MouseSprings::kMaxSprings));
  return {};
}

Outcome MessageDispatcher::part_release(const Message& message) {
  static const Property& property = sim::Part::table().at("position");
  if (message.args.size() != 2) return Outcome::rejected("takes a body and a part");
  refs_.clear();
  if (const Result<void> selected = selector_.select(sim::Part::table(), property, message.args, refs_); !selected)
    return Outcome::rejected(selected.error());
  for (const PropertyRef& ref : refs_) mouse_springs_.release(ref.node);
  return {};
}

Outcome MessageDispatcher::behavior_parameter(const Message& message) {
  // the names end with the last text argument, or with the one before if that text is the value (a label, "true", "1")
  const std::span<const Arg> args = message.args;
  std::size_t names = args.size();
  while (names > 0 && !args[names - 1].is_text()) names--;
  if (names == args.size() && names > 0) names--;
  if (names < 2 || names > 3)
    return Outcome::rejected("takes a body or none, a behavior, the name of its parameter, and the parameter's value");
  for (const Arg& arg : args.first(names)) {
    if (arg.kind == Arg::Kind::nil) return Outcome::rejected("a name is missing: the argument is nil");
  }
  refs_.clear();
  const std::span<const Arg> object_names = args.first(names - 1);
  if (const Result<void> selected = selector_.select_behaviors(object_names, args[names - 1], refs_); !selected)
    return Outcome::rejected(selected.error());
  return apply(Selector::is_single(object_names, 2), args.subspan(names));
}

Outcome MessageDispatcher::projection(const Message& message) {
  constexpr const char* kProperties[] = {"fovy", "aspect", "near", "far"};
  if (message.args.size() != std::size(kProperties))
    return Outcome::rejected("takes 4 numbers: fovy (degrees) aspect near far");
  std::vector<Write> writes;
  const NodeId camera = world_.visuals().camera().id();
  for (std::size_t i = 0; i < std::size(kProperties); i++) {
    const Property& property = sim::Camera::table().at(kProperties[i]);
    const Result<PropertyValues> value = coerce(property, std::span(message.args).subspan(i, 1));
    if (!value) return Outcome::rejected(fmt::format("{}: {}", property.name, value.error()));
    writes.push_back({{camera, &property}, *value});
  }
  if (writes[3].values.values[0] <= writes[2].values.values[0])
    return Outcome::rejected("far must be greater than near");
  writes_ = std::move(writes);
  return write_all();
}

Outcome MessageDispatcher::answer_list(const Message& message) {
  std::array<char, 96> buffer;
  return query_handler_.list(normalized_address(message.address, buffer).substr(std::string_view("/list/").size()),
                             message.args);
}

Outcome MessageDispatcher::request_scene(const Message& message) {
  std::array<char, 96> buffer;
  if (normalized_address(message.address, buffer).starts_with("/list/")) {
    if (!message.args.empty()) return Outcome::rejected("takes no arguments");
  } else if (message.args.size() != 1 || message.args[0].kind == Arg::Kind::nil || message.args[0].is_numeric()) {
    return Outcome::rejected("takes the name of a scene; /list/scenes lists them");
  }
  return request_of(Outcome::Kind::scene_request,
                    "scenes can be changed in a live show only (limber play, without --fast)");
}

Outcome MessageDispatcher::request_cue_edit(const Message&) {
  return request_of(Outcome::Kind::scene_request,
                    "cues can be edited in a live show only (limber play, without --fast)");
}

Outcome MessageDispatcher::answer_health(const Message& message) {
  if (!message.args.empty()) return Outcome::rejected("takes no arguments");
  Outcome outcome = Outcome::answered();
  Message& answer = outcome.answers.emplace_back(Message{"/list/health", {}});
  if (health_ != nullptr) answer = health_->answer_message("/list/health");
  if (answer.args.empty()) answer.args.push_back(Arg::of(""));  // an answer must not look like a query
  return outcome;
}

Outcome MessageDispatcher::answer_cues(const Message& message) {
  if (!message.args.empty()) return Outcome::rejected("takes no arguments");
  Outcome outcome = Outcome::answered();
  Message& answer = outcome.answers.emplace_back(Message{"/list/cues", {}});
  if (cues_ != nullptr) {
    for (const Cue& cue : *cues_->list()) answer.args.push_back(Arg::of(std::string_view(cue.name)));
  }
  if (answer.args.empty()) answer.args.push_back(Arg::of(""));  // an answer must not look like a query
  return outcome;
}

Outcome MessageDispatcher::request_cue(const Message& message) {
  if (message.args.size() != 1 || message.args[0].kind == Arg::Kind::nil)
    return Outcome::rejected("takes the name or the number of a cue; /list/cues lists them");
  if (is_button_release(message.args)) return {};
  return request_of(Outcome::Kind::cue_request, "cues can be started in a running show only");
}

Outcome MessageDispatcher::answer_get(const Message& message) { return query_handler_.get(message.args); }

Outcome MessageDispatcher::execute_preset(const Message& message) {
  if (presets_ == nullptr) return Outcome::rejected("presets are not available here");
  std::array<char, 96> buffer;
  const std::string_view address = normalized_address(message.address, buffer);
  return presets_->execute(address.substr(address.find_last_of('/') + 1), message, world_);
}

Outcome MessageDispatcher::execute_route(const Message& message) {
  std::array<char, 96> buffer;
  return edit_routes(world_, normalized_address(message.address, buffer), message.args);
}

Outcome MessageDispatcher::request_service(const Message& message) { return check_service_request(message); }

Outcome MessageDispatcher::request_take(const Message& message) {
  std::array<char, 96> buffer;
  const std::span<const Arg> args = message.args;
  if (normalized_address(message.address, buffer) != "/take/stop") {
    if (args.size() > 1 || (args.size() == 1 && !args[0].is_text()))
      return Outcome::rejected("takes the name of the take, or nothing");
  } else if (is_button_release(args)) {
    return {};
  } else if (args.size() > 1 || (args.size() == 1 && args[0].is_text())) {
    return Outcome::rejected("takes no arguments");
  }
  return request_of(Outcome::Kind::take_request, "takes need a show that plays. Record with --record FILE");
}

Outcome MessageDispatcher::reject_unsupported(const Message&) {
  return Outcome::rejected(
      "the frames of a joint can't be changed; move its parts (position, rotation) or create the joint again");
}

}  // namespace limber::engine
