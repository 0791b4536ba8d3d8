// The reference, written from the tables.
#include "app/describe.h"

#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/paths.h"
#include "base/output.h"
#include "base/text.h"
#include "engine/engine.h"
#include "params/row_text.h"

namespace limber {

namespace {

void line(std::string& out, const std::string& path, const Table& table, const Row& row) {
  out += fmt::format("{}/{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", path, row.name, Dispatch::seed_address(table, row),
                     kind_name(row.kind), type_name(row.type), row.unit, values_text(row), initial_text(row), row.doc);
}

// one number, or one for each of the row's numbers; null where an axis has no bound
void add_bound(nlohmann::json& j, const char* key, double bound, const std::vector<double>& axes) {
  if (!axes.empty()) {
    j[key] = axes;  // JSON knows no infinity: it becomes null
  } else if (std::isfinite(bound)) {
    j[key] = bound;
  }
}

nlohmann::json as_json(const std::string& path, const Table& table, const Row& row) {
  nlohmann::json j{
      {"path", path + "/" + row.name}, {"kind", kind_name(row.kind)}, {"type", type_name(row.type)}, {"doc", row.doc}};
  if (const std::string seed = Dispatch::seed_address(table, row); !seed.empty()) j["seed"] = seed;
  if (!row.unit.empty()) j["unit"] = row.unit;
  if (!row.choices.empty()) j["choices"] = row.choices;
  if (row.kind != RowKind::action) {
    add_bound(j, "min", row.min, row.axis_min);
    add_bound(j, "max", row.max, row.axis_max);
  }
  if (row.step > 0) j["step"] = row.step;
  if (row.writable()) j["default"] = std::vector<double>(row.initial.begin(), row.initial.begin() + row.width);
  return j;
}

constexpr const char* kHead = "address\tseed's message\tkind\ttype\tunit\trange\tdefault\tmeaning\n";

}  // namespace

std::vector<const Table*> described_classes() {
  std::vector<const Table*> all = {&World::table(), &Body::table(),  &Part::table(),
                                   &Joint::table(), &Motor::table(), &Gear::table()};
  const BehaviorTypes types;
  for (const auto& type : types.all()) {
    all.push_back(type->table);
    if (type->group_table != nullptr) all.push_back(type->group_table);
  }
  all.insert(all.end(), {&Visuals::table(), &Camera::table(), &Look::table(), &Shape::table(), &Transport::table(),
                         &PresetNode::table(), &EditNode::table(), &TakeNode::table(), &CounterNode::table()});
  return all;
}

// the dispatch's, and those that the network answers by itself
std::vector<Irregular> described_messages() {
  const auto list = Dispatch::irregulars();
  std::vector<Irregular> all(list.begin(), list.end());
  all.push_back({"/ping", "", "Answers at once with /pong, the tick and the time."});
  all.push_back({"/token", "token", "Proves that the sender gets what is sent to its address; asked for by /token."});
  all.push_back({"/subscribe", "path|stream [rate]", "Tells the sender of changes, or streams to it, for 30 s."});
  all.push_back({"/unsubscribe", "[path|stream]", "Ends that, or all that the sender subscribed to."});
  return all;
}

namespace {

using AddRow = std::function<void(const std::string& path, const Table& table, const Row& row)>;

void each_class(const AddRow& add) {
  for (const Table* table : described_classes()) {
    for (const Row& row : table->rows()) add(table->path(), *table, row);
  }
}

// every thing that a scene has, with its rows
Result<void> each_thing(const std::string& scene, const AddRow& add) {
  std::vector<std::string> looked;
  EngineOptions options;
  options.scene = find_scene(scene, looked);
  options.scene_options.data_dir = data_dir();
  options.print = false;  // stdout is the answer's
  if (options.scene.empty()) return Error{no_scene(scene, looked)};
  EngineLink link;
  Engine engine(link, options);
  if (Result<void> started = engine.start(); !started) return started;
  const Store& store = engine.store();
  store.walk(store.root(), [&](NodeId id) {
    for (const Row& row : store.table(id).rows()) add(store.path(id), store.table(id), row);
  });
  return {};
}

std::string as_text(const std::function<void(const AddRow&)>& each) {
  std::string out = kHead;
  each([&](const std::string& path, const Table& table, const Row& row) { line(out, path, table, row); });
  for (const Irregular& m : described_messages())
    out += fmt::format("{}\t\tmessage\t{}\t\t\t\t{}\n", m.address, m.takes, m.doc);
  return out;
}

}  // namespace

std::string describe_classes() { return as_text(each_class); }

int describe_command(const std::string& scene, bool json) {
  Result<void> done;
  const auto each = [&](const AddRow& add) {
    if (scene.empty()) {
      each_class(add);
    } else {
      done = each_thing(scene, add);
    }
  };
  std::string out;
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    each([&](const std::string& path, const Table& table, const Row& row) {
      list.push_back(as_json(path, table, row));
    });
    for (const Irregular& m : described_messages())
      list.push_back({{"path", m.address}, {"kind", "message"}, {"takes", m.takes}, {"doc", m.doc}});
    out = list.dump(2) + "\n";
  } else {
    out = as_text(each);
  }
  if (!done) return fail(kInput, done.error());
  print_result("{}", out);
  return kFine;
}

}  // namespace limber
