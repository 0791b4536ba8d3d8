// `limber play`: a scene, its OSC, a status line a second, until it ends or somebody ends it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/picture_options.h"

namespace limber {

/// What becomes of messages.
struct LogOptions {
  std::string file;  ///< Empty: none.
  double megabytes = 10;
  int kept = 5;  ///< Old log files.
  bool quiet = false;
};

/// The command line of `play`, as it was typed.
struct PlayOptions {
  std::string scene = "scripts/arms.lua";
  bool fast = false;
  bool hash = false;
  bool strict = false;
  bool watch = false;  ///< Watch the scene's files under `fast` too.
  std::optional<std::uint64_t> ticks;
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  int threads = 1;                ///< That solve islands of bodies side by side.
  std::vector<std::string> sets;  ///< PATH=VALUE
  std::string preset;             ///< Recalled after the scene ran, before the sets.
  std::vector<std::string> package_paths;
  std::string osc_in;  ///< Empty: not given.
  std::string osc_allow;
  std::vector<std::string> osc_out;
  bool osc_optional = false;
  std::string query;  ///< Empty: not given.
  std::vector<std::string> query_names;
  bool recover = false;          ///< Begin with what a run that did not end well has left.
  std::string record;            ///< A take goes there.
  std::string replay;            ///< This take is played.
  bool current_scripts = false;  ///< A replay with the scripts of today.
  LogOptions log;
  PictureOptions picture;
};

/// Plays; returns the exit code of product.md: 0 fine, 1 the input, 2 usage, 3 the machine. [main]
int play_command(const PlayOptions& options);

}  // namespace limber
