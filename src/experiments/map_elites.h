// MapElites: a search that fills an archive with the best individual of each cell of a grid of descriptors, such as
// speed and height (Mouret, Clune 2015). Individuals are positions 0 .. 1 along each axis; new ones are made from
// elites by isotropic and directional variation (Vassiliades, Mouret 2018). The same seed gives the same bits on every
// machine. [one thread]
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "experiments/evaluation.h"

namespace limber::experiments {

class MapElites {
 public:
  using Vector = std::vector<double>;
  static constexpr double kIsotropic = 0.01;   ///< Standard deviation of the isotropic variation.
  static constexpr double kDirectional = 0.2;  ///< That along the line to another elite.
  static constexpr std::uint64_t kMaxCells = 1'000'000;

  struct Options {
    std::size_t axes = 1;
    std::vector<ResultInfo> descriptors;  ///< With a range and a number of cells each.
    std::size_t batch = 100;              ///< Individuals per generation.
    std::size_t random_generations = 1;   ///< Generations of uniform individuals at the beginning.
    std::uint64_t seed = 1;
  };
  struct Elite {
    Vector individual;
    double fitness = 0;
    Vector descriptors;
    std::uint64_t generation = 0;  ///< In which it was found.
    std::uint64_t index = 0;       ///< Its index in that generation.
    std::uint64_t hash = 0;        ///< State hash of its evaluation with the first seed.
  };
  struct Evaluated {
    double fitness = 0;  ///< Larger is better; NaN: failed.
    Vector descriptors;
    std::uint64_t hash = 0;  ///< State hash of its evaluation with the first seed.
  };

  explicit MapElites(Options options) : options_(std::move(options)) {}

  /// Returns the individuals of the next generation.
  std::vector<Vector> ask() const;
  /// Adds those individuals to the archive, in their order. A failed one, or one with a descriptor that is not a
  /// number, is skipped.
  void tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values);

  std::uint64_t generation() const { return generation_; }
  /// The archive, by the number of the cell: the cell of the last descriptor changes fastest.
  const std::map<std::uint64_t, Elite>& elites() const { return elites_; }
  /// Number of cells.
  std::uint64_t cells() const;
  /// Returns the index of the cell along one descriptor; values outside of the range belong to the first or last one.
  static std::uint64_t cell_along(const ResultInfo& descriptor, double value);
  /// Returns the number of the cell; values outside of a range belong to its first or last cell.
  std::uint64_t cell_of(const Vector& descriptors) const;

  /// Returns the state between tell() and ask() as text, and restores it into a search with the same options.
  std::string save() const;
  Result<void> restore(std::string_view text);

 private:
  Options options_;
  std::uint64_t generation_ = 0;
  std::map<std::uint64_t, Elite> elites_;
};

}  // namespace limber::experiments
