// `limber export`: a take as motion for other programs: CSV, BVH, glTF.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limber {

/// The command line of `export`, as it was typed.
struct ExportCommand {
  std::string take;
  std::string format;               ///< csv, bvh, gltf; empty: what `output` ends with.
  std::string output;               ///< Empty: beside the take, under its name.
  double rate = 60;                 ///< Frames a simulated second.
  std::vector<std::string> bodies;  ///< Names or patterns; none: all.
  double from = 0;                  ///< Simulated seconds since the take's start.
  std::optional<double> to;         ///< Its end, when it is left out.
  bool overwrite = false;
};

/// Replays the take as fast as it goes. An exit code: 1 for a take that is none, or that did not play as it was
/// recorded (then the file is there all the same); 3 for a disk that takes no more. Ctrl+C leaves nothing. [main]
int export_command(const ExportCommand& command);
/// The same; `cancel` is asked before each tick.
int export_take(const ExportCommand& command, const std::function<bool()>& cancel);

}  // namespace limber
