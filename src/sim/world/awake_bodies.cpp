// AwakeBodies: the list of awake bodies, and the loop over it.
#include "sim/world/awake_bodies.h"

#include "base/threads/thread_pool.h"
#include "sim/bullet/island_world.h"
#include "sim/world/body.h"
#include "sim/world/stability.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {
/// Bodies per task of the parallel loop; has no influence on the result.
constexpr int kBodiesPerTask = 4;
}  // namespace

void AwakeBodies::publish() {
  const bullet::SleepTracker& sleep = world_.bullet().sleep();
  const bool is_valid = sleep_version_ == sleep.version() && structure_version_ == world_.store().structure_version();
  if (!is_valid) {
    bodies_.clear();
    for (const auto& body : world_.bodies()) bodies_.push_back(body.get());
  }
  const auto publish_range = [&](int, int first, int end) {
    for (int i = first; i < end; i++) {
      Body& body = *bodies_[static_cast<std::size_t>(i)];
      if (body.in_world()) body.publish();
    }
  };
  parallel_for_ranges(world_.thread_pool(), static_cast<int>(bodies_.size()), publish_range, kBodiesPerTask);
  for (Body* const body : bodies_) {
    body->warnings().log();
    world_.stability().check_joints(*body);
  }
  if (is_valid) return;
  std::erase_if(bodies_, [](const Body* body) { return body->asleep(); });
  sleep_version_ = sleep.version();
  structure_version_ = world_.store().structure_version();
}

}  // namespace limber::sim
