// Selects the parts that a view frames, and encloses them with spheres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/output/snapshot.h"
#include "properties/tree_snapshot.h"
#include "sim/visuals/framing.h"

namespace limber::app {

/// Returns the parts of the object with this address, as offsets in Snapshot::transient: a part, the parts of a body,
/// or those of the body to which a joint, a motor or a behavior belongs. A pattern selects several objects.
std::vector<std::uint32_t> parts_of(const TreeSnapshot& tree, const std::string& address);

/// Returns spheres around the visible shapes of all parts.
std::vector<sim::FramedSphere> spheres_of_all(const engine::Snapshot& snapshot);
/// Returns spheres around the visible shapes of these parts.
std::vector<sim::FramedSphere> spheres_of(const engine::Snapshot& snapshot, const std::vector<std::uint32_t>& parts);

}  // namespace limber::app
