// `limber describe`: every address with type, unit, range, default and meaning, derived from the tables.
#pragma once

#include <string>
#include <vector>

#include "engine/dispatch.h"

namespace limber {

/// Without a scene the classes' addresses with <name> where a name stands; with one, those of every thing it has.
/// Returns the exit code. [main]
int describe_command(const std::string& scene, bool json);

/// The classes that have rows, and what is answered beside them. [any]
std::vector<const Table*> described_classes();
std::vector<Irregular> described_messages();

/// The text without a scene: what the golden file holds. [any]
std::string describe_classes();

}  // namespace limber
