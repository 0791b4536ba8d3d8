// Rebuild: replaces a body, with its state, gears and tendons.
#include "sim/state/rebuild.h"

#include <utility>

#include "base/check.h"
#include "sim/gears/gear_list.h"
#include "sim/state/body_state.h"
#include "sim/tendons/tendon_list.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

Body& rebuild_body(World& world, Body& body, const Body& blueprint, const std::vector<bool>& joints_to_reset) {
  const BodyState state(body);
  std::vector<GearList::Detached> gears = world.gears().detach(body);
  std::vector<TendonList::Detached> tendons = world.tendons().detach(body);
  world.remove_body(body);
  const Result<Body*> copied = world.copy_body(blueprint, blueprint.name());
  LIMBER_CHECK(copied.ok());
  Body& replacement = **copied;
  // in the poses of the blueprint, not in those restored below
  replacement.recovery().save_new_start_pose();
  replacement.pairs().find_new_overlaps(world.overlaps());
  replacement.recovery().save_start_pose(blueprint);
  state.apply_to(replacement, joints_to_reset);
  world.gears().attach(std::move(gears), replacement);
  world.tendons().attach(std::move(tendons), replacement);
  return replacement;
}

void flush_detached(World& world) {
  world.store().flush();
  for (const auto& body : world.bodies()) body->update_moved_joints();
}

}  // namespace limber::sim
