// EliteList: the best individuals of a search without an archive: with one objective each improvement, the best last;
// with several the Pareto front, the individuals that no other one dominates, by decreasing first objective.
// [one thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::experiments {

struct Elite {
  std::vector<double> individual;
  std::vector<double> objectives;  ///< Larger is better.
  std::vector<double> descriptors;
  std::uint64_t generation = 0;  ///< In which it was found.
  std::uint64_t index = 0;       ///< Its index in that generation.
  std::uint64_t hash = 0;        ///< State hash of its evaluation with the first seed.
};

class EliteList {
 public:
  /// Maximum number of elites of a front; then those with the nearest neighbors are removed.
  static constexpr std::size_t kMaxFront = 500;

  EliteList(std::size_t axes, std::size_t objectives, std::size_t max_front = kMaxFront)
      : axes_(axes), objectives_(objectives), max_front_(max_front) {}

  /// Adds the elite if it is one, and removes those that it dominates. One with an objective that is not a finite
  /// number is skipped; of equals, the first stays.
  void add(Elite elite);
  const std::vector<Elite>& elites() const { return elites_; }

  std::string save() const;
  Result<void> restore(std::string_view text);

 private:
  void remove_most_crowded();

  std::size_t axes_;
  std::size_t objectives_;
  std::size_t max_front_;
  std::vector<Elite> elites_;
};

/// True if `a` is nowhere worse than `b`, and better in one objective.
bool dominates(const std::vector<double>& a, const std::vector<double>& b);

/// Crowding distances (Deb and others 2002): for each point the sum of the distances of its two neighbors along each
/// objective, relative to the range; infinite for the ends.
std::vector<double> crowding_distances(const std::vector<const std::vector<double>*>& points);

}  // namespace limber::experiments
