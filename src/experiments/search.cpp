// CMA-ES within bounds, MAP-Elites and NSGA-II, as searches; the choice of the algorithm.
#include "experiments/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "experiments/cma_es.h"
#include "experiments/map_elites.h"
#include "experiments/module_search.h"
#include "experiments/nsga2.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

// by Search::Algorithm
constexpr std::array<const char*, 7> kNames{"cma-es", "map-elites", "nsga2", "gaco", "maco", "nspso", "pso"};
constexpr double kStart = 0.5;  // the middle of each range
constexpr double kSigma = 0.3;  // of the range, as recommended for bounds in Hansen's tutorial
constexpr std::size_t kArchiveBatch = 100;

class CmaSearch final : public Search {
 public:
  explicit CmaSearch(const Options& options)
      : axes_(options.axes),
        es_(Vector(options.axes, kStart), kSigma, options.seed, options.population),
        elites_(options.axes, 1) {}

  std::vector<Vector> ask() const override {
    std::vector<Vector> individuals = es_.ask();
    for (Vector& individual : individuals) {
      for (double& position : individual) position = reflected(position);
    }
    return individuals;
  }
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) override {
    std::vector<double> costs;
    for (std::size_t i = 0; i < values.size(); i++) {
      costs.push_back(-values[i].objectives[0]);
      elites_.add({individuals[i], values[i].objectives, {}, es_.generation(), i, values[i].hash});
    }
    es_.tell(es_.ask(), costs);  // before the reflection
  }
  std::uint64_t generation() const override { return es_.generation(); }
  std::size_t population() const override { return es_.population(); }
  bool converged() const override { return es_.converged(); }
  std::vector<Elite> elites() const override { return elites_.elites(); }
  std::string save() const override { return Json{{"cma_es", es_.save()}, {"elites", elites_.save()}}.dump(); }
  Result<void> restore(std::string_view text) override try {
    const Json json = Json::parse(text);
    Result<CmaEs> es = CmaEs::restore(json.at("cma_es").get<std::string>());
    if (!es) return Error{es.error()};
    if (es->mean().size() != axes_) return Error{"the saved search has other parameters"};
    if (Result<void> restored = elites_.restore(json.at("elites").get<std::string>()); !restored) return restored;
    es_ = std::move(*es);
    return {};
  } catch (const Json::exception&) {
    return Error{"the state of the search is damaged"};
  }

 private:
  std::size_t axes_;
  CmaEs es_;
  EliteList elites_;
};

class ArchiveSearch final : public Search {
 public:
  explicit ArchiveSearch(const MapElites::Options& options) : batch_(options.batch), archive_(options) {}

  std::vector<Vector> ask() const override { return archive_.ask(); }
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) override {
    std::vector<MapElites::Evaluated> evaluated;
    evaluated.reserve(values.size());
    for (const Evaluated& value : values) evaluated.push_back({value.objectives[0], value.descriptors, value.hash});
    archive_.tell(individuals, evaluated);
  }
  std::uint64_t generation() const override { return archive_.generation(); }
  std::size_t population() const override { return batch_; }
  bool converged() const override { return false; }
  std::vector<Elite> elites() const override {
    std::vector<Elite> elites;
    for (const auto& [cell, e] : archive_.elites())
      elites.push_back({e.individual, {e.fitness}, e.descriptors, e.generation, e.index, e.hash});
    return elites;
  }
  std::string save() const override { return archive_.save(); }
  Result<void> restore(std::string_view text) override { return archive_.restore(text); }

 private:
  std::size_t batch_;
  MapElites archive_;
};

class GeneticSearch final : public Search {
 public:
  explicit GeneticSearch(const Options& options)
      : nsga2_({options.axes, options.objectives, options.population, options.seed}),
        elites_(options.axes, options.objectives) {}

  std::vector<Vector> ask() const override { return nsga2_.ask(); }
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) override {
    std::vector<Vector> objectives;
    for (std::size_t i = 0; i < values.size(); i++) {
      elites_.add({individuals[i], values[i].objectives, {}, nsga2_.generation(), i, values[i].hash});
      objectives.push_back(values[i].objectives);
    }
    nsga2_.tell(individuals, objectives);
  }
  std::uint64_t generation() const override { return nsga2_.generation(); }
  std::size_t population() const override { return nsga2_.population(); }
  bool converged() const override { return false; }
  std::vector<Elite> elites() const override { return elites_.elites(); }
  std::string save() const override { return Json{{"nsga2", nsga2_.save()}, {"elites", elites_.save()}}.dump(); }
  Result<void> restore(std::string_view text) override try {
    const Json json = Json::parse(text);
    if (Result<void> restored = nsga2_.restore(json.at("nsga2").get<std::string>()); !restored) return restored;
    return elites_.restore(json.at("elites").get<std::string>());
  } catch (const Json::exception&) {
    return Error{"the state of the search is damaged"};
  }

 private:
  Nsga2 nsga2_;
  EliteList elites_;
};

}  // namespace

const char* name_of(Search::Algorithm algorithm) { return kNames[static_cast<std::size_t>(algorithm)]; }

std::optional<Search::Algorithm> algorithm_named(std::string_view name) {
  const auto* const known = std::ranges::find(kNames, name);
  if (known == kNames.end()) return {};
  return static_cast<Search::Algorithm>(known - kNames.begin());
}

double reflected(double x) {
  const double periodic = std::abs(x) - 2 * std::floor(std::abs(x) / 2);
  return periodic > 1 ? 2 - periodic : periodic;
}

std::unique_ptr<Search> Search::create(const Options& options) {
  if (options.algorithm == Algorithm::cma_es) return std::make_unique<CmaSearch>(options);
  if (options.algorithm == Algorithm::nsga2) return std::make_unique<GeneticSearch>(options);
  if (is_in_module(options.algorithm)) return std::make_unique<ModuleSearch>(options);
  MapElites::Options archive;
  archive.axes = options.axes;
  archive.descriptors = options.descriptors;
  archive.batch = options.population > 0 ? options.population : kArchiveBatch;
  archive.seed = options.seed;
  return std::make_unique<ArchiveSearch>(archive);
}

}  // namespace limber::experiments
