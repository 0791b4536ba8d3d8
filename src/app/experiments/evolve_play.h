// `limber evolve --play`: plays an elite of a search, with the others as presets. [main]
#pragma once

#include <cstdint>
#include <string>

#include "app/experiments/archive.h"
#include "app/show/play.h"
#include "base/result.h"

namespace limber::app {

/// The content of state.json.
struct SavedSearch {
  std::string record;  ///< SearchRecord::text()
  std::string scene_path;
  std::uint64_t failures = 0;
  std::string state;  ///< Search::save()
};

/// Reads state.json of the folder. Errors name the file.
Result<SavedSearch> read_search(const Archive& archive);

struct PlayEliteCommand {
  std::string folder;
  std::string elite;  ///< Its number or its name in elites.csv; empty: the best.
  PlayOptions play;   ///< More options of `limber play`.
};
/// Plays. Returns as play_command().
int play_elite_command(const PlayEliteCommand& command);

}  // namespace limber::app
