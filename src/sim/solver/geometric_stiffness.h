// Geometric stiffness of joints that pull at a body (Andrews, Teichmann and Kry, Geometric stiffness for real-time
// constrained multibody dynamics, 2017).
#pragma once

#include "sim/solver/forest/forest.h"
#include "sim/solver/island.h"

namespace limber {

/// A body that a joint pulls at with force f at arm r behaves like a pendulum with stiffness f·r against rotation. The
/// explicit step is unstable if it is large, as for the light links of a rope with a heavy end. Increases the node's
/// rotational inertia until it is stable. `links`: the body's joints. Not for bodies on which motors, gears or contacts
/// act: these would do work as the inertia changes. [sim]
void add_geometric_inertia(TreeNode& node, const Island& island, int body, IndexedSpan<const int> links);

}  // namespace limber
