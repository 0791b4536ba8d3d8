// The hash of a body's state, as a part of World::state_hash(). [sim]
#pragma once

#include <cstdint>

namespace limber::sim {

class Body;

/// Returns a hash of the body's name, poses, velocities and persistent values, bit for bit, and of `start`.
std::uint64_t body_hash(const Body& body, std::uint64_t start);

}  // namespace limber::sim
