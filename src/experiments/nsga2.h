// Nsga2: the genetic algorithm NSGA-II for several objectives (Deb, Pratap, Agarwal, Meyarivan 2002): non-dominated
// sorting, crowding distances, simulated binary crossover and polynomial mutation. Individuals are positions 0 .. 1
// along each axis; larger objectives are better. The same seed gives the same bits on every machine. [one thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/result.h"

namespace limber::experiments {

class Nsga2 {
 public:
  using Vector = std::vector<double>;
  static constexpr double kCrossover = 0.9;            ///< Probability that two parents are crossed.
  static constexpr double kCrossoverIndex = 15;        ///< Larger: children are nearer to their parents.
  static constexpr double kMutationIndex = 20;         ///< The same for mutations, which change one axis on average.
  static constexpr std::size_t kPopulation = 40;       ///< Default.
  static constexpr std::size_t kMaxPopulation = 1000;  ///< Sorting takes quadratic time and memory.

  struct Options {
    std::size_t axes = 1;
    std::size_t objectives = 2;
    std::size_t population = 0;  ///< Even, 4 .. kMaxPopulation; 0: kPopulation.
    std::uint64_t seed = 1;
  };

  explicit Nsga2(const Options& options);

  std::size_t population() const { return options_.population; }
  std::uint64_t generation() const { return generation_; }

  /// Returns the individuals of the next generation; those of the first are uniform.
  std::vector<Vector> ask() const;
  /// Chooses the parents of the next generation among these individuals and the previous parents. An individual with an
  /// objective that is not a finite number is worse than all others.
  void tell(const std::vector<Vector>& individuals, const std::vector<Vector>& objectives);

  /// Returns the state between tell() and ask() as text, and restores it into an algorithm with the same options.
  std::string save() const;
  Result<void> restore(std::string_view text);

 private:
  struct Member {
    Vector individual;
    Vector objectives;
    std::size_t front = 0;  ///< 0: not dominated.
    double distance = 0;    ///< Crowding distance within the front.
  };
  /// Assigns fronts and crowding distances.
  static void rank(std::vector<Member>& members);
  const Member& tournament(Random& random) const;
  void cross(Vector& a, Vector& b, Random& random) const;
  void mutate(Vector& individual, Random& random) const;

  Options options_;
  std::uint64_t generation_ = 0;
  std::vector<Member> parents_;
};

}  // namespace limber::experiments
