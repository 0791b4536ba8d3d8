// CMA-ES within bounds, and MAP-Elites, as searches.
#include "experiments/search.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "experiments/cma_es.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

constexpr double kStart = 0.5;  // the middle of each range
constexpr double kSigma = 0.3;  // of the range, as recommended for bounds in Hansen's tutorial
constexpr std::size_t kArchiveBatch = 100;

class CmaSearch final : public Search {
 public:
  explicit CmaSearch(const Options& options)
      : axes_(options.axes), es_(Vector(options.axes, kStart), kSigma, options.seed, options.population) {}

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
      costs.push_back(-values[i].fitness);
      if (!std::isfinite(values[i].fitness)) continue;
      if (!elites_.empty() && !(values[i].fitness > elites_.back().fitness)) continue;
      elites_.push_back({individuals[i], values[i].fitness, {}, es_.generation(), i, values[i].hash});
    }
    es_.tell(es_.ask(), costs);  // before the reflection
  }
  std::uint64_t generation() const override { return es_.generation(); }
  std::size_t population() const override { return es_.population(); }
  bool converged() const override { return es_.converged(); }
  std::vector<Elite> elites() const override { return elites_; }
  std::string save() const override {
    Json elites = Json::array();
    for (const Elite& e : elites_) elites.push_back({e.individual, e.fitness, e.generation, e.index, e.hash});
    return Json{{"cma_es", es_.save()}, {"elites", elites}}.dump();
  }
  Result<void> restore(std::string_view text) override try {
    const Json json = Json::parse(text);
    Result<CmaEs> es = CmaEs::restore(json.at("cma_es").get<std::string>());
    if (!es) return Error{es.error()};
    if (es->mean().size() != axes_) return Error{"the saved search has other parameters"};
    std::vector<Elite> elites;
    for (const Json& e : json.at("elites")) {
      elites.push_back({e.at(0).get<Vector>(), e.at(1), {}, e.at(2), e.at(3), e.at(4)});
      if (elites.back().individual.size() != axes_) return Error{"the saved search has other parameters"};
    }
    es_ = std::move(*es);
    elites_ = std::move(elites);
    return {};
  } catch (const Json::exception&) {
    return Error{"the state of the search is damaged"};
  }

 private:
  std::size_t axes_;
  CmaEs es_;
  std::vector<Elite> elites_;
};

class ArchiveSearch final : public Search {
 public:
  explicit ArchiveSearch(const MapElites::Options& options) : batch_(options.batch), archive_(options) {}

  std::vector<Vector> ask() const override { return archive_.ask(); }
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) override {
    archive_.tell(individuals, values);
  }
  std::uint64_t generation() const override { return archive_.generation(); }
  std::size_t population() const override { return batch_; }
  bool converged() const override { return false; }
  std::vector<Elite> elites() const override {
    std::vector<Elite> elites;
    for (const auto& [cell, elite] : archive_.elites()) elites.push_back(elite);
    return elites;
  }
  std::string save() const override { return archive_.save(); }
  Result<void> restore(std::string_view text) override { return archive_.restore(text); }

 private:
  std::size_t batch_;
  MapElites archive_;
};

}  // namespace

double reflected(double x) {
  const double periodic = std::abs(x) - 2 * std::floor(std::abs(x) / 2);
  return periodic > 1 ? 2 - periodic : periodic;
}

std::unique_ptr<Search> Search::create(const Options& options) {
  if (options.descriptors.empty()) return std::make_unique<CmaSearch>(options);
  MapElites::Options archive;
  archive.axes = options.axes;
  archive.descriptors = options.descriptors;
  archive.batch = options.population > 0 ? options.population : kArchiveBatch;
  archive.seed = options.seed;
  return std::make_unique<ArchiveSearch>(archive);
}

}  // namespace limber::experiments
