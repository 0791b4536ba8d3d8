// Vm: the LuaJIT state of a scene, including the trusted prelude. Used on the simulation thread only.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/evaluation.h"
#include "base/memory/arena.h"
#include "base/message.h"
#include "base/result.h"
#include "script/vm/behavior_calls.h"
#include "script/vm/garbage_collector.h"
#include "script/vm/guard.h"
#include "script/vm/prelude.h"

struct lua_State;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::script {

struct ScriptContext;
struct ScriptPlace;

class Vm {
 public:
  /// The prelude's API calls work on `context`, which outlives the Vm. The mode is `compiled` only if it is
  /// `wanted` and no other Vm of the process has it. [sim]
  Vm(ScriptContext& context, VmMode wanted);
  ~Vm();
  Vm(const Vm&) = delete;
  Vm& operator=(const Vm&) = delete;

  /// Runs a scene's text in a fresh environment, then `added` in the same one. The error has "file:line: message", the
  /// source line and the traceback; `fault` receives its place. [sim]
  Result<void> run(std::string_view text, std::string_view name, std::string_view added, ScriptPlace& fault);
  /// Runs the on_start callbacks. Errors are reported to the host. [sim]
  void start();
  /// Runs timers, contacts, on_step. Allocates no C++ memory. [sim]
  void tick(double dt);
  /// Computes the results of the run (ScriptContext::output). [sim]
  void compute_results();
  /// Runs the matching osc:on handlers; false if there are none. [sim]
  bool handle_message(const Message& message, const CommandOrigin& origin);
  /// Calls the exported `function` of console.lua ("evaluate" or "complete") with a text. [sim]
  Evaluation query(const char* entry, std::string_view text);
  /// Calls into behaviors of behaviors_lua/.
  BehaviorCalls& behaviors() { return behaviors_; }
  /// All names that a scene sees, one per line: globals, library.member, thing.member, thing:method. [sim]
  std::string names();
  /// Guards all calls of script code, including those from C++. Runs on the main thread of `state()`.
  Guard& guard() { return guard_; }
  lua_State* state() const { return state_.get(); }
  VmMode mode() const { return guard_.mode(); }
  /// Enables the JIT compiler, as Guard::enable_jit(), and compiles the prelude's most frequently used functions.
  bool enable_jit();
  void disable_jit() { guard_.disable_jit(); }

  /// Returns `state` serialized as text; equal data give equal texts. [sim]
  std::string state_text();
  /// Before a detached run: sets `state`. Nothing is compiled until become_live().
  void begin_detached(std::string_view state);
  /// After the run: notes which keys of `state` it wrote, and collects all handles (CollectedArguments::handle_ids).
  void prepare();
  /// Takes over `state` of the live run that is being replaced, except keys that this run wrote itself. [sim]
  void adopt_state(std::string_view state);
  /// Handles have been remapped; timers continue from the given time of the last check, if any. [sim]
  void become_live(std::optional<double> timers_at);

  // Functions for an earlier run, which has been replaced; only timers that its callbacks have created continue.
  /// Pending timers that callbacks have created, and how many of them repeat.
  struct CallbackTimers {
    std::uint64_t timers = 0;
    std::uint64_t repeating = 0;
  };
  CallbackTimers callback_timers();
  /// Ends everything but such timers. Returns the number of handlers registered by callbacks that ended.
  std::uint64_t retire();
  /// Serializes the top level's timers of sim:after; continues those of the previous run.
  std::string delayed_timers_text();
  void adopt_delayed_timers(std::string_view timers);
  /// Sets the run's number, by which timers in `state` identify it.
  void set_run_number(std::uint64_t number);
  /// Cancels a timer of this run by its number.
  void cancel_timer(std::int32_t number);
  /// Collects all handles in the context (CollectedArguments::handle_ids).
  void gather_handles();
  /// Updates the prelude's tables after these handles were remapped.
  void handles_moved();
  /// True if a timer is due at the current simulation time.
  bool timers_due();
  /// Runs the due timers and returns the number of pending ones.
  std::uint64_t run_timers();
  /// Applies the difference between two texts of `state` to this run's `state`.
  void apply_state_changes(std::string_view before, std::string_view after);

  /// Between two ticks: copies Lua's heap, sharing pages with the older copy `previous` (may be null). Flushes compiled
  /// code, which is outside the heap and compiled again when needed. [sim]
  void copy_heap(PageStore& pages, const PageStore::PageList* previous, PageStore::PageList& out);
  void restore_heap(const PageStore& pages, const PageStore::PageList& image);
  /// Serializes the counters outside the heap.
  void serialize_counts(Archive& archive);

  GarbageCollector& collector() { return *collector_; }
  /// Collects garbage for about 100 µs if there is enough. The collector is paused at all other times. [sim]
  void collect_garbage();

 private:
  void load_prelude(ScriptContext& context);
  void store_exports();
  bool call(int arguments, int results) { return call_export(state_.get(), arguments, results); }
  void push_export(const char* name);
  std::string text_from(const char* name);
  std::uint64_t count_from(const char* name);
  void call_with(const char* name, double number);

  struct Closer {
    void operator()(lua_State* state) const;
  };
  Arena heap_;
  std::unique_ptr<lua_State, Closer> state_;
  Guard guard_;
  std::optional<GarbageCollector> collector_;  // created after the prelude is loaded
  int exports_ = -1;  // registry references: the table of the functions that the prelude exports, and individual ones
  int run_ = -1;
  int start_ = -1;
  int tick_ = -1;
  int message_ = -1;
  int names_ = -1;
  int warm_ = -1;
  BehaviorCalls behaviors_{*this};
};

}  // namespace limber::script
