// `limber bench`: measures the speed on this machine, scene by scene, optionally next to a plain Bullet loop.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace limber {

struct BenchOptions {
  std::vector<std::string> scenes;  ///< Names; empty: all.
  bool compare_raw = false;         ///< Arms: also run the same scene in a plain Bullet loop, interleaved.
  bool json = false;
  int ticks = 0;        ///< Timed ticks per scene; 0: a default for each scene.
  std::string gl = {};  ///< Kind of OpenGL for rendering, see gl_apis().
};

/// One benchmark scene. `run` returns the results as JSON, with units in the keys.
struct BenchScene {
  std::string_view name;
  std::string_view doc;  ///< One line.
  nlohmann::ordered_json (*run)(const BenchOptions& options);
};
const std::vector<BenchScene>& bench_scenes();

/// Returns "arms-1,arms-16,…", for help texts.
std::string bench_scene_list();

/// Prints the results of each scene to stdout as they arrive (with `json`: one object at the end). Returns the exit
/// code: 2 for an unknown scene, else 0. There is no pass or fail for times. [main]
int bench_command(const BenchOptions& options);

/// Formats the results of one scene as text: one line per number or group of numbers.
std::string bench_text(const nlohmann::ordered_json& figures);

}  // namespace limber
