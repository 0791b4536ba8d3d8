// Writes the reference from the property tables.
#include "app/commands/describe.h"

#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/commands.h"
#include "app/exit_code.h"
#include "app/paths.h"
#include "app/viewer/played_file.h"
#include "base/log/output.h"
#include "base/text.h"
#include "engine/cues/cue_node.h"
#include "engine/engine.h"
#include "properties/property_text.h"
#include "sim/clock/beat_clock.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear.h"
#include "sim/mocap/mocap_source.h"
#include "sim/routes/route.h"
#include "sim/sensors/sensor.h"
#include "sim/shapes/shape.h"
#include "sim/tendons/tendon.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::app {

namespace {

void add_line(std::string& out, const std::string& path, const PropertyTable& table, const Property& property) {
  out += fmt::format("{}/{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", path, property.name,
                     engine::MessageDispatcher::legacy_address(table, property), kind_name(property.kind),
                     type_name(property.type), property.unit, range_or_choices_text(property), initial_text(property),
                     property.doc);
}

// one number, or one per axis; null where an axis has no bound
void add_bound(nlohmann::json& j, const char* key, double bound, const std::vector<double>& axes) {
  if (!axes.empty()) {
    j[key] = axes;  // JSON has no infinity: it becomes null
  } else if (std::isfinite(bound)) {
    j[key] = bound;
  }
}

nlohmann::json as_json(const std::string& path, const PropertyTable& table, const Property& property) {
  nlohmann::json j{{"path", path + "/" + property.name},
                   {"kind", kind_name(property.kind)},
                   {"type", type_name(property.type)},
                   {"doc", property.doc}};
  if (const std::string legacy = engine::MessageDispatcher::legacy_address(table, property); !legacy.empty())
    j["seed"] = legacy;
  if (!property.unit.empty()) j["unit"] = property.unit;
  if (!property.choices.empty()) j["choices"] = property.choices;
  if (property.kind != PropertyKind::action) {
    add_bound(j, "min", property.min, property.axis_min);
    add_bound(j, "max", property.max, property.axis_max);
  }
  if (property.step > 0) j["step"] = property.step;
  if (property.writable())
    j["default"] = std::vector<double>(property.initial.begin(), property.initial.begin() + property.width);
  return j;
}

constexpr const char* kHeader = "address\tlegacy address\tkind\ttype\tunit\trange\tdefault\tmeaning\n";

}  // namespace

std::vector<const PropertyTable*> described_classes() {
  std::vector<const PropertyTable*> all = {
      &sim::World::table(),      &sim::Body::table(),  &sim::Part::table(),     &sim::Joint::table(),
      &sim::Motor::table(),      &sim::Gear::table(),  &sim::imu_table(),       &sim::range_finder_table(),
      &sim::zone_table(),        &sim::touch_table(),  &sim::Tendon::table(),   &sim::MocapSource::table(),
      &sim::MocapJoint::table(), &sim::Route::table(), &sim::BeatClock::table()};
  const sim::BehaviorTypes types;
  for (const auto& type : types.all()) {
    all.push_back(type->table);
    if (type->group_table != nullptr) all.push_back(type->group_table);
  }
  all.insert(all.end(), {&sim::Visuals::table(), &sim::Camera::table(), &sim::Appearance::table(), &sim::Shape::table(),
                         &sim::FixtureList::table(), &sim::Fixture::table(), &engine::Transport::table(),
                         &engine::PresetNode::table(), &engine::CueNode::table(), &engine::EditNode::table(),
                         &engine::TakeNode::table(), &engine::CounterNode::table(), &engine::MidiNode::table()});
  return all;
}

// those of the dispatcher, and those that the network answers itself
std::vector<engine::SpecialAddress> described_messages() {
  const auto list = engine::MessageDispatcher::special_addresses();
  std::vector<engine::SpecialAddress> all(list.begin(), list.end());
  all.push_back({"/ping", "", "Replies immediately with /pong, the tick and the time."});
  all.push_back({"/token", "token", "Confirms that the sender receives messages at its address; requested by /token."});
  all.push_back({"/subscribe", "path|stream [rate]", "Sends changes or a stream to the sender for 30 s."});
  all.push_back({"/unsubscribe", "[path|stream]", "Ends this subscription, or all subscriptions of the sender."});
  return all;
}

namespace {

using AddProperty = std::function<void(const std::string& path, const PropertyTable& table, const Property& property)>;

void each_class(const AddProperty& add) {
  for (const PropertyTable* table : described_classes()) {
    for (const Property& property : table->properties()) add(table->path(), *table, property);
  }
}

// calls `add` for each property of all objects of a scene
Result<void> each_object(const std::string& scene, const AddProperty& add) {
  const Result<PlayedFile> played = find_played(scene);
  if (!played) return Error{played.error()};
  engine::EngineOptions options;
  options.scene = played->scene;
  options.scene_options.data_dir = data_dir();
  options.print = false;  // stdout is reserved for the result
  engine::EngineLink link;
  engine::Engine engine(link, options);
  if (Result<void> started = engine.start(); !started) return started;
  const Store& store = engine.store();
  store.walk(store.root(), [&](NodeId id) {
    for (const Property& property : store.table(id).properties()) add(store.path(id), store.table(id), property);
  });
  return {};
}

std::string as_text(const std::function<void(const AddProperty&)>& each) {
  std::string out = kHeader;
  each([&](const std::string& path, const PropertyTable& table, const Property& property) {
    add_line(out, path, table, property);
  });
  for (const engine::SpecialAddress& m : described_messages())
    out += fmt::format("{}\t\tmessage\t{}\t\t\t\t{}\n", m.address, m.args, m.doc);
  return out;
}

}  // namespace

std::string describe_classes() { return as_text(each_class); }

int describe_command(const std::string& scene, bool json) {
  Result<void> result;
  const auto each_property = [&](const AddProperty& add) {
    if (scene.empty()) {
      each_class(add);
    } else {
      result = each_object(scene, add);
    }
  };
  std::string out;
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    each_property([&](const std::string& path, const PropertyTable& table, const Property& property) {
      list.push_back(as_json(path, table, property));
    });
    for (const engine::SpecialAddress& m : described_messages())
      list.push_back({{"path", m.address}, {"kind", "message"}, {"takes", m.args}, {"doc", m.doc}});
    out = list.dump(2) + "\n";
  } else {
    out = as_text(each_property);
  }
  if (!result) return fail(kInputError, result.error());
  print_result("{}", out);
  return kSuccess;
}

}  // namespace limber::app
