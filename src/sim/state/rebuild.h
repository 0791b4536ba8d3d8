// Rebuild: replaces a body of a running world by that of a reloaded scene. [sim]
#pragma once

#include <vector>

namespace limber::sim {

class Body;
class World;

/// Replaces `body` by a copy of `blueprint`, which may be of another world. The new body gets the pose of the old one,
/// and the positions and velocities of the joints that both have, except joints flagged in `joints_to_reset`. Unchanged
/// state is preserved bit for bit. The start pose is that of `blueprint`. Gears on its joints and tendons through its
/// parts are attached to the joints and parts of the same name of the new body, if these exist.
Body& rebuild_body(World& world, Body& body, const Body& blueprint, const std::vector<bool>& joints_to_reset);

/// Applies pending property changes without adding bodies to Bullet's world: for a world that only describes a scene
/// and is never stepped.
void flush_detached(World& world);

}  // namespace limber::sim
