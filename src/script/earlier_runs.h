// EarlierRuns: runs of a scene whose file was saved since. Timers that their callbacks set go on, each in the Lua state
// that it was set in, with its functions and variables. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/id.h"
#include "script/limits.h"

namespace limber {

class Store;
class Vm;
struct ScriptContext;

/// Where the handles of a Lua state point, by the names of things, while things are made again.
class HandleNames {
 public:
  /// Before: notes the name of each living thing. The handles are those that the state has gathered.
  void note(const ScriptContext& context);
  /// After: a handle whose thing was made again gets the id of that of the same name and kind; others that are gone
  /// are gone for good.
  void follow(const ScriptContext& context) const;

 private:
  std::vector<std::string> names_;  // one a handle; empty: gone
};

class EarlierRuns {
 public:
  /// More runs than that are not kept: each is a Lua state of its own.
  static constexpr std::size_t kMax = 16;

  struct Run {
    Run(std::unique_ptr<ScriptContext> its_context, std::unique_ptr<Vm> its_vm);
    ~Run();
    Run(Run&&) noexcept;
    Run& operator=(Run&&) noexcept;

    std::unique_ptr<ScriptContext> context;
    std::unique_ptr<Vm> vm;
    HandleNames names;
    std::uint64_t number = 0;    ///< Of the run, counted through the show.
    std::uint64_t timers = 0;    ///< That wait; 0: it has ended, and is kept for a rewind.
    std::uint64_t ended_at = 0;  ///< The tick in which its last timer ended.
    std::string state;           ///< `state` as the run had it last.
  };

  EarlierRuns();
  ~EarlierRuns();
  EarlierRuns(const EarlierRuns&) = delete;
  EarlierRuns& operator=(const EarlierRuns&) = delete;

  /// Before and after things of the world are made again. Those of `params` are at that node then, or nowhere.
  void note_things();
  void follow_things(NodeId params);
  /// One more. The answer: timers that ended because there are too many runs.
  std::uint64_t add(Run run);
  /// Timers that are due, oldest run first. `show`: the run that plays; `state` is the same for all.
  void tick(Vm& show, std::uint64_t tick);
  /// Ends the timers that a run's calls have canceled.
  void cancel(ScriptContext& by, std::uint64_t tick);
  void collect_garbage();
  void do_again(bool on);
  void limit(const ScriptLimits& limits);
  /// With the runs that have timers left; without any it stays as it is.
  std::uint64_t hash(std::uint64_t start) const;
  /// Runs that had ended before that tick are released: nothing goes back to where they had not.
  void release_ended(std::uint64_t before);

  std::vector<Run>& all() { return runs_; }
  /// Timers that wait, and how many of them repeat.
  struct Counts {
    std::uint64_t timers = 0;
    std::uint64_t repeating = 0;
  };
  Counts counts();

 private:
  static ScriptLimits limits_of(const Run& run, const ScriptLimits& limits);

  std::vector<Run> runs_;
};

}  // namespace limber
