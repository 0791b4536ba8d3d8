// NeighborBehavior: what behaviours that look at neighbours have in common: means over the neighbours of each own part,
// taken once for all members of a group. [sim]
#pragma once

#include <span>
#include <vector>

#include "sim/behavior.h"
#include "sim/neighbors.h"
#include "sim/part_loads.h"

namespace limber {

class NeighborBehavior : public Behavior {
 public:
  void step(double dt) final;
  void step_group(std::span<Behavior* const> members, double dt) final;

 protected:
  /// Its first two parameters, of every such type: neighbours are from the one to the other distance away. All
  /// parameters are single numbers.
  enum Range : std::uint32_t { min_dist, max_dist, first_own };
  /// What of the means it wants (kWantVelocity, kWantPush).
  virtual unsigned wants() const = 0;
  /// A member with all that acting takes.
  struct Share {
    const double* values;  ///< Its parameters.
    std::span<Part* const> parts;
    const NeighborMeans* means;  ///< One for each part, with a count of 0 where there is no neighbour.
    double dt;                   ///< s
    PartLoads& loads;
    const std::uint32_t* load_places;
    const double* kept;
    const std::uint32_t* mass_places;
    const double* least_inertias;

    /// Where forces and torques on the i-th part add up.
    PartLoads::Load& load(std::size_t i) const { return loads.load(load_places[i]); }
    double mass(std::size_t i) const { return kept[mass_places[i]]; }
    /// Its least principal moment, kg·m².
    double least_inertia(std::size_t i) const { return least_inertias[i] * mass(i); }
  };
  virtual void act(const Share& share) const = 0;

 private:
  void step_members(std::span<const std::uint32_t> numbers, double dt);
  void step_alike(std::span<const std::uint32_t> numbers, double dt);

  // scratch of the member that speaks for all
  std::vector<std::uint32_t> sorted_;
  std::vector<Part*> asking_;
};

}  // namespace limber
