// Search: an algorithm that proposes generations of individuals and learns from their values. Individuals are positions
// 0 .. 1 along each axis; larger values are better. [one thread]
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "experiments/map_elites.h"

namespace limber::experiments {

class Search {
 public:
  using Vector = MapElites::Vector;
  using Elite = MapElites::Elite;
  using Evaluated = MapElites::Evaluated;

  struct Options {
    std::size_t axes = 1;
    std::vector<ResultInfo> descriptors;  ///< None: CMA-ES; else MAP-Elites.
    std::size_t population = 0;           ///< 0: the default of the algorithm.
    std::uint64_t seed = 1;
  };
  static std::unique_ptr<Search> create(const Options& options);

  Search() = default;
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;
  virtual ~Search() = default;

  /// Returns the individuals of the next generation; the same until tell().
  virtual std::vector<Vector> ask() const = 0;
  virtual void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) = 0;
  virtual std::uint64_t generation() const = 0;
  virtual std::size_t population() const = 0;
  /// True if no progress is possible.
  virtual bool converged() const = 0;
  /// The elites: of MAP-Elites those of the archive, by cell; of CMA-ES each improvement, the best last.
  virtual std::vector<Elite> elites() const = 0;
  /// Returns the state as text, and restores it into a search with the same options.
  virtual std::string save() const = 0;
  virtual Result<void> restore(std::string_view text) = 0;
};

/// Folds a number into 0 .. 1 by reflection at both ends, so that a search without bounds stays within the range.
double reflected(double x);

}  // namespace limber::experiments
