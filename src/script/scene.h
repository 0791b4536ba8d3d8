// Scene: a Lua file that says what exists, and its callbacks that act. Made anew for each run. [sim]
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
#include "script/host.h"
#include "script/run_inputs.h"
#include "script/scene_options.h"

namespace limber {

class Sources;
class World;
class CallLedger;
class EarlierRuns;
class HandleNames;
class Vm;
struct ScriptContext;

/// A place in a script.
struct ScriptPlace {
  std::string file;
  int line = 0;
};

/// What a save has left of the scheduled calls of the runs before.
struct KeptTimers {
  std::uint64_t timers = 0;     ///< That callbacks have set, and that go on.
  std::uint64_t repeating = 0;  ///< Those of them without an end.
  std::uint64_t ended = 0;      ///< Ended now, because too many runs had some.
  std::uint64_t handlers = 0;   ///< Registered in callbacks (osc:on, sim:on_step, sim:on_contact), ended now.
};

class Scene {
 public:
  /// World and host outlive the scene. What a scene made in the world stays when the scene goes, but its parameters.
  /// Live when that is wanted and no other scene of the process is: only one can run compiled.
  Scene(World& world, ScriptHost& host, SceneOptions options, VmMode wanted = VmMode::live);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Runs the file: the top level. The error has file:line: what, the source line and the traceback. Once only.
  /// `beside`: the run is one beside a show, which hears nothing of it, and may read that much of the show; on any
  /// thread, in a world of its own.
  Result<void> run(const std::string& file, const RunInputs* beside = nullptr);
  /// Where the run failed: the file as messages show it, the line or 0.
  const ScriptPlace& fault() const { return fault_; }
  /// What the run has read so far.
  std::shared_ptr<const Sources> sources() const;
  /// From here on guarded calls are counted there; it outlives the scene. [sim]
  void count_calls(CallLedger& calls);
  /// A take has ended: what scripts may take from here on. [sim]
  void limit(const ScriptLimits& limits);
  /// The callbacks of on_start; the world is settled before.
  void start();
  /// Timers, contacts of the tick before, on_step with `dt` seconds, each in the order of registration.
  void tick(double dt);
  /// Whether any osc:on handler is registered.
  bool listens() const;
  /// Handlers that failed or were stopped: they are disabled until the next good run of the scene.
  std::size_t disabled_handlers() const;
  /// Calls the osc:on handlers that fit, in order of registration; false when none does.
  bool message(const Message& message, const Origin& origin);
  /// After each tick: about 100 µs at most, nothing while there is little to collect.
  void collect_garbage();
  /// While `on`, what was done once is done again: nothing is stopped but what the ledger forbids. [sim]
  void do_again(bool on);
  VmMode mode() const;
  /// Draft to live: once the other scene has gone, or was disarmed; false while it has not.
  bool arm();
  void disarm();
  /// A world's hash with the bits of the scene's generator and parameters.
  std::uint64_t state_hash(std::uint64_t start) const;

  /// What a run beside this show may read of it.
  RunInputs inputs();
  /// After a good run beside the show, still on its thread: what takes long of becoming the show.
  void prepare();
  /// Before things are made again for a run that becomes the show: notes the handles of functions that go on.
  void note_things();
  /// The run beside the show `before` (null: there was none) becomes the show: its handles are given the ids that
  /// things have in `world`; parameters, `state` and the beat of timers are handed over. Where callbacks of `before`
  /// have set timers, these go on with its functions and variables. The answer: rows of the parameters that start at
  /// their defaults again. `before` may then be destroyed on any thread.
  std::uint64_t become_live(World& world, const std::function<NodeId(NodeId)>& live_id, Scene* before);
  /// What become_live() has kept of the runs before.
  const KeptTimers& kept() const { return kept_; }
  /// Runs whose timers had all ended before that tick are released: nothing goes back to it. [sim]
  void release_ended(std::uint64_t before_tick);
  /// The node of the scene's parameters, or a null id.
  NodeId params() const;
  /// Values of the parameters with `rerun`, one after the other.
  void rerun_values(std::vector<double>& out) const;

  /// Runs a text in the scene's environment, as a callback: an expression has a value, statements have none.
  Evaluation evaluate(std::string_view text);
  /// The names that may stand at the end of a half-written text: globals, members, and inside quotes names of things.
  /// Runs nothing of the scene's.
  Evaluation complete(std::string_view text);
  /// Every name that a scene sees, one a line: globals, library.member, thing.member, thing:method.
  std::string names();
  /// The folder that the scene's show lives in.
  const std::string& show_folder() const;

 private:
  friend class SceneKey;
  void keep_run(Scene& before);
  std::unique_ptr<EarlierRuns> earlier_;
  std::unique_ptr<ScriptContext> context_;
  std::unique_ptr<Vm> vm_;
  ScriptPlace fault_;
  std::uint64_t run_number_ = 1;
  KeptTimers kept_;
  std::unique_ptr<HandleNames> names_;  // from note_things() to become_live(), where the run is kept
};

}  // namespace limber
