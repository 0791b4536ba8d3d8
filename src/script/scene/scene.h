// Scene: runs a Lua file, which creates the objects, and its callbacks. A new one is created for each run. [sim]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/evaluation.h"
#include "base/id.h"
#include "base/message.h"
#include "base/result.h"
#include "script/scene/run_inputs.h"
#include "script/scene/run_output.h"
#include "script/scene/scene_options.h"
#include "script/scene/script_host.h"

namespace limber::sim {
class World;
}  // namespace limber::sim

namespace limber::script {

class Sources;
class CallLog;
class EarlierRuns;
class HandleNames;
class Vm;
struct ScriptContext;

/// Source location in a script.
struct ScriptPlace {
  std::string file;
  int line = 0;
};

/// Timers and handlers of replaced runs, counted when a run goes live.
struct CarriedTimers {
  std::uint64_t timers = 0;     ///< Timers set by callbacks that continue.
  std::uint64_t repeating = 0;  ///< Number of these that repeat.
  std::uint64_t ended = 0;      ///< Timers ended because there were too many earlier runs.
  std::uint64_t handlers = 0;   ///< Handlers of callbacks (osc:on, sim:on_step, sim:on_contact) that were removed.
};

class Scene {
 public:
  /// World and host outlive the scene. Objects that a scene created in the world stay when the scene is destroyed,
  /// except its parameters. The mode is `compiled` only if it is `wanted` and no other scene of the process has it.
  Scene(sim::World& world, ScriptHost& host, SceneOptions options, VmMode wanted = VmMode::compiled);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Runs the file's top level; once only. The error has "file:line: message", the source line and the traceback.
  /// `detached`: makes it a detached run, on any thread and in a world of its own, which may read these data of the
  /// live scene and does not affect it.
  Result<void> run(const std::string& file, const RunInputs* detached = nullptr);
  /// Place of the error in a failed run: the file as messages show it, the line or 0.
  const ScriptPlace& fault() const { return fault_; }
  /// The files that the run has read so far.
  std::shared_ptr<const Sources> sources() const;
  /// Counts guarded calls in `calls` from now on; it outlives the scene. [sim]
  void set_call_log(CallLog& calls);
  /// Sets new limits, after a take has ended. [sim]
  void set_limits(const ScriptLimits& limits);
  /// Runs the on_start callbacks. The world must be flushed before.
  void start();
  /// Runs timers, contacts of the previous tick and on_step with `dt` seconds, each in the order of registration.
  void tick(double dt);
  /// True if any osc:on handler is registered.
  bool has_handlers() const;
  /// Number of handlers that failed or were stopped; they are disabled until the next successful run of the scene.
  std::size_t disabled_handlers() const;
  /// Calls the functions of all results, in the order of their declaration, and returns the results. They may change
  /// the world, so compute the state hash before.
  const std::vector<SceneResult>& compute_results();
  /// The declared results and columns.
  RunOutput& output();
  /// Calls the matching osc:on handlers in the order of registration; false if there is none.
  bool handle_message(const Message& message, const CommandOrigin& origin);
  /// Collects garbage after a tick: about 100 µs at most; does nothing if there is little garbage.
  void collect_garbage();
  /// While `on`, a rewind simulates recorded passes again: only the calls that the log lists are stopped. [sim]
  void set_resimulating(bool on);
  VmMode mode() const;
  /// Enables the JIT compiler. Returns false while another scene has it.
  bool enable_jit();
  void disable_jit();
  /// Returns a world's hash continued with the scene's generators and parameters.
  std::uint64_t state_hash(std::uint64_t start) const;

  /// Returns the data that a detached run may read.
  RunInputs inputs();
  /// Prepares a successful detached run for going live. Called on its thread, because it is slow.
  void prepare();
  /// Before objects are rebuilt for a new live run: saves the names behind the handles of callbacks that continue.
  void capture_handles();
  /// Makes this detached run live, replacing `previous` (may be null): maps its handles to the ids in `world`, and
  /// takes over parameters, `state` and the phase of timers. If callbacks of `previous` have set timers, they continue
  /// with its functions and variables. Returns a bit mask of the parameters that start at their defaults again.
  /// `previous` may then be destroyed on any thread.
  std::uint64_t become_live(sim::World& world, const std::function<NodeId(NodeId)>& live_id, Scene* previous);
  /// Timers of earlier runs that become_live() carried over.
  const CarriedTimers& carried_timers() const { return carried_timers_; }
  /// Releases runs in which all timers ended before that tick; no rewind can reach it. [sim]
  void release_ended(std::uint64_t before_tick);
  /// The node of the scene's parameters, or a null id.
  NodeId params() const;
  /// Returns the values of the parameters with `rerun`, concatenated.
  void rerun_values(std::vector<double>& out) const;

  /// Runs text in the scene's environment as a callback. Expressions have a value, statements have none.
  Evaluation evaluate(std::string_view text);
  /// Returns completions for the end of an incomplete text: globals, members, and inside quotes names of objects. Runs
  /// no code of the scene.
  Evaluation complete(std::string_view text);
  /// All names that a scene sees, one per line: globals, library.member, thing.member, thing:method.
  std::string names();
  /// What has state beyond the world's, for SceneCheckpoint.
  struct Components {
    Vm& vm;
    ScriptContext& context;
    EarlierRuns& earlier;
  };
  Components components() { return {*vm_, *context_, *earlier_}; }
  /// The folder that contains the scene's `scripts/`.
  const std::string& show_folder() const;

 private:
  void adopt_run(Scene& previous);
  std::unique_ptr<EarlierRuns> earlier_;
  std::unique_ptr<ScriptContext> context_;
  std::unique_ptr<Vm> vm_;
  ScriptPlace fault_;
  std::uint64_t run_number_ = 1;
  CarriedTimers carried_timers_;
  std::unique_ptr<HandleNames> handle_names_;  // from capture_handles() to become_live(), if the run continues
};

}  // namespace limber::script
