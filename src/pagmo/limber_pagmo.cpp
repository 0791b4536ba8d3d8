// limber-pagmo.so: algorithms of pagmo (Biscani, Izzo 2020) for limber's searches (experiments/search_module.h). pagmo
// calls a function that evaluates a generation. Here it runs on a thread of its own, and this function waits there
// until the caller has the costs; so an algorithm runs from its first to its last generation, and none is saved or
// restored. [the thread that calls the functions; the algorithm's thread]
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <algorithm>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/gaco.hpp>
#include <pagmo/algorithms/maco.hpp>
#include <pagmo/algorithms/nspso.hpp>
#include <pagmo/algorithms/pso_gen.hpp>
#include <pagmo/batch_evaluators/default_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "experiments/search_module.h"

namespace {

using pagmo::vector_double;

// Thrown through pagmo's functions if the search ends.
struct SearchEnded {};

// Hands a generation over from the algorithm's thread to the caller's thread, and its costs back.
class Exchange {
 public:
  // [the algorithm's thread]
  vector_double evaluate(const vector_double& positions) {
    std::unique_lock lock(mutex_);
    positions_ = positions;
    asked_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !asked_ || ended_; });
    if (ended_) throw SearchEnded();
    return costs_;
  }
  void fail(std::string error) {
    const std::lock_guard lock(mutex_);
    error_ = std::move(error);
    changed_.notify_all();
  }

  // [the caller's thread]
  const double* wait_for_positions() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return asked_ || !error_.empty(); });
    return error_.empty() ? positions_.data() : nullptr;
  }
  void answer(vector_double costs) {
    const std::lock_guard lock(mutex_);
    costs_ = std::move(costs);
    asked_ = false;
    changed_.notify_all();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }
  const char* error() const { return error_.c_str(); }  // after wait_for_positions() returned null

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  vector_double positions_;
  vector_double costs_;
  std::string error_;
  bool asked_ = false;
  bool ended_ = false;
};

// The unit cube; its values come from Evaluator.
struct Cube {
  std::size_t axes = 1;
  std::size_t objectives = 1;

  vector_double fitness(const vector_double&) const { throw std::logic_error("pagmo evaluated a single individual"); }
  vector_double::size_type get_nobj() const { return objectives; }
  std::pair<vector_double, vector_double> get_bounds() const {
    return {vector_double(axes, 0.0), vector_double(axes, 1.0)};
  }
};

struct Evaluator {
  Exchange* exchange = nullptr;
  vector_double operator()(const pagmo::problem&, const vector_double& positions) const {
    return exchange->evaluate(positions);
  }
};

// The parameters are pagmo's defaults, except for these of the ant colonies: no limit of evaluations without
// improvement, no smallest distance between values, and an archive that is not larger than the population.
pagmo::algorithm algorithm_of(const std::string& name, std::size_t population, std::uint32_t seed,
                              const pagmo::bfe& evaluator) {
  constexpr unsigned kGenerations = std::numeric_limits<unsigned>::max();
  constexpr unsigned kArchive = 63;
  const unsigned archive = std::min(kArchive, static_cast<unsigned>(population));
  const auto with_evaluator = [&](auto algorithm) {
    algorithm.set_bfe(evaluator);
    return pagmo::algorithm{std::move(algorithm)};
  };
  if (name == "gaco") return with_evaluator(pagmo::gaco(kGenerations, archive, 1, 0, 0, 1, 7, 0, 0, 0, false, seed));
  if (name == "maco") return with_evaluator(pagmo::maco(kGenerations, archive, 1, 1, 7, 0, 0, false, seed));
  if (name == "nspso")
    return with_evaluator(pagmo::nspso(kGenerations, 0.6, 2, 2, 1, 0.5, 60, "crowding distance", false, seed));
  return with_evaluator(pagmo::pso_gen(kGenerations, 0.7298, 2.05, 2.05, 0.5, 5, 2, 4, false, seed));
}

}  // namespace

extern "C" struct LimberModuleSearch {
  LimberModuleSearch(const std::string& name, const Cube& cube, std::size_t population, std::uint32_t seed)
      : costs_(population * cube.objectives), thread_([=, this] { run(name, cube, population, seed); }) {}
  ~LimberModuleSearch() {
    exchange_.end();
    thread_.join();
  }

  Exchange& exchange() { return exchange_; }
  const Exchange& exchange() const { return exchange_; }
  std::size_t costs() const { return costs_; }

 private:
  void run(const std::string& name, const Cube& cube, std::size_t population, std::uint32_t seed) {
    try {
      const pagmo::bfe evaluator{Evaluator{&exchange_}};
      algorithm_of(name, population, seed, evaluator)
          .evolve(pagmo::population(pagmo::problem{cube}, evaluator, population, seed));
      exchange_.fail("the algorithm ended");
    } catch (const SearchEnded&) {
      return;
    } catch (const std::exception& error) {
      exchange_.fail(error.what());
    }
  }

  Exchange exchange_;
  std::size_t costs_;  // number of costs of a generation
  std::thread thread_;
};

namespace {

LimberModuleSearch* create(const char* algorithm, std::size_t axes, std::size_t objectives, std::size_t population,
                           std::uint32_t seed) {
  return new LimberModuleSearch(algorithm, Cube{axes, objectives}, population, seed);
}

const double* ask(LimberModuleSearch* search) { return search->exchange().wait_for_positions(); }

void tell(LimberModuleSearch* search, const double* costs) {
  search->exchange().answer(vector_double(costs, costs + search->costs()));
}

const char* error(const LimberModuleSearch* search) { return search->exchange().error(); }

void destroy(LimberModuleSearch* search) { delete search; }

}  // namespace

extern "C" __attribute__((visibility("default"))) const LimberSearchModule* limber_search_module() {
  static const LimberSearchModule module{limber::experiments::kSearchModuleVersion, create, ask, tell, error, destroy};
  return &module;
}
