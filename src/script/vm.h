// Vm: the one LuaJIT state of a scene, with the trusted prelude inside. Everything runs on the simulation thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/arena.h"
#include "base/evaluation.h"
#include "base/id.h"
#include "base/message.h"
#include "base/result.h"
#include "script/collector.h"
#include "script/guard.h"
#include "sim/behavior.h"

struct lua_State;

namespace limber {

class KeyBytes;
struct ScriptContext;
struct ScriptPlace;

class Vm {
 public:
  /// The context is what the prelude's calls work on; it outlives the Vm. Live when that is wanted and no other Vm of
  /// the process is. [sim]
  Vm(ScriptContext& context, VmMode wanted);
  ~Vm();
  Vm(const Vm&) = delete;
  Vm& operator=(const Vm&) = delete;

  /// Runs a scene's text in a fresh environment. The error: file:line: what, the source line, the traceback; `fault`:
  /// its place. [sim]
  Result<void> run(std::string_view text, std::string_view name, ScriptPlace& fault);
  /// The callbacks of on_start. Those that err are told to the host. [sim]
  void start();
  /// Timers, contacts, on_step. Allocates nothing here; what scripts make is Lua's. [sim]
  void tick(double dt);
  /// The handlers of osc:on that fit; whether there were any. [sim]
  bool message(const Message& message, const Origin& origin);
  /// Asks an entry of the prelude's 95_console.lua, "evaluate" or "complete", about a text. [sim]
  Evaluation ask(const char* entry, std::string_view text);
  // Behaviours of behaviors_lua/ (behavior_scripts.h); a fault without text: it went well.
  /// Makes the `self` of an instance: its number, from 1. [sim]
  std::int32_t make_behavior(std::int32_t file, NodeId id);
  BehaviorFault start_behavior(std::int32_t number);
  BehaviorFault step_behavior(std::int32_t number, double dt);
  /// Steps the instances that BehaviorScripts::next_step names, until it names none or one fails; `stepping` is the one
  /// at hand.
  BehaviorFault step_behaviors(double dt, const std::int32_t& stepping);
  BehaviorFault restore_behavior(std::int32_t number, std::string_view state, bool migrate);
  Result<std::string> behavior_state(std::int32_t number);
  void drop_behavior(std::int32_t number);
  /// Every name that a scene sees, one a line: globals, library.member, thing.member, thing:method. [sim]
  std::string names();
  /// Calls of scripts' code, from C++ too: the state's main thread is `state()`. [sim]
  Guard& guard() { return guard_; }
  lua_State* state() const { return state_.get(); }
  VmMode mode() const { return guard_.mode(); }
  /// Draft to live, once the other Vm has gone or was disarmed; false while it has not.
  bool arm();
  void disarm() { guard_.disarm(); }

  /// `state` as plain data: text of its own, equal where the data are. [sim]
  std::string state_text();
  /// Before a run beside the show: `state` starts as that text; nothing is compiled until become_live().
  void begin_beside(std::string_view state);
  /// After the run: which keys of `state` it wrote; every handle is told to the context (ScriptContext::things).
  void prepare();
  /// `state` of the show that this run takes the place of; keys that the run wrote itself stay. [sim]
  void take_state(std::string_view state);
  /// Handles have other ids now; timers go on from where they were looked at last, if they were. [sim]
  void become_live(std::optional<double> timers_at);

  // An earlier run, whose place another one has taken; only timers of its callbacks go on.
  /// Timers that callbacks have set, and how many of them repeat.
  struct CallbackTimers {
    std::uint64_t timers = 0;
    std::uint64_t repeating = 0;
  };
  CallbackTimers callback_timers();
  /// All that is no such timer ends; how many handlers of callbacks there were among it.
  std::uint64_t become_earlier();
  /// Top-level timers of sim:after as text, and those of the run before this one.
  std::string afters_text();
  void take_afters(std::string_view afters);
  /// Timers in `state` name the run by this number.
  void number_run(std::uint64_t number);
  void cancel_timer(std::int32_t number);
  /// Every handle is told to the context (ScriptContext::things); later, that they may have other ids.
  void gather_handles();
  void handles_moved();
  bool timers_due();
  /// Calls those that are due; how many timers are left.
  std::uint64_t run_timers();
  /// What has changed from one text of `state` to the next is changed in this run's too.
  void change_state(std::string_view before, std::string_view after);

  /// Between two ticks: all that Lua holds, in pages that are shared with an older copy, or null. Compiled code is
  /// forgotten, since it lies elsewhere; it comes again as it is needed. [sim]
  void copy_heap(PageStore& pages, const PageStore::Image* before, PageStore::Image& out);
  void bring_back_heap(const PageStore& pages, const PageStore::Image& image);
  /// What is counted of it beside the heap.
  void pass_counts(KeyBytes& key);

  /// Collects for about 100 µs when there is enough to collect. The collector rests at all other times. [sim]
  void collect_garbage();

 private:
  void load_prelude(ScriptContext& context);
  void keep_entries();
  bool call(int arguments, int results);
  void push_entry(const char* name);
  std::string text_of(const char* entry);
  std::uint64_t count_of(const char* entry);
  void call_with(const char* entry, double number);
  bool push_behavior(int functions, std::int32_t number);
  BehaviorFault guarded_behavior(int arguments, int results);

  struct Close {
    void operator()(lua_State* state) const;
  };
  Arena heap_;
  std::unique_ptr<lua_State, Close> state_;
  Guard guard_;
  std::optional<Collector> collector_;  // once the prelude is in
  int entries_ = -1;                    // registry references: the prelude's entries, all and each
  int run_ = -1;
  int start_ = -1;
  int tick_ = -1;
  int message_ = -1;
  int names_ = -1;
  int warm_ = -1;
  int make_behavior_ = -1;
  int renew_behavior_ = -1;
  int restore_behavior_ = -1;
  int migrated_behavior_ = -1;
  int step_behaviors_ = -1;
  int behavior_state_ = -1;
  int drop_behavior_ = -1;
  int behavior_self_ = -1;  // tables by the number of the instance
  int behavior_start_ = -1;
  int behavior_step_ = -1;
  int behavior_migrate_ = -1;
};

}  // namespace limber
