// NeighborBehavior: base class of behaviors that react to neighbors. Computes the means over the neighbors of each
// part once for all members of a group. [sim]
#pragma once

#include <span>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/neighbors/neighbor_set.h"
#include "sim/world/force_accumulators.h"

namespace limber::sim {

class NeighborBehavior : public Behavior {
 public:
  void step(double dt) final;
  void step_group(std::span<Behavior* const> members, double dt) final;

 protected:
  /// The first two parameters of each such type: neighbors are between these distances. All parameters must be single
  /// numbers.
  enum Range : std::uint32_t { min_dist, max_dist, first_specific };
  /// Which means it needs: a combination of kWantVelocity and kWantPush.
  virtual unsigned needed_means() const = 0;
  /// The input for one member's apply().
  struct MemberInput {
    const double* values;  ///< values of its parameters
    std::span<Part* const> parts;
    const NeighborMeans* means;  ///< one per part; the count is 0 if there are no neighbors
    double dt;                   ///< s
    ForceAccumulators& accumulators;
    const std::uint32_t* wrench_indices;
    const double* persistent;
    const std::uint32_t* mass_indices;
    const double* min_inertias;

    /// The force accumulator of the i-th part.
    ForceAccumulators::Wrench& wrench(std::size_t i) const { return accumulators.wrench(wrench_indices[i]); }
    double mass(std::size_t i) const { return persistent[mass_indices[i]]; }
    /// Least principal moment of the i-th part, kg·m².
    double min_inertia(std::size_t i) const { return min_inertias[i] * mass(i); }
  };
  virtual void apply(const MemberInput& member) const = 0;

 private:
  void step_members(std::span<const std::uint32_t> indices, double dt);
  void step_same_range(std::span<const std::uint32_t> indices, double dt);

  // scratch buffers of the member that step_group() is called on
  std::vector<std::uint32_t> sorted_;
  std::vector<Part*> queried_;
};

}  // namespace limber::sim
