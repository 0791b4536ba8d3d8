// Hashes of nodes' values, for the state hash: a value at its default adds nothing, and the place of a property in its
// table does not matter, so that a new property leaves the hashes of before as they are. [sim]
#pragma once

#include <cstdint>
#include <string_view>

#include "params/store.h"

namespace limber {

/// Of the numbers of a kept or live block that differ from their defaults; 0: none does.
std::uint64_t values_hash(std::span<const HashedNumber> plan, const double* block);
/// Of a node's properties; 0: all are at their defaults.
std::uint64_t kept_hash(const Store& store, NodeId id);
/// Of a node's properties, states and hashed readouts.
std::uint64_t node_hash(const Store& store, NodeId id);
/// Of the properties of a node that every world has, such as the camera, for a sum of several; 0: all are at their
/// defaults, so that a class of its kind that is new adds nothing.
std::uint64_t fixed_node_hash(const Store& store, NodeId id);

}  // namespace limber
