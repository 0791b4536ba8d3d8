// The reference, written from the tables.
#include "app/describe.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/paths.h"
#include "base/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {

std::string range_text(const Row& row) {
  if (row.kind == RowKind::action) return "";
  if (!row.choices.empty()) return fmt::format("{}", fmt::join(row.choices, "|"));
  if (row.type == RowType::boolean || row.type == RowType::flags3) return "true|false";
  if (!std::isfinite(row.min) && !std::isfinite(row.max)) return "any";
  return fmt::format("{} .. {}", row.min, row.max);
}

std::string initial_text(const Row& row) {
  if (!row.writable()) return "";
  if (!row.choices.empty()) return row.choices[static_cast<std::size_t>(row.initial[0])];
  return fmt::format("{:g}", fmt::join(row.initial.begin(), row.initial.begin() + row.width, " "));
}

std::string seed_text(const Table& table, const Row& row) {
  return table.seed().empty() || row.kind == RowKind::readout ? "" : plain_name(table.seed() + "/" + row.name);
}

void line(std::string& out, const std::string& path, const Table& table, const Row& row) {
  out += fmt::format("{}/{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", path, row.name, seed_text(table, row), kind_name(row.kind),
                     type_name(row.type), row.unit, range_text(row), initial_text(row), row.doc);
}

nlohmann::json as_json(const std::string& path, const Table& table, const Row& row) {
  nlohmann::json j{
      {"path", path + "/" + row.name}, {"kind", kind_name(row.kind)}, {"type", type_name(row.type)}, {"doc", row.doc}};
  if (const std::string seed = seed_text(table, row); !seed.empty()) j["seed"] = seed;
  if (!row.unit.empty()) j["unit"] = row.unit;
  if (!row.choices.empty()) j["choices"] = row.choices;
  if (std::isfinite(row.min) && row.kind != RowKind::action) j["min"] = row.min;
  if (std::isfinite(row.max) && row.kind != RowKind::action) j["max"] = row.max;
  if (row.writable()) j["default"] = std::vector<double>(row.initial.begin(), row.initial.begin() + row.width);
  return j;
}

constexpr const char* kHead = "address\tseed's message\tkind\ttype\tunit\trange\tdefault\tmeaning\n";

std::vector<const Table*> classes() {
  return {&World::table(), &Body::table(),      &Part::table(),       &Joint::table(),
          &Motor::table(), &Transport::table(), &CounterNode::table()};
}

}  // namespace

std::string describe_classes() {
  std::string out = kHead;
  for (const Table* table : classes()) {
    for (const Row& row : table->rows()) line(out, table->path(), *table, row);
  }
  return out;
}

int describe_command(const std::string& scene, bool json) {
  nlohmann::json list = nlohmann::json::array();
  std::string out = kHead;
  const auto add = [&](const std::string& path, const Table& table, const Row& row) {
    if (json) {
      list.push_back(as_json(path, table, row));
    } else {
      line(out, path, table, row);
    }
  };
  if (scene.empty()) {
    for (const Table* table : classes()) {
      for (const Row& row : table->rows()) add(table->path(), *table, row);
    }
  } else {
    std::vector<std::string> looked;
    EngineOptions options;
    options.scene = find_scene(scene, looked);
    options.scene_options.data_dir = data_dir();
    if (options.scene.empty()) {
      fmt::print(stderr, "limber: there is no scene '{}'; looked for {}\n", printable(scene),
                 fmt::join(looked, " and "));
      return 1;
    }
    EngineLink link;
    Engine engine(link, options);
    if (const Result<void> started = engine.start(); !started) {
      fmt::print(stderr, "limber: {}\n", printable(started.error()));
      return 1;
    }
    const Store& store = engine.store();
    store.walk(store.root(), [&](NodeId id) {
      for (const Row& row : store.table(id).rows()) add(store.path(id), store.table(id), row);
    });
  }
  fmt::print("{}\n", json ? list.dump(2) : out.substr(0, out.size() - 1));
  return 0;
}

}  // namespace limber
