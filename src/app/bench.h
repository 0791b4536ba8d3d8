// `limber bench`: how fast it is on this machine, scene by scene, beside a bare Bullet loop where that makes sense.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace limber {

struct BenchOptions {
  std::vector<std::string> scenes;  ///< Names; empty: all.
  bool compare_raw = false;         ///< Arms: the same in a bare Bullet loop, interleaved.
  bool json = false;
  int ticks = 0;        ///< Timed ticks of a scene; 0: chosen for each.
  std::string gl = {};  ///< Kind of OpenGL of the picture, see gl_apis().
};

/// A scene of the bench: its figures as JSON, units in the keys.
struct BenchScene {
  std::string_view name;
  std::string_view doc;  ///< One line.
  nlohmann::ordered_json (*run)(const BenchOptions& options);
};
const std::vector<BenchScene>& bench_scenes();

/// "arms-1,arms-16,…", for help.
std::string bench_scene_list();

/// Prints each scene's figures to stdout as they come (with `json`: one object at the end). Returns the exit code: 2
/// for a scene that does not exist, else 0. Nothing here asserts a time. [main]
int bench_command(const BenchOptions& options);

/// The figures of one scene as text: a line for each number or group of numbers.
std::string bench_text(const nlohmann::ordered_json& figures);

}  // namespace limber
