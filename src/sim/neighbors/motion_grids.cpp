// MotionGrids: chooses grids, and copies motions into their order.
#include "sim/neighbors/motion_grids.h"

#include <utility>

#include "sim/bullet/simd.h"

namespace limber::sim {

void MotionGrids::begin_tick() {
  velocities_gathered_ = false;
  for (const auto& grid : grids_) grid->used = false;
}

MotionGrids::Grid& MotionGrids::find(float search_radius) {
  Grid* unused = nullptr;
  for (const auto& grid : grids_) {
    const float grid_radius = grid->grid.search_radius();
    if (grid->used && grid_radius >= search_radius && (grid_radius == search_radius || grid_radius < 2 * search_radius))
      return *grid;
    if (!grid->used && (unused == nullptr || grid_radius == search_radius)) unused = grid.get();
  }
  if (unused == nullptr) {
    grids_.push_back(std::make_unique<Grid>());
    unused = grids_.back().get();
  }
  unused->grid.build(cloud_.points(), search_radius);
  unused->used = true;
  unused->filled = 0;
  return *unused;
}

void MotionGrids::gather_velocities() {
  if (std::exchange(velocities_gathered_, true)) return;
  velocities_.resize(cloud_.size());
  for (std::size_t i = 0; i < velocities_.size(); i++) {
    const PartData& part = cloud_.data(cloud_.point_parts()[i]);
    put(velocities_[i].velocity, cloud_.velocity_of(part));
    put(velocities_[i].angular_velocity, cloud_.angular_velocity_of(part));
  }
}

void MotionGrids::fill_motions(Grid& grid, bool velocities) {
  const unsigned fill = velocities ? 3 : 1;
  if ((grid.filled & fill) == fill) return;
  grid.filled = fill;
  if (velocities) gather_velocities();
  const PointCloud& points = cloud_.points();
  const std::span<const std::uint32_t> order = grid.grid.order();
  grid.motions.resize(order.size());
  for (std::size_t k = 0; k < order.size(); k++) {
    NeighborMotion& motion = grid.motions[k];
    const std::uint32_t i = order[k];
    if (velocities) {
      bullet::store(motion.velocity, bullet::load(velocities_[i].velocity));
      bullet::store(motion.angular_velocity, bullet::load(velocities_[i].angular_velocity));
    }
    motion.position[0] = points.x[i];
    motion.position[1] = points.y[i];
    motion.position[2] = points.z[i];
    motion.position[3] = 1;
  }
}

}  // namespace limber::sim
