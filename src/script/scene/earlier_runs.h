// EarlierRuns: runs of a scene that a reload has replaced. Timers set by their callbacks continue, each in its own Lua
// state with its functions and variables. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/id.h"
#include "script/vm/limits.h"

namespace limber {
class Store;
}  // namespace limber

namespace limber::script {

class Vm;
struct ScriptContext;

/// Names of the objects that a Lua state's handles refer to, saved while objects are rebuilt.
class HandleNames {
 public:
  /// Before the rebuild: saves the name of each existing object. Uses the handles collected in the context.
  void capture(const ScriptContext& context);
  /// After the rebuild: updates each handle to the object of the same name and kind. Handles without one become invalid
  /// permanently.
  void resolve(const ScriptContext& context) const;

 private:
  std::vector<std::string> names_;  // one per handle; empty: the object did not exist
};

class EarlierRuns {
 public:
  /// Maximum number of runs; each has a Lua state of its own.
  static constexpr std::size_t kMaxRuns = 16;

  struct Run {
    Run(std::unique_ptr<ScriptContext> new_context, std::unique_ptr<Vm> new_vm);
    ~Run();
    Run(Run&&) noexcept;
    Run& operator=(Run&&) noexcept;

    std::unique_ptr<ScriptContext> context;
    std::unique_ptr<Vm> vm;
    HandleNames handle_names;
    std::uint64_t number = 0;    ///< Sequence number of the run within the session.
    std::uint64_t timers = 0;    ///< Number of pending timers; 0: the run has ended and exists only for a rewind.
    std::uint64_t ended_at = 0;  ///< Tick in which the last timer ended.
    std::string state;           ///< The scene's `state` after this run's last timer, serialized.
  };

  EarlierRuns();
  ~EarlierRuns();
  EarlierRuns(const EarlierRuns&) = delete;
  EarlierRuns& operator=(const EarlierRuns&) = delete;

  /// Called before objects of the world are rebuilt: saves the names behind the handles.
  void capture_handles();
  /// Called after objects were rebuilt: updates the handles. `params`: node of the live run's parameters, or null.
  void resolve_handles(NodeId params);
  /// Adds a run. Returns the number of timers that ended because there were too many runs.
  std::uint64_t add(Run run);
  /// Runs due timers, oldest run first. `live`: the live run; `state` is shared by all runs.
  void tick(Vm& live, std::uint64_t tick);
  /// Ends the timers that a run's calls have canceled.
  void apply_cancellations(ScriptContext& by, std::uint64_t tick);
  void collect_garbage();
  void set_resimulating(bool on);
  void set_limits(const ScriptLimits& limits);
  /// Returns the hash continued with the runs that have pending timers; unchanged if there are none.
  std::uint64_t hash(std::uint64_t start) const;
  /// Releases the runs whose timers ended before this tick. Call it with the tick of the oldest checkpoint: no rewind
  /// needs those runs any more.
  void release_ended(std::uint64_t before);

  std::vector<Run>& all() { return runs_; }
  /// Pending timers, and how many of them repeat.
  struct Counts {
    std::uint64_t timers = 0;
    std::uint64_t repeating = 0;
  };
  Counts counts();

 private:
  static ScriptLimits limits_of(const Run& run, const ScriptLimits& limits);

  std::vector<Run> runs_;
};

}  // namespace limber::script
