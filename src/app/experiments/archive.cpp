// The record of a search as JSON, and the files of its elites.
#include "app/experiments/archive.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/experiments/experiment.h"
#include "app/experiments/parameter_presets.h"
#include "base/csv.h"
#include "base/text.h"
#include "engine/presets/file.h"
#include "experiments/cma_es.h"
#include "experiments/map_elites.h"
#include "export/atomic_file.h"

namespace limber::app {

namespace {

using experiments::Axis;
using experiments::Elite;
using experiments::ResultInfo;
using experiments::Search;
using RecordJson = nlohmann::ordered_json;

// prefixes of the names of elites, by Search::Algorithm
constexpr std::array<std::string_view, 7> kPrefixes{"best_", "cell_", "front_", "best_", "front_", "front_", "best_"};

// True if a search gives such names to elites.
bool is_elite_name(std::string_view name) {
  return std::ranges::any_of(kPrefixes, [&](std::string_view prefix) {
    return name.starts_with(prefix) && name.size() > prefix.size() &&
           name.find_first_not_of("0123456789_", prefix.size()) == std::string_view::npos;
  });
}

RecordJson axis_json(const Axis& axis) {
  return {{"name", axis.name},     {"min", axis.min},         {"max", axis.max},        {"values", axis.values},
          {"listed", axis.listed}, {"choices", axis.choices}, {"boolean", axis.boolean}};
}

Axis axis_of(const RecordJson& json) {
  Axis axis;
  axis.name = json.at("name");
  axis.min = json.at("min");
  axis.max = json.at("max");
  axis.values = json.at("values").get<std::vector<double>>();
  axis.listed = json.at("listed");
  axis.choices = json.at("choices").get<std::vector<std::string>>();
  axis.boolean = json.at("boolean");
  if (axis.listed && axis.values.empty()) axis.listed = false;
  return axis;
}

// the indices of the elites that become presets, in their order
std::vector<std::size_t> chosen_for_presets(const std::vector<Elite>& elites) {
  std::vector<std::size_t> chosen(elites.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (chosen.size() <= Archive::kMaxPresets) return chosen;
  std::ranges::stable_sort(
      chosen, [&](std::size_t a, std::size_t b) { return elites[a].objectives[0] > elites[b].objectives[0]; });
  chosen.resize(Archive::kMaxPresets);
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace

std::size_t best_of(const std::vector<Elite>& elites, std::size_t objective) {
  const auto best =
      std::ranges::max_element(elites, {}, [&](const Elite& elite) { return elite.objectives[objective]; });
  return static_cast<std::size_t>(best - elites.begin());
}

Result<void> write_archive_file(const std::string& path, std::string_view text) {
  exporter::AtomicFile file(path);
  Result<void> done = file.open();
  if (done) done = file.write(text);
  if (done) done = file.finish();
  return done;
}

Search::Options SearchRecord::options() const {
  return {algorithm, axes.size(), objectives.size(), descriptors, population, search_seed, nullptr};
}

std::string SearchRecord::text() const {
  RecordJson json = {{"scene", scene}, {"duration", duration}, {"seeds", seeds}};
  json["objectives"] = RecordJson::array();
  for (const Objective& objective : objectives)
    json["objectives"].push_back({{"name", objective.name}, {"maximize", objective.maximize}});
  json["parameters"] = RecordJson::array();
  for (const Axis& axis : axes) json["parameters"].push_back(axis_json(axis));
  json["descriptors"] = RecordJson::array();
  for (const ResultInfo& info : descriptors)
    json["descriptors"].push_back({{"name", info.name}, {"min", info.min}, {"max", info.max}, {"cells", info.cells}});
  json["algorithm"] = name_of(algorithm);
  json["population"] = population;
  json["search_seed"] = search_seed;
  return json.dump();
}

Result<SearchRecord> SearchRecord::parse(std::string_view text) try {
  const RecordJson json = RecordJson::parse(text);
  SearchRecord record;
  record.scene = json.at("scene");
  record.duration = json.at("duration");
  record.seeds = json.at("seeds").get<std::vector<std::uint64_t>>();
  for (const RecordJson& entry : json.at("objectives"))
    record.objectives.push_back({entry.at("name"), entry.at("maximize"), 0});
  for (const RecordJson& entry : json.at("parameters")) record.axes.push_back(axis_of(entry));
  for (const RecordJson& entry : json.at("descriptors"))
    record.descriptors.push_back({entry.at("name"), entry.at("min"), entry.at("max"), entry.at("cells")});
  const std::optional<Search::Algorithm> algorithm =
      experiments::algorithm_named(json.at("algorithm").get<std::string>());
  record.population = json.at("population");
  record.search_seed = json.at("search_seed");
  if (!algorithm || record.seeds.empty() || record.objectives.empty() || record.axes.empty() ||
      record.population > experiments::CmaEs::kMaxPopulation)
    return Error{"the file is damaged"};
  record.algorithm = *algorithm;
  return record;
} catch (const nlohmann::json::exception&) {
  return Error{"the file is damaged"};
}

std::string SearchRecord::difference(std::string_view a, std::string_view b) {
  const RecordJson saved = RecordJson::parse(a, nullptr, false);
  const RecordJson expected = RecordJson::parse(b, nullptr, false);
  for (const auto& [key, value] : expected.items()) {
    if (!saved.contains(key) || saved.at(key) != value) return key;
  }
  return {};
}

std::vector<double> SearchRecord::values(const std::vector<double>& individual) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::min(individual.size(), axes.size()); i++)
    values.push_back(axes[i].at(individual[i]));
  return values;
}

std::string SearchRecord::play_command(const Elite& elite) const {
  return command_that_plays(scene, axes, values(elite.individual), seeds.front());
}

std::vector<std::string> SearchRecord::names(const std::vector<Elite>& elites) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < elites.size(); i++) {
    std::string name(kPrefixes[static_cast<std::size_t>(algorithm)]);
    if (algorithm != Search::Algorithm::map_elites) {
      names.push_back(fmt::format("{}{}", name, i + 1));
      continue;
    }
    for (std::size_t k = 0; k < descriptors.size(); k++)
      name += fmt::format("{}{}", k == 0 ? "" : "_",
                          experiments::MapElites::cell_along(descriptors[k], elites[i].descriptors[k]) + 1);
    names.push_back(std::move(name));
  }
  return names;
}

Result<void> Archive::write_table(const SearchRecord& record, const std::vector<Elite>& elites) const {
  std::vector<std::string> columns = {"number", "preset", "generation", "individual"};
  for (const Objective& objective : record.objectives) columns.push_back(objective.name);
  for (const ResultInfo& info : record.descriptors) columns.push_back(info.name);
  for (const Axis& axis : record.axes) columns.push_back(axis.name);
  std::string text = fmt::format("{},hash,command\n", fmt::join(columns, ","));
  const std::vector<std::string> names = record.names(elites);
  for (std::size_t i = 0; i < elites.size(); i++) {
    const Elite& elite = elites[i];
    const std::vector<double> values = record.values(elite.individual);
    std::vector<std::string> cells = {std::to_string(i + 1), names[i], std::to_string(elite.generation),
                                      std::to_string(elite.index)};
    for (std::size_t k = 0; k < record.objectives.size(); k++)
      cells.push_back(number_text(record.objectives[k].sign() * elite.objectives[k]));
    for (const double descriptor : elite.descriptors) cells.push_back(number_text(descriptor));
    for (std::size_t k = 0; k < values.size(); k++) cells.push_back(csv_cell(record.axes[k].text(values[k])));
    cells.push_back(fmt::format("{:016x}", elite.hash));
    cells.push_back(csv_cell(record.play_command(elite)));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return write_archive_file(folder_ + "/elites.csv", text);
}

Result<void> Archive::write_presets(const SearchRecord& record, const std::vector<Elite>& elites,
                                    const std::string& locks) const {
  engine::PresetFile file(preset_file(), engine::PresetFile::write_access_for(preset_file(), locks, false));
  const Result<engine::ParsedPresets> before = file.load();  // a file that can't be read is backed up
  engine::PresetList list;
  const std::vector<std::string> names = record.names(elites);
  for (const std::size_t i : chosen_for_presets(elites))
    list.push_back(parameter_preset(record.axes, record.values(elites[i].individual), names[i],
                                    list.empty() ? nullptr : list.front()->schema));
  if (before) {
    std::ranges::copy_if(before->presets, std::back_inserter(list),
                         [](const auto& preset) { return !is_elite_name(preset->name); });
  }
  std::string notice;
  return file.save(list, notice);
}

}  // namespace limber::app
