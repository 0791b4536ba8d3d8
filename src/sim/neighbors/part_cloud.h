// PartCloud: centers of mass of a set of parts, gathered from the store once per tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"
#include "sim/neighbors/point_grid.h"

namespace limber::sim {

class Body;
class Part;
class World;

/// Location of a part's values in the store, and its constants. Valid until the world's structure changes.
struct PartData {
  std::uint32_t transient_offset = 0;  ///< Offset of the part's transient values.
  std::uint32_t enabled_offset = 0;    ///< Offset of its body's `enabled`.
  std::int32_t body = 0;               ///< Slot of its body.
  bool centered = true;                ///< The center of mass is the link frame's origin.
  Vec3 center{0};                      ///< Else its position in the link frame.
};

/// The points are the parts with enabled bodies, in the order of the parts. [sim]
class PartCloud {
 public:
  static constexpr std::uint32_t kNoIndex = 0xffffffffu;

  /// `parts`: in stream order, without duplicates.
  PartCloud(World& world, std::vector<Part*> parts);

  std::span<Part* const> parts() const { return parts_; }
  /// True if the set consists of exactly these parts, compared by id, since addresses may be reused.
  bool consists_of(std::span<Part* const> parts) const;
  /// Index in parts(), or kNoIndex.
  std::uint32_t index_of(const Part& part) const;
  /// Index in parts() by the slot of a part, or -1.
  std::span<const std::int32_t> index_of_slot() const { return index_of_slot_; }
  const PartData& data(std::uint32_t index) const { return part_data_[index]; }
  /// Number of bodies that have parts in the set, and the ordinal of a body by its slot; -1: none.
  std::int32_t body_count() const { return body_count_; }
  std::int32_t body_ordinal(std::size_t slot) const { return slot < body_ordinals_.size() ? body_ordinals_[slot] : -1; }
  /// Removes the parts of a body; call before the body is destroyed.
  void remove_body(const Body& body);

  /// Gathers the points. Returns false if they are those of this tick already.
  bool gather();
  const PointCloud& points() const { return points_; }
  std::size_t size() const { return points_.size(); }
  /// Index in parts() of each point.
  std::span<const std::uint32_t> point_parts() const { return point_parts_; }
  /// Center of mass of a part whose body is enabled, by its index in parts().
  const Vec3& center(std::uint32_t index) const { return centers_[index]; }

  // Of any part, as last published.
  PartData data_of(const Part& part) const;
  bool enabled(const PartData& data) const;
  Vec3 center_of(const PartData& data) const;
  Vec3 velocity_of(const PartData& data) const;
  Vec3 angular_velocity_of(const PartData& data) const;

 private:
  void index_parts();

  World& world_;
  std::vector<Part*> parts_;
  std::vector<NodeId> ids_;
  std::vector<PartData> part_data_;
  std::vector<std::int32_t> index_of_slot_;
  std::vector<std::int32_t> body_ordinals_;
  std::int32_t body_count_ = 0;
  std::uint64_t gathered_step_ = 0;  // BehaviorList::step_count() at the last gather()
  PointCloud points_;
  std::vector<std::uint32_t> point_parts_;
  std::vector<Vec3> centers_;
};

}  // namespace limber::sim
