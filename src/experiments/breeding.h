// Breeding: generations of a few variations, of which a person selects the parents of the next generation by eye.
// Individuals are positions 0 .. 1 along each axis. The same seed and the same operations give the same bits on every
// machine. [one thread]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/random.h"
#include "experiments/axis.h"

namespace limber::experiments {

class Breeding {
 public:
  using Vector = std::vector<double>;
  static constexpr std::size_t kCount = 9;             ///< Individuals of a generation.
  static constexpr double kBeyond = 0.25;              ///< How far a crossed position may lie outside of its parents.
  static constexpr std::size_t kMaxGenerations = 500;  ///< Generations that undo() can return to.

  struct Generation {
    std::array<Vector, kCount> individuals;
    std::array<bool, kCount> liked{};
    std::array<bool, kCount> kept{};  ///< They are unchanged from the generation before.
    std::uint64_t number = 0;         ///< Number of operations before; unique.
  };

  /// The first generation: the parents, at most kCount, and variations of them. Requires at least one parent and one
  /// axis.
  Breeding(std::vector<Axis> axes, const std::vector<Vector>& parents, double amount, std::uint64_t seed);

  const std::vector<Axis>& axes() const { return axes_; }
  const Generation& current() const { return history_[at_]; }
  /// Returns the values of the parameters of an individual.
  std::vector<double> values(std::size_t individual) const;

  /// Likes an individual, or no longer.
  void toggle_liked(std::size_t individual);
  /// Holds an axis: no operation changes it. Or no longer.
  void toggle_held(std::size_t axis) { held_[axis] = !held_[axis]; }
  bool held(std::size_t axis) const { return held_[axis]; }

  // Operations replace the individuals that are not liked. They return false, and do nothing, if all are liked.
  /// Replaces each by a liked one (without any: by itself) with a normal deviation of `amount`, 0 to 1, along each
  /// axis. A listed axis takes another of its values with a probability of `amount`.
  bool mutate(double amount);
  /// Replaces each by a mix of two liked ones: a random position between and slightly beyond both along each axis
  /// (BLX, Eshelman, Schaffer 1993). With one liked individual the other parent is any other one, without any both are.
  bool cross();
  /// Replaces each by random positions.
  bool randomize();

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < history_.size(); }
  /// Return to the generation before the last operation, and forth. Without one they do nothing.
  void undo() { at_ -= can_undo() ? 1 : 0; }
  void redo() { at_ += can_redo() ? 1 : 0; }

 private:
  using MakeChild = std::function<Vector(std::size_t individual, Random& random)>;

  bool next_generation(const MakeChild& make);
  Vector mutated(Vector individual, double amount, Random& random) const;
  Vector crossed(const Vector& a, const Vector& b, Random& random) const;
  std::vector<std::size_t> parents() const;

  std::vector<Axis> axes_;
  std::vector<bool> held_;
  std::uint64_t seed_;
  std::uint64_t operations_ = 0;
  std::vector<Generation> history_;
  std::size_t at_ = 0;  // index of the current generation
};

}  // namespace limber::experiments
