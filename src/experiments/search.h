// Search: an algorithm that proposes generations of individuals and learns from their values. Individuals are positions
// 0 .. 1 along each axis; larger values are better. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "experiments/elite_list.h"
#include "experiments/evaluation.h"

struct LimberSearchModule;

namespace limber::experiments {

class Search {
 public:
  using Vector = std::vector<double>;
  using Elite = experiments::Elite;

  struct Evaluated {
    Vector objectives;  ///< Larger is better; NaN: failed.
    Vector descriptors;
    std::uint64_t hash = 0;  ///< State hash of its evaluation with the first seed.
  };

  /// The last four are pagmo's, of a module.
  enum class Algorithm : std::uint8_t { cma_es, map_elites, nsga2, gaco, maco, nspso, pso };

  struct Options {
    Algorithm algorithm = Algorithm::cma_es;
    std::size_t axes = 1;
    std::size_t objectives = 1;           ///< One for cma_es, map_elites, gaco, pso; several for maco, nspso.
    std::vector<ResultInfo> descriptors;  ///< Of MAP-Elites.
    std::size_t population = 0;           ///< 0: the default of the algorithm.
    std::uint64_t seed = 1;
    const LimberSearchModule* module = nullptr;  ///< Of pagmo's algorithms; null: only for their saved elites.
  };
  static std::unique_ptr<Search> create(const Options& options);

  Search() = default;
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;
  virtual ~Search() = default;

  /// Returns the individuals of the next generation; the same until tell().
  virtual std::vector<Vector> ask() const = 0;
  /// Passes the values of these individuals.
  virtual void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) = 0;
  virtual std::uint64_t generation() const = 0;
  virtual std::size_t population() const = 0;
  /// True if no progress is possible.
  virtual bool converged() const = 0;
  /// The elites: of MAP-Elites those of the archive, by cell; of the others those of an EliteList.
  virtual std::vector<Elite> elites() const = 0;
  /// Returns the state as text, and restores it into a search with the same options.
  virtual std::string save() const = 0;
  virtual Result<void> restore(std::string_view text) = 0;
};

/// Returns the name of an algorithm, such as "cma-es", and the algorithm of a name.
const char* name_of(Search::Algorithm algorithm);
std::optional<Search::Algorithm> algorithm_named(std::string_view name);

/// True if the algorithm belongs to the module.
constexpr bool is_in_module(Search::Algorithm algorithm) { return algorithm >= Search::Algorithm::gaco; }

/// Folds a number into 0 .. 1 by reflection at both ends, so that a search without bounds stays within the range.
double reflected(double x);

}  // namespace limber::experiments
