// `limber evolve`: generations of evaluations, and the folder with the search's state and its elites.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/experiments/archive.h"
#include "app/experiments/evolve_play.h"
#include "app/experiments/experiment.h"
#include "app/experiments/module.h"
#include "app/experiments/mpi_job.h"
#include "app/paths.h"
#include "app/progress.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/clock.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "experiments/map_elites.h"
#include "experiments/module_search.h"
#include "experiments/nsga2.h"
#include "experiments/search.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;
using experiments::Evaluation;
using experiments::MapElites;
using experiments::ModuleSearch;
using experiments::Nsga2;
using experiments::Outcome;
using experiments::ResultInfo;
using experiments::Search;
using StateJson = nlohmann::ordered_json;

constexpr double kElitesInterval = 10;  // real seconds between two updates of the elites' files

class Evolution {
 public:
  Evolution(const EvolveCommand& command, Experiment& experiment)
      : command_(command), experiment_(experiment), archive_(folder_of(command)) {}

  /// Finds the objectives and the descriptors among the results of the scene, and creates the search.
  Result<void> prepare();
  int run();

 private:
  static std::string folder_of(const EvolveCommand& command);
  Result<std::size_t> result_index(const std::string& name, const char* option) const;
  Result<void> choose_objectives();
  Result<void> choose_descriptors();
  Result<void> check_objectives(Search::Algorithm algorithm) const;
  Result<void> choose_algorithm();
  Result<void> check_size() const;
  Result<void> create_search();
  Result<void> open_folder();
  Result<void> resume();
  Result<void> check_hash();
  Result<void> evaluate_generation(bool& canceled);
  std::vector<Search::Evaluated> evaluated() const;
  Result<void> save();
  Result<void> write_elites();
  int report(bool canceled) const;

  const EvolveCommand& command_;
  Experiment& experiment_;
  Archive archive_;
  SearchRecord record_;
  std::vector<std::size_t> descriptors_;  // indices among the results of the scene
  std::unique_ptr<Search> search_;
  std::vector<Outcome> outcomes_;  // of the generation, by individual and seed
  std::uint64_t done_ = 0;
  std::uint64_t failures_ = 0;
  double elites_written_ = 0;
  bool presets_failed_ = false;
  std::optional<Progress> progress_;
};

std::string Evolution::folder_of(const EvolveCommand& command) {
  return command.common.out.empty() ? fs::path(command.common.scene).stem().string() + "_evolve" : command.common.out;
}

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

Result<void> Evolution::choose_objectives() {
  const auto add = [&](const std::string& name, bool maximize) -> Result<void> {
    const Result<std::size_t> index = result_index(name, maximize ? "--maximize" : "--minimize");
    if (!index) return Error{index.error()};
    if (std::ranges::find(record_.objectives, name, &Objective::name) != record_.objectives.end())
      return Error{fmt::format("the result {} is an objective twice; name it once", name)};
    record_.objectives.push_back({name, maximize, *index});
    return {};
  };
  for (const std::string& name : command_.maximize) {
    if (Result<void> added = add(name, true); !added) return added;
  }
  for (const std::string& name : command_.minimize) {
    if (Result<void> added = add(name, false); !added) return added;
  }
  return {};
}

Result<void> Evolution::choose_descriptors() {
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
    if (cells > MapElites::kMaxCells)
      return Error{fmt::format("the descriptors have more than {} cells; use fewer cells", MapElites::kMaxCells)};
    descriptors_.push_back(*index);
    record_.descriptors.push_back(info);
  }
  return {};
}

Result<void> Evolution::check_objectives(Search::Algorithm algorithm) const {
  using enum Search::Algorithm;
  const bool several = record_.objectives.size() > 1;
  const bool needs_one = algorithm == cma_es || algorithm == gaco || algorithm == pso;
  const bool needs_several = algorithm == maco || algorithm == nspso;
  if (several && needs_one)
    return Error{fmt::format("--algorithm {}: it has one objective only; use nsga2, maco or nspso for several",
                             name_of(algorithm))};
  if (!several && needs_several)
    return Error{fmt::format("--algorithm {}: it needs several objectives; use cma-es, gaco, pso or nsga2 for one",
                             name_of(algorithm))};
  return {};
}

Result<void> Evolution::choose_algorithm() {
  using enum Search::Algorithm;
  const bool several = record_.objectives.size() > 1;
  const bool archive = !record_.descriptors.empty();
  if (several && archive) return Error{"--descriptor: a search for variety has one objective; leave out the others"};
  const std::string& wanted = command_.algorithm;
  const Search::Algorithm natural = archive ? map_elites : several ? nsga2 : cma_es;
  const Search::Algorithm chosen = experiments::algorithm_named(wanted).value_or(natural);
  if (archive && chosen != map_elites)
    return Error{fmt::format("--algorithm {}: only map-elites has descriptors", wanted)};
  if (!archive && chosen == map_elites)
    return Error{"--algorithm map-elites: name its descriptors with --descriptor RESULT"};
  if (Result<void> counted = check_objectives(chosen); !counted) return counted;
  record_.algorithm = chosen;
  return check_size();
}

Result<void> Evolution::check_size() const {
  const bool in_module = is_in_module(record_.algorithm);
  const std::size_t limit = in_module ? ModuleSearch::kMaxPopulation : Nsga2::kMaxPopulation;
  if ((in_module || record_.algorithm == Search::Algorithm::nsga2) && record_.population > limit)
    return Error{fmt::format("--population: of {} at most {}", name_of(record_.algorithm), limit)};
  const std::size_t population = record_.population > 0 ? record_.population : ModuleSearch::kPopulation;
  if (in_module && population * static_cast<std::size_t>(command_.generations) > ModuleSearch::kMaxEvaluations)
    return Error{
        fmt::format("--generations: {} evaluates at most {} individuals; use fewer generations or a smaller "
                    "population",
                    name_of(record_.algorithm), ModuleSearch::kMaxEvaluations)};
  return {};
}

// Creates the search; loads the module of its algorithm.
Result<void> Evolution::create_search() {
  Search::Options options = record_.options();
  if (is_in_module(record_.algorithm)) {
    const Result<const LimberSearchModule*> module = load_module<LimberSearchModule>(
        "limber-pagmo.so", experiments::kSearchModuleFunction, experiments::kSearchModuleVersion,
        {"Install libpagmo-dev and build Limber again", "Install pagmo, or build Limber again"});
    if (!module) return Error{fmt::format("--algorithm {}: {}", name_of(record_.algorithm), module.error())};
    options.module = *module;
  }
  search_ = Search::create(options);
  record_.population = search_->population();
  return {};
}

Result<void> Evolution::prepare() {
  record_.scene = command_.common.scene;
  record_.scene_path = experiment_.scene_path();
  record_.duration = command_.common.duration;
  record_.seeds = experiment_.seeds();
  record_.axes = experiment_.axes();
  record_.search_seed = command_.search_seed;
  record_.population = static_cast<std::size_t>(command_.population);
  Result<void> chosen = choose_objectives();
  if (chosen) chosen = choose_descriptors();
  if (chosen) chosen = choose_algorithm();
  return chosen ? create_search() : chosen;
}

Result<void> Evolution::open_folder() {
  const std::string& folder = archive_.folder();
  std::error_code error;
  const bool exists = fs::exists(archive_.state_file(), error);
  if (command_.common.resume)
    return exists ? resume()
                  : Error{fmt::format("{}: there is no search to continue; leave out --resume", printable(folder))};
  if (exists && !command_.common.overwrite)
    return Error{
        fmt::format("{} contains a search: continue it with --resume, replace it with --overwrite, or choose "
                    "another folder with --out",
                    printable(folder))};
  fs::create_directories(folder, error);
  if (error) return Error{fmt::format("{} can't be created: {}", printable(folder), error.message())};
  return {};
}

Result<void> Evolution::resume() {
  const Result<SavedSearch> saved = read_search(archive_);
  if (!saved) return Error{fmt::format("{}; start again with --overwrite", saved.error())};
  if (const std::string key = SearchRecord::difference(saved->record, record_.text()); !key.empty())
    return Error{
        fmt::format("{}: the search has another {}; continue it with the same options, or choose another "
                    "folder with --out",
                    printable(archive_.folder()), key)};
  if (Result<void> restored = search_->restore(saved->state); !restored)
    return Error{fmt::format("{}: {}", printable(archive_.state_file()), restored.error())};
  failures_ = saved->failures;
  return check_hash();
}

// Evaluates an elite again. Another hash shows that the scene or the program has changed.
Result<void> Evolution::check_hash() {
  const std::vector<Search::Elite> elites = search_->elites();
  if (elites.empty()) return {};
  const Search::Elite& elite = elites.back();
  std::optional<Evaluation> next = Evaluation{0, record_.seeds.front(), record_.values(elite.individual)};
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
                  printable(archive_.folder()))};
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
        return Evaluation{number, seeds[number % seeds.size()], record_.values(individuals[number / seeds.size()])};
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
    value.objectives.assign(record_.objectives.size(), 0.0);
    value.descriptors.assign(descriptors_.size(), 0.0);
    for (std::size_t i = first; i < first + seeds; i++) {
      const Outcome& outcome = outcomes_[i];
      const bool failed = !outcome.error.empty() || outcome.results.size() != experiment_.scene().results.size();
      const double missing = std::numeric_limits<double>::quiet_NaN();
      const auto share = static_cast<double>(seeds);
      for (std::size_t k = 0; k < record_.objectives.size(); k++) {
        const Objective& objective = record_.objectives[k];
        value.objectives[k] += failed ? missing : objective.sign() * outcome.results[objective.index] / share;
      }
      for (std::size_t k = 0; k < descriptors_.size(); k++)
        value.descriptors[k] += failed ? missing : outcome.results[descriptors_[k]] / share;
    }
  }
  return all;
}

Result<void> Evolution::save() {
  const StateJson json = {{"limber", std::string(version())},
                          {"commit", std::string(commit())},
                          {"scene_path", record_.scene_path},
                          {"search", StateJson::parse(record_.text())},
                          {"failures", failures_},
                          {"state", search_->save()}};
  if (Result<void> saved = write_archive_file(archive_.state_file(), json.dump(1) + "\n"); !saved) return saved;
  const double now = system::clock_seconds();
  if (now - elites_written_ < kElitesInterval) return {};
  elites_written_ = now;
  return write_elites();
}

// A show that plays the archive may own its presets; then they are written by a later call.
Result<void> Evolution::write_elites() {
  const std::vector<Search::Elite> elites = search_->elites();
  if (Result<void> written = archive_.write_table(record_, elites); !written) return written;
  const std::string state = state_dir();
  const Result<void> presets = archive_.write_presets(record_, elites, state.empty() ? "" : state + "/locks");
  if (!presets && !std::exchange(presets_failed_, true))
    print_notice("{}: {} (reported once)", printable(archive_.preset_file()), presets.error());
  return {};
}

int Evolution::report(bool canceled) const {
  const std::vector<Search::Elite> elites = search_->elites();
  const bool several = record_.objectives.size() > 1;
  print_notice("{}, {} failed; {} in {}/elites.csv", counted(search_->generation(), "generation"), failures_,
               several ? counted(elites.size(), "elite of the Pareto front", "elites of the Pareto front")
                       : counted(elites.size(), descriptors_.empty() ? "improvement" : "elite"),
               printable(archive_.folder()));
  if (canceled) print_notice("stopped; continue with the same command and --resume");
  if (elites.empty()) return fail(kInputError, "no evaluation had a result; play the scene to see its errors");
  // the best in each objective
  for (std::size_t i = 0; i < record_.objectives.size(); i++) {
    const Search::Elite& best = elites[best_of(elites, i)];
    std::string values;
    for (std::size_t k = 0; k < record_.objectives.size(); k++) {
      const Objective& objective = record_.objectives[k];
      values +=
          fmt::format("{}{} {}", k == 0 ? "" : " ", objective.name, number_text(objective.sign() * best.objectives[k]));
    }
    print_result("{}\n{}\n", values, record_.play_command(best));
  }
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

int run_evolve(const EvolveCommand& command, experiments::Workers* ranks) {
  if (command.common.scene.empty())
    return fail(kUsageError, "name the scene: limber evolve SCENE.lua --maximize RESULT");
  if (command.maximize.empty() && command.minimize.empty())
    return fail(kUsageError, "name the result to search for: --maximize RESULT or --minimize RESULT");
  Experiment experiment(command.common, ranks);
  if (const std::optional<ExperimentFault> fault = experiment.open()) return fail(fault->code, fault->text);
  Evolution evolution(command, experiment);
  if (const Result<void> prepared = evolution.prepare(); !prepared) return fail(kUsageError, prepared.error());
  return evolution.run();
}

}  // namespace

int evolve_command(const EvolveCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  return run_in_job(command.common, [&](experiments::Workers* ranks) { return run_evolve(command, ranks); });
}

}  // namespace limber::app
