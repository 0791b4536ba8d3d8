// `limber evolve`: generations of evaluations, and the folder with the search's state and its elites.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/experiments/experiment.h"
#include "app/paths.h"
#include "app/progress.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/file.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "experiments/result_table.h"
#include "experiments/search.h"
#include "export/atomic_file.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;
using experiments::Evaluation;
using experiments::Outcome;
using experiments::ResultInfo;
using experiments::Search;
using StateJson = nlohmann::ordered_json;

constexpr double kElitesInterval = 10;  // real seconds between two updates of elites.csv
constexpr std::uintmax_t kMaxStateBytes = std::uintmax_t{1} << 30;

Result<void> write_file(const std::string& path, std::string_view text) {
  exporter::AtomicFile file(path);
  Result<void> done = file.open();
  if (done) done = file.write(text);
  if (done) done = file.finish();
  return done;
}

class Evolution {
 public:
  Evolution(const EvolveCommand& command, Experiment& experiment) : command_(command), experiment_(experiment) {}

  /// Finds the objective and the descriptors among the results of the scene.
  Result<void> choose_results();
  int run();

 private:
  Result<std::size_t> result_index(const std::string& name, const char* option) const;
  std::vector<double> values_of(const Search::Vector& individual) const;
  StateJson identity() const;
  Result<void> open_folder();
  Result<void> resume(const std::string& file);
  Result<void> check_hash();
  Result<void> evaluate_generation(bool& canceled);
  std::vector<Search::Evaluated> evaluated() const;
  Result<void> save();
  Result<void> write_elites() const;
  std::string elite_line(const Search::Elite& elite) const;
  int report(bool canceled) const;

  const EvolveCommand& command_;
  Experiment& experiment_;
  std::size_t objective_ = 0;
  double sign_ = 1;  // -1: minimize
  std::vector<std::size_t> descriptors_;
  std::unique_ptr<Search> search_;
  std::string folder_;
  std::vector<Outcome> outcomes_;  // of the generation, by individual and seed
  std::uint64_t done_ = 0;
  std::uint64_t failures_ = 0;
  double elites_written_ = 0;
  std::optional<Progress> progress_;
};

Result<std::size_t> Evolution::result_index(const std::string& name, const char* option) const {
  const std::vector<ResultInfo>& results = experiment_.scene().results;
  const auto found = std::ranges::find(results, name, &ResultInfo::name);
  if (found != results.end()) return static_cast<std::size_t>(found - results.begin());
  if (results.empty())
    return Error{"the scene declares no results; add result(\"distance\", function() return … end) to it"};
  std::vector<std::string> names;
  names.reserve(results.size());
  for (const ResultInfo& result : results) names.push_back(result.name);
  return Error{fmt::format("{} {}: the scene has no such result{}", option, printable(name), name_hint(name, names))};
}

Result<void> Evolution::choose_results() {
  const bool minimize = !command_.minimize.empty();
  if (!minimize && command_.maximize.empty())
    return Error{"name the result to search for: --maximize RESULT or --minimize RESULT"};
  const Result<std::size_t> objective =
      result_index(minimize ? command_.minimize : command_.maximize, minimize ? "--minimize" : "--maximize");
  if (!objective) return Error{objective.error()};
  objective_ = *objective;
  sign_ = minimize ? -1 : 1;
  Search::Options options;
  std::uint64_t cells = 1;
  for (const std::string& name : command_.descriptors) {
    const Result<std::size_t> index = result_index(name, "--descriptor");
    if (!index) return Error{index.error()};
    const ResultInfo& info = experiment_.scene().results[*index];
    if (info.cells == 0)
      return Error{
          fmt::format("--descriptor {}: the result has no range; declare it with {{ min = 0, max = 1, cells = "
                      "10 }} after its function",
                      name)};
    cells *= static_cast<std::uint64_t>(info.cells);
    if (cells > experiments::MapElites::kMaxCells)
      return Error{
          fmt::format("the descriptors have more than {} cells; use fewer cells", experiments::MapElites::kMaxCells)};
    descriptors_.push_back(*index);
    options.descriptors.push_back(info);
  }
  options.axes = experiment_.axes().size();
  options.population = static_cast<std::size_t>(command_.population);
  options.seed = command_.search_seed;
  search_ = Search::create(options);
  return {};
}

std::vector<double> Evolution::values_of(const Search::Vector& individual) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < individual.size(); i++) values.push_back(experiment_.axes()[i].at(individual[i]));
  return values;
}

// What must be equal for a search to be continued.
StateJson Evolution::identity() const {
  StateJson axes = StateJson::array();
  for (const experiments::Axis& axis : experiment_.axes())
    axes.push_back({{"name", axis.name}, {"min", axis.min}, {"max", axis.max}, {"values", axis.values}});
  StateJson descriptors = StateJson::array();
  for (const std::size_t index : descriptors_) {
    const ResultInfo& info = experiment_.scene().results[index];
    descriptors.push_back({{"name", info.name}, {"min", info.min}, {"max", info.max}, {"cells", info.cells}});
  }
  return {{"scene", command_.common.scene},
          {"duration", command_.common.duration},
          {"seeds", experiment_.seeds()},
          {sign_ < 0 ? "minimize" : "maximize", experiment_.scene().results[objective_].name},
          {"parameters", axes},
          {"descriptors", descriptors},
          {"population", search_->population()},
          {"search_seed", command_.search_seed}};
}

Result<void> Evolution::open_folder() {
  folder_ =
      command_.common.out.empty() ? fs::path(command_.common.scene).stem().string() + "_evolve" : command_.common.out;
  const std::string file = folder_ + "/state.json";
  std::error_code error;
  const bool exists = fs::exists(file, error);
  if (command_.common.resume)
    return exists ? resume(file)
                  : Error{fmt::format("{}: there is no search to continue; leave out --resume", printable(folder_))};
  if (exists && !command_.common.overwrite)
    return Error{
        fmt::format("{} contains a search: continue it with --resume, replace it with --overwrite, or choose "
                    "another folder with --out",
                    printable(folder_))};
  fs::create_directories(folder_, error);
  if (error) return Error{fmt::format("{} can't be created: {}", printable(folder_), error.message())};
  return {};
}

Result<void> Evolution::resume(const std::string& file) try {
  const Result<std::string> text = system::read_file(file, kMaxStateBytes);
  if (!text) return Error{fmt::format("{}: {}", printable(file), text.error())};
  const StateJson json = StateJson::parse(*text);
  const StateJson& search = json.at("search");
  const StateJson expected = identity();
  for (const auto& [key, value] : expected.items()) {
    if (search.contains(key) && search.at(key) == value) continue;
    return Error{
        fmt::format("{}: the search has another {}; continue it with the same options, or choose another "
                    "folder with --out",
                    printable(folder_), key)};
  }
  if (Result<void> restored = search_->restore(json.at("state").get<std::string>()); !restored)
    return Error{fmt::format("{}: {}", printable(file), restored.error())};
  failures_ = json.at("failures");
  return check_hash();
} catch (const nlohmann::json::exception&) {
  return Error{fmt::format("{}: the file is damaged; start again with --overwrite", printable(file))};
}

// Evaluates an elite again. Another hash shows that the scene or the program has changed.
Result<void> Evolution::check_hash() {
  const std::vector<Search::Elite> elites = search_->elites();
  if (elites.empty()) return {};
  const Search::Elite& elite = elites.back();
  std::optional<Evaluation> next = Evaluation{0, experiment_.seeds().front(), values_of(elite.individual)};
  std::uint64_t hash = elite.hash;
  const auto ran = experiment_.dispatcher().run([&] { return std::exchange(next, std::nullopt); },
                                                [&](const Evaluation&, const Outcome& outcome) -> Result<void> {
                                                  hash = outcome.hash;
                                                  return {};
                                                });
  if (!ran) return Error{ran.error()};
  if (hash == elite.hash) return {};
  return Error{
      fmt::format("{}: an elite gives another hash now, so the scene or the program has changed; choose "
                  "another folder with --out",
                  printable(folder_))};
}

// Evaluates all individuals with all seeds, and passes their means to the search.
Result<void> Evolution::evaluate_generation(bool& canceled) {
  const std::vector<Search::Vector> individuals = search_->ask();
  const std::vector<std::uint64_t>& seeds = experiment_.seeds();
  const std::uint64_t total = individuals.size() * seeds.size();
  outcomes_.clear();
  std::uint64_t next = 0;
  const auto ran = experiment_.dispatcher().run(
      [&]() -> std::optional<Evaluation> {
        if (next >= total) return {};
        const std::uint64_t number = next++;
        return Evaluation{number, seeds[number % seeds.size()], values_of(individuals[number / seeds.size()])};
      },
      [&](const Evaluation&, const Outcome& outcome) -> Result<void> {
        outcomes_.push_back(outcome);
        progress_->report(++done_);
        return {};
      });
  if (!ran) return Error{ran.error()};
  canceled = *ran == experiments::Dispatcher::End::canceled;
  if (canceled) return {};
  failures_ += static_cast<std::uint64_t>(
      std::ranges::count_if(outcomes_, [](const Outcome& outcome) { return !outcome.error.empty(); }));
  search_->tell(individuals, evaluated());
  return {};
}

// The means over the seeds. An individual with a failed evaluation has none.
std::vector<Search::Evaluated> Evolution::evaluated() const {
  const std::size_t seeds = experiment_.seeds().size();
  std::vector<Search::Evaluated> all;
  for (std::size_t first = 0; first < outcomes_.size(); first += seeds) {
    Search::Evaluated& value = all.emplace_back();
    value.hash = outcomes_[first].hash;
    value.descriptors.assign(descriptors_.size(), 0.0);
    for (std::size_t i = first; i < first + seeds; i++) {
      const Outcome& outcome = outcomes_[i];
      const bool failed = !outcome.error.empty() || outcome.results.size() != experiment_.scene().results.size();
      const double missing = std::numeric_limits<double>::quiet_NaN();
      const auto share = static_cast<double>(seeds);
      value.fitness += failed ? missing : sign_ * outcome.results[objective_] / share;
      for (std::size_t k = 0; k < descriptors_.size(); k++)
        value.descriptors[k] += failed ? missing : outcome.results[descriptors_[k]] / share;
    }
  }
  return all;
}

Result<void> Evolution::save() {
  const StateJson json = {{"limber", std::string(version())},
                          {"commit", std::string(commit())},
                          {"search", identity()},
                          {"failures", failures_},
                          {"state", search_->save()}};
  if (Result<void> saved = write_file(folder_ + "/state.json", json.dump(1) + "\n"); !saved) return saved;
  const double now = system::clock_seconds();
  if (now - elites_written_ < kElitesInterval) return {};
  elites_written_ = now;
  return write_elites();
}

std::string Evolution::elite_line(const Search::Elite& elite) const {
  const std::vector<double> values = values_of(elite.individual);
  std::vector<std::string> cells = {std::to_string(elite.generation), std::to_string(elite.index),
                                    number_text(sign_ * elite.fitness)};
  for (const double descriptor : elite.descriptors) cells.push_back(number_text(descriptor));
  for (std::size_t i = 0; i < values.size(); i++) cells.push_back(experiment_.axes()[i].text(values[i]));
  cells.push_back(fmt::format("{:016x}", elite.hash));
  cells.push_back(fmt::format("\"{}\"", experiment_.play_command(values, experiment_.seeds().front())));
  return fmt::format("{}\n", fmt::join(cells, ","));
}

Result<void> Evolution::write_elites() const {
  std::vector<std::string> columns = {"generation", "individual", experiment_.scene().results[objective_].name};
  for (const std::size_t index : descriptors_) columns.push_back(experiment_.scene().results[index].name);
  for (const experiments::Axis& axis : experiment_.axes()) columns.push_back(axis.name);
  std::string text = fmt::format("{},hash,command\n", fmt::join(columns, ","));
  for (const Search::Elite& elite : search_->elites()) text += elite_line(elite);
  return write_file(folder_ + "/elites.csv", text);
}

int Evolution::report(bool canceled) const {
  const std::vector<Search::Elite> elites = search_->elites();
  const auto best = std::ranges::max_element(elites, {}, &Search::Elite::fitness);
  print_notice("{}, {} failed; {} in {}/elites.csv", counted(search_->generation(), "generation"), failures_,
               counted(elites.size(), descriptors_.empty() ? "improvement" : "elite"), printable(folder_));
  if (canceled) print_notice("stopped; continue with the same command and --resume");
  if (elites.empty()) return fail(kInputError, "no evaluation had a result; play the scene to see its errors");
  print_result("{} {}\n{}\n", experiment_.scene().results[objective_].name, number_text(sign_ * best->fitness),
               experiment_.play_command(values_of(best->individual), experiment_.seeds().front()));
  return canceled ? kInputError : kSuccess;
}

int Evolution::run() {
  experiment_.begin();
  if (const Result<void> opened = open_folder(); !opened) return fail(kInputError, opened.error());
  const auto generations = static_cast<std::uint64_t>(command_.generations);
  const std::uint64_t left = generations - std::min(search_->generation(), generations);
  progress_.emplace("evaluation", left * search_->population() * experiment_.seeds().size());
  bool canceled = false;
  while (!canceled && search_->generation() < generations && !search_->converged()) {
    Result<void> done = evaluate_generation(canceled);
    if (done && !canceled) done = save();
    if (!done) return fail(kMachineError, done.error());
  }
  if (const Result<void> written = write_elites(); !written) return fail(kMachineError, written.error());
  return report(canceled);
}

}  // namespace

int evolve_command(const EvolveCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  if (command.maximize.empty() && command.minimize.empty())
    return fail(kUsageError, "name the result to search for: --maximize RESULT or --minimize RESULT");
  Experiment experiment(command.common);
  if (const std::optional<ExperimentFault> fault = experiment.open()) return fail(fault->code, fault->text);
  Evolution evolution(command, experiment);
  if (const Result<void> chosen = evolution.choose_results(); !chosen) return fail(kUsageError, chosen.error());
  return evolution.run();
}

}  // namespace limber::app
