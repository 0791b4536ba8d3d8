// The measurements of the program limber_measure: what developers need to know about the speed of each module. Each
// returns its results as JSON, with units in the keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace limber {

struct MeasureOptions {
  std::vector<std::string> names;  ///< Measurements to run; empty: all.
  bool compare_raw = false;        ///< Arms: also run the same scene in a plain Bullet loop, interleaved.
  bool json = false;
  int ticks = 0;        ///< Timed ticks; 0: a default for each measurement.
  std::string gl = {};  ///< Kind of OpenGL for rendering, see gl_apis().
};

struct Measure {
  std::string_view name;
  std::string_view doc;  ///< One line.
  nlohmann::ordered_json (*run)(const MeasureOptions& options);
};
const std::vector<Measure>& measures();

/// Formats the results of one measurement as text: one line per number or group of numbers.
std::string text_of(const nlohmann::ordered_json& figures);

/// Prints the results of each measurement to stdout as they arrive (with `json`: one object at the end). Returns the
/// exit code: 2 for an unknown name, else 0. There is no pass or fail for times. [main]
int run_measures(const MeasureOptions& options);

/// `bodies` one-part bodies with about 30 neighbors each: time per tick of cohesion and alignment, and of the whole
/// tick.
nlohmann::ordered_json measure_flock(int bodies, const MeasureOptions& options);

/// 1, 100 and 1000 arms of 17 parts, and 100 arms with forces from Lua: the time of a tick without and with a
/// checkpoint, the memory for 30 s of history, and the time of a rewind by a second.
nlohmann::ordered_json measure_history(const MeasureOptions& options);

/// Each built-in type and its Lua equivalent in behaviors_lua/, on 10 000 parts each, in the same ticks: times and
/// ratio.
nlohmann::ordered_json measure_lua_twin(const MeasureOptions& options);
/// Instances that produce garbage: time of garbage collection per tick.
nlohmann::ordered_json measure_lua_garbage(const MeasureOptions& options);
/// 1000 instances of a small Lua behavior: time of a tick.
nlohmann::ordered_json measure_lua_many(const MeasureOptions& options);

/// Input through receiver, validator, decoder, queue and dispatch to properties: messages per second, single and in
/// bundles; and a burst of 10 000 datagrams through the kernel.
nlohmann::ordered_json measure_osc_in(const MeasureOptions& options);
/// Response times: `/ping`, which the network thread answers, and a value that is set and read back at 60 ticks a
/// second.
nlohmann::ordered_json measure_osc_latency(const MeasureOptions& options);
/// Time that a frame of 1000 bodies in three streams costs the network thread.
nlohmann::ordered_json measure_osc_out(const MeasureOptions& options);

/// Processor time of a frame of the panel with 17 000 parts, without drawing.
nlohmann::ordered_json measure_panel(const MeasureOptions& options);

/// Frames per second without a window: 1000 arms at 1920 × 1080 in high quality, 16 at 640 × 360 in low quality; or an
/// error if OpenGL is missing.
nlohmann::ordered_json measure_picture(const MeasureOptions& options);

/// 1000 arms of 17 parts, each with a joint and a motor: storing and recalling a preset of all properties, the first
/// time and repeatedly, and a morph that changes six properties of every part.
nlohmann::ordered_json measure_preset(const MeasureOptions& options);
/// Time of an evaluation of a policy: an MLP of 48-256-256-12 with three activations, and a GRU of 256.
nlohmann::ordered_json measure_policy(const MeasureOptions& options);

/// 16 arms at 60 ticks a second, alternately without clients and while 100 WebSocket clients listen to 50 changing
/// values each: the processor time of the ticks, and the number of values sent.
nlohmann::ordered_json measure_query(const MeasureOptions& options);

/// A scene of 16 arms and one of 1000, saved repeatedly while they play: the time from the save to the first tick of
/// the new code, and the longest tick near it compared with the median.
nlohmann::ordered_json measure_reload(const MeasureOptions& options);

/// The same mechanisms in stock Bullet and with the direct solver, alternating step by step, `ticks` steps each (0: six
/// simulated seconds): the errors of joints, servos and limits, the time per step, and which solver solved the islands.
nlohmann::ordered_json measure_solver(const MeasureOptions& options);
/// 300 creatures of six parts in a clump, and 2000 boxes that pile up on a floor: stock Bullet with its defaults
/// against Limber's world. `ticks` 0: as many as the creatures need to collide (300) or the boxes to come to rest
/// (400); the second half is timed.
nlohmann::ordered_json measure_swarm(const MeasureOptions& options);
nlohmann::ordered_json measure_pile(const MeasureOptions& options);

/// Imports urdf/arm17.urdf, builds it, copies it 1000 times to different positions, and runs the first tick.
nlohmann::ordered_json measure_spawn(const MeasureOptions& options);

/// 16 arms of 17 parts and 17 one-number messages per tick (1000 a second): the cost of recording per tick and on disk,
/// and the processor time of a replay compared with that of the show.
nlohmann::ordered_json measure_take(const MeasureOptions& options);

/// Ticks the same arms with one thread and with two, alternating in 15 pairs of several ticks: both times, their ratio,
/// and whether the states are identical.
nlohmann::ordered_json measure_terrain(const MeasureOptions& options);
nlohmann::ordered_json measure_threads(const MeasureOptions& options);

}  // namespace limber
