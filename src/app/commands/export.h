// `limber export`: exports a take as motion for other programs: CSV, BVH, glTF.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limber {

/// Options of `export`, as typed.
struct ExportCommand {
  std::string take;
  std::string format;               ///< csv, bvh, gltf; empty: by the extension of `output`.
  std::string output;               ///< Empty: next to the take, with the same name.
  double rate = 60;                 ///< Frames per simulated second.
  std::vector<std::string> bodies;  ///< Names or patterns; empty: all bodies.
  double from = 0;                  ///< Start, in simulated seconds since the beginning of the take.
  std::optional<double> to;         ///< End, in the same unit; nullopt: the end of the take.
  bool overwrite = false;
};

/// Replays the take at full speed. Returns the exit code: 1 if the file is not a take or the replay diverged from the
/// recording (the output is written anyway); 3 if writing failed. Ctrl+C leaves no file behind. [main]
int export_command(const ExportCommand& command);
/// Like export_command(); `cancel` is called before each tick and returns true to stop.
int export_take(const ExportCommand& command, const std::function<bool()>& cancel);

}  // namespace limber
