// ModuleSearch: a search with an algorithm of a module (search_module.h). Its state is all costs so far: restoring runs
// the algorithm with them from the beginning, so it continues with the same bits. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/elite_list.h"
#include "experiments/search.h"
#include "experiments/search_module.h"

namespace limber::experiments {

class ModuleSearch final : public Search {
 public:
  static constexpr std::size_t kPopulation = 40;           ///< Default.
  static constexpr std::size_t kMaxPopulation = 1000;      ///< Sorting takes quadratic time.
  static constexpr std::size_t kMaxEvaluations = 1000000;  ///< Of a search: the state has a size of about 20 MB then.
  /// Costs beyond it count as this one: pagmo compares volumes, with a margin of 0.01.
  static constexpr double kMaxCost = 1e9;

  /// Without a module it has its elites after restore(), but ask() is empty.
  explicit ModuleSearch(const Options& options);

  std::vector<Vector> ask() const override { return individuals_; }
  /// Throws std::runtime_error if the algorithm fails because memory is short.
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) override;
  std::uint64_t generation() const override { return generation_; }
  std::size_t population() const override { return options_.population; }
  bool converged() const override { return false; }
  std::vector<Elite> elites() const override { return elites_.elites(); }
  std::string save() const override;
  Result<void> restore(std::string_view text) override;

 private:
  void start();
  void next();
  void tell_costs(const std::vector<double>& costs);
  std::vector<double> costs_of(const std::vector<Evaluated>& values);

  Options options_;
  std::unique_ptr<LimberModuleSearch, void (*)(LimberModuleSearch*)> search_;
  std::vector<Vector> individuals_;  // of the generation
  std::uint64_t generation_ = 0;
  std::vector<double> worst_;  // by objective: the largest cost so far; empty: none
  std::string costs_;          // of all generations, as hexadecimal digits
  std::uint64_t asked_ = 0;    // hash of all individuals
  EliteList elites_;
};

}  // namespace limber::experiments
