// Hashes of node values, for the state hash. A value at its default adds nothing, and the position of a property in its
// table does not matter, so a new property does not change existing hashes. [sim]
#pragma once

#include <cstdint>
#include <string_view>

#include "properties/store.h"

namespace limber {

/// Returns the hash of the numbers of a node's persistent or transient block that differ from their defaults; 0 if
/// none differs. `numbers` has an entry for each number.
std::uint64_t values_hash(std::span<const HashedNumber> numbers, const double* block);
/// Returns the hash of a node's persistent values; 0: all are at their defaults.
std::uint64_t persistent_hash(const Store& store, NodeId id);
/// Returns the hash of a node's settings, states and hashed readouts.
std::uint64_t node_hash(const Store& store, NodeId id);
/// Returns the hash of the persistent values of a node that every world has, such as the camera, mixed with its class
/// name, so that the hashes of several nodes can be added. 0: all values are at their defaults, so a new class of such
/// nodes does not change existing hashes.
std::uint64_t fixed_node_hash(const Store& store, NodeId id);
/// The same for these persistent values of a node with this table.
std::uint64_t fixed_node_hash(const PropertyTable& table, const double* persistent);

}  // namespace limber
