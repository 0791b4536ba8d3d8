// The rows of the behavior list: one entry per behavior name, even if several bodies have that behavior; group
// behaviors first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/output/value_snapshot.h"

namespace limber::panel {

/// One line of the list.
struct BehaviorEntry {
  std::string name;
  std::string pattern;  ///< Address pattern that matches all of them: "/physics/body/*/behavior/bend".
  std::string type;     ///< Name of its class.
  bool group = false;
  std::vector<std::uint32_t> nodes;

  // Updated from each value snapshot.
  int active = 0;     ///< Number of active ones.
  double time = 0;    ///< Total time of the last tick, µs.
  int position = 0;   ///< Position of the first one in its body's order; for a group, in the order of groups.
  std::string error;  ///< Reason why one is disabled; empty if none is.
};

/// Returns the entries of all bodies, or of the one with this node (0: all). In the list of all bodies, behaviors that
/// a group created are represented by the group.
std::vector<BehaviorEntry> behavior_entries(const TreeSnapshot& tree, std::uint32_t body);
/// Updates the state of an entry from a value snapshot.
void update_entry(const engine::ValueSnapshot& snapshot, BehaviorEntry& entry);
/// Sorts the entries by their execution order.
void sort_entries(std::vector<BehaviorEntry>& entries);
/// Returns the messages that move an entry just past its neighbor in the execution order, upwards or downwards. A
/// single message for all bodies if the position is the same on all of them, otherwise one for each.
std::vector<Message> move_past(const engine::ValueSnapshot& snapshot, const BehaviorEntry& entry,
                               const BehaviorEntry& neighbor);

}  // namespace limber::panel
