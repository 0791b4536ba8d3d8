// NeighborSet: parts that others look for near themselves: gathered once a tick, found through one grid for each
// distance, whoever asks. Built-in group behaviours take means over neighbours; Lua takes the neighbours. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"
#include "sim/neighbor_lists.h"
#include "sim/neighbor_sums.h"
#include "sim/point_grid.h"

namespace limber {

class Body;
class Part;
class World;

/// A part near another.
struct Neighbor {
  std::uint32_t index = 0;  ///< In the set's parts.
  Vec3 offset{0};           ///< From centre of mass to centre of mass, m.
  double distance = 0;
};

/// Means over a part's neighbours: those of other bodies within two distances. All zero where there is none.
struct NeighborMeans {
  std::uint32_t count = 0;
  float offset[3] = {};    ///< Mean of the offsets, m.
  float velocity[3] = {};  ///< Mean of their velocities less the own, m/s.
  float spin[3] = {};      ///< The same of angular velocities, rad/s.
  float push[3] = {};      ///< Mean of unit vectors to them times 1 − distance/most.
};

/// What of the means is wanted beside count and offset, as bits.
inline constexpr unsigned kWantVelocity = 1;
inline constexpr unsigned kWantPush = 2;

class NeighborSet {
 public:
  /// In stream order, each once.
  NeighborSet(World& world, std::vector<Part*> parts);
  NeighborSet(const NeighborSet&) = delete;
  NeighborSet& operator=(const NeighborSet&) = delete;

  std::span<Part* const> parts() const { return parts_; }
  /// Whether it is of exactly these parts, not only of others that now lie where they lay.
  bool holds(std::span<Part* const> parts) const;

  /// Means for each of `of`, which need not be in the set, over neighbours with least <= distance <= most (m); valid
  /// until the next call. Who asks for the same in one tick gets the same without more work. Where `most` covers all,
  /// it costs no more than the number of parts.
  std::span<const NeighborMeans> means(std::span<Part* const> of, double least, double most, unsigned want);
  /// Means for one part, which need not be in the set. Where it is, all parts of the set are answered when the first
  /// asks in a tick. `least` below 0 is 0. Valid until the next call.
  const NeighborMeans& means_near(const Part& of, double least, double most, unsigned want);
  /// Where in parts() the part of a slot is; -1: nowhere. What means_near tells of one part of the set it has told of
  /// all: theirs stand before and behind in that order, and stay as long as the tick and the set.
  std::span<const std::int32_t> numbers() const { return numbers_; }
  /// All within `radius` of a part, in the order of parts().
  void near(const Part& of, double radius, std::vector<Neighbor>& out);
  /// A body's parts are passed over from now on: it goes.
  void forget(const Body& body);

 private:
  struct Spot {
    std::uint32_t live = 0;     // a part's live block
    std::uint32_t enabled = 0;  // its body's row
    std::int32_t body = 0;      // slot of its body
    bool centered = true;       // its centre of mass is the link frame's origin
    Vec3 center{0};             // else where it is in the link frame
  };
  struct alignas(32) Moving {  // as in NeighborMotion
    float velocity[4], spin[4];
  };
  struct alignas(16) Push {
    float sum[4];
  };
  struct Grid {
    PointGrid grid;
    bool used = false;                    // in this tick
    unsigned filled = 0;                  // 1: positions, 2: velocities
    std::vector<NeighborMotion> motions;  // in the grid's order
  };
  struct Answer {
    double least = 0, most = 0;
    unsigned want = 0;          // what was computed
    unsigned asked = 0;         // what of it was asked for in this tick
    unsigned asked_before = 0;  // and in the one before
    bool used = false;          // in this tick
    std::uint64_t structure = 0;
    std::vector<Part*> of;
    std::vector<Spot> spots;
    std::vector<std::uint32_t>
        at;  // where each is in parts_, where they are many of these and in their order; or empty
    std::vector<NeighborMeans> means;
  };
  struct Whole {  // a question that was answered for all parts, and where the answer begins: it stays there in a tick
    double least = 0, most = 0;
    unsigned want = 0;
    const NeighborMeans* means = nullptr;
  };
  struct Totals {
    double count = 0;
    Vec3 position{0}, velocity{0}, spin{0};
  };

  void number_parts();
  std::uint32_t number_of(const Part& part) const;
  Spot spot_of(const Part& part) const;
  Vec3 center_of(const Spot& spot) const;
  void gather();
  void take_question(Answer& answer, std::span<Part* const> of) const;
  bool covers_all(const Answer& answer) const;
  Grid& grid_for(float reach);
  void gather_motions();
  void fill_motions(Grid& grid, unsigned want);
  void answer_by_totals(Answer& answer);
  void answer_by_grid(Answer& answer);
  template <unsigned Want>
  NeighborMeans sum_near(Grid& grid, const Spot& spot, double least, double most);
  /// Each part's neighbours by themselves.
  template <unsigned Want>
  void sum_each(Grid& grid, Answer& answer);
  /// All parts' neighbours, each pair once.
  template <unsigned Want>
  void sum_pairs(Grid& grid, Answer& answer);
  void push_pairs(std::uint32_t place, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                  float inverse_most);
  template <unsigned Want>
  void sum(Grid& grid, Answer& answer);
  NeighborMeans means_of(const NeighborSum& sum, const Push& push, unsigned want, const Spot& spot) const;

  World& world_;
  std::vector<Part*> parts_;
  std::vector<NodeId> ids_;
  std::vector<Spot> spots_;
  std::vector<std::int32_t> numbers_;  // of parts by their slots; -1: not in the set
  std::vector<Vec3> centers_;          // of mass, of the parts whose bodies are in the world
  NeighborLists lists_;
  std::vector<std::int32_t> ordinals_;  // of bodies by their slots; -1: of no part here
  std::int32_t bodies_ = 0;
  std::uint64_t turn_ = 0;              // of the behaviours, that was gathered for
  PointCloud cloud_;                    // parts whose bodies are in the world
  std::vector<std::uint32_t> indices_;  // of the cloud's points in parts_
  std::vector<std::unique_ptr<Grid>> grids_;
  std::vector<Answer> answers_;
  std::vector<Whole> wholes_;         // of this tick
  NeighborMeans alone_;               // of one that is not in the set
  std::vector<std::uint32_t> found_;  // scratch
  std::vector<std::uint32_t> place_;  // scratch: in the grid, of parts_
  std::vector<NeighborSum> sums_;     // scratch, by place
  std::vector<Push> pushes_;
  std::vector<Moving> motions_;  // scratch, of the cloud's points: gathered in order, handed out to grids
  bool motions_gathered_ = false;
  std::vector<Totals> of_body_;  // scratch, by ordinal
};

}  // namespace limber
