// The behaviours of a scene as people know them: one entry a name, whichever bodies have it; groups first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/image.h"

namespace limber {

struct BehaviorEntry {
  std::string name;
  std::string pattern;  ///< Address that reaches all of them: "/physics/body/*/behavior/bend".
  std::string type;     ///< As its class is called.
  bool group = false;
  std::vector<std::uint32_t> nodes;

  // of an image
  int active = 0;     ///< How many act.
  double time = 0;    ///< µs of the last tick, of all.
  int place = 0;      ///< The first one's among those that act on its body; a group's among names.
  std::string error;  ///< Why one rests; empty: none does.
};

/// Of all bodies, or of the one of that node alone (0: all). What groups made is theirs, not the bodies'.
std::vector<BehaviorEntry> behavior_entries(const Tree& tree, std::uint32_t body);
/// Fills in what the image says of it.
void renew_entry(const Image& image, BehaviorEntry& entry);
/// In the order in which they act, as far as they were filled in.
void order_entries(std::vector<BehaviorEntry>& entries);
/// What lets an entry act right before or behind its neighbour in such a list, whichever of the two comes first: one
/// message for all bodies where all have it at the same place, else one for each.
std::vector<Message> put_past(const Image& image, const BehaviorEntry& entry, const BehaviorEntry& neighbor);

}  // namespace limber
