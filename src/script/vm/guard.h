// Guard: calls script code safely. Stops code that fails, computes too long or uses too much memory, rolls back its
// changes to the world, and reports a fault with its place. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "script/vm/limits.h"
#include "script/vm/lua_memory.h"
#include "script/vm/watchdog.h"

struct lua_Debug;
struct lua_State;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::script {

class CallLog;

/// The reason for a failed call, for display.
struct ScriptFault {
  std::string file;
  int line = 0;
  std::string text;      ///< "file:line: message", the source line, the traceback.
  bool stopped = false;  ///< Stopped by the guard for time or memory; false: the script itself raised an error.
};

/// Called at the beginning and end of each guarded call of Kind::call, to record its effects and to commit or roll
/// them back.
struct CallHooks {
  virtual void begin_call() = 0;
  virtual void end_call(bool success) = 0;
  /// Commits the running call and begins another. Returns true if the ended one did more than apply forces.
  virtual bool next_call() = 0;

 protected:
  ~CallHooks() = default;
};

class Guard {
 public:
  enum class Kind : std::uint8_t {
    call,  ///< A callback, handler or behavior step: budget ScriptLimits::call_ms; rolled back on failure.
    run,   ///< A scene's top level: budget run_ms; not rolled back, since the scene of a failed run is discarded.
  };

  Guard(lua_State* state, CallHooks& hooks, const ScriptLimits& limits);
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// Calls the function below its `arguments` on the stack, like lua_pcall, on the state's main thread. Success:
  /// replaces them with `results` values. Failure: leaves nothing on the stack, sets fault(), rolls back changes and
  /// discards messages. Must not be called from inside another guarded call.
  bool call(int arguments, int results, Kind kind = Kind::call);
  const ScriptFault& fault() const { return fault_; }
  /// Within a call: commits its effects so far and begins a new call with a fresh budget. Returns false if the call
  /// should end first, because it is to be stopped, there is much garbage, or a replay skips the next call. Sets
  /// `changed` if the call did more than apply forces.
  bool next_call(bool& changed);
  /// If the fault has no place, sets it to the function on top of the stack.
  void attribute_to_function();
  /// The same with a file that was run.
  void attribute_to_file(std::string_view name);

  /// Sets limits, effective from the next call.
  void set_limits(const ScriptLimits& limits);
  const ScriptLimits& limits() const { return limits_; }

  /// Registry references of prelude functions.
  struct Functions {
    int handler = -1;        ///< The error handler (message handler) of lua_pcall.
    int stopped_fault = -1;  ///< Creates the fault of a call that was stopped without an error being raised.
    int failed = -1;         ///< To call after a failure.
  };
  void set_functions(const Functions& functions);
  /// Counts the calls in `calls` from now on; it outlives the guard.
  void set_call_log(CallLog& calls) { call_log_ = &calls; }

  VmMode mode() const { return jit_enabled_ ? VmMode::compiled : VmMode::interpreted; }
  /// Enables the JIT compiler, if the limits allow it. Returns false while another state of the process has it.
  bool enable_jit();
  /// Disables the JIT compiler: compiled code is no longer executed.
  void disable_jit();

  // queries of the prelude during a call
  bool stopped() const { return stop_.error_raised; }
  /// True if the running call is going to be stopped; native code that takes long must end then.
  bool stop_requested() { return running_ && (stop_.reason != Reason::none || watch_.stop_requested()); }
  std::string_view stop_file() const { return stop_.file; }
  int stop_line() const { return stop_.line; }
  std::string stop_text() const;
  /// Returns whether a call was stopped for memory since the last query.
  bool consume_memory_stop() { return std::exchange(memory_stop_, false); }
  const LuaMemory& memory() const { return memory_; }
  /// Serializes the memory count for a checkpoint.
  void serialize(Archive& archive);
  /// While `on`, a rewind simulates recorded passes again: only the calls that the log lists are stopped, and those
  /// that need many times the original budget because the re-simulation has diverged.
  void set_resimulating(bool on) { resimulating_ = on; }

 private:
  enum class Reason : std::uint8_t { none, time, memory };
  /// How the running call was stopped, or its stack overflow.
  struct Stop {
    // also written by the signal handler
    volatile bool hook_set = false;
    volatile Reason reason = Reason::none;
    bool error_raised = false;
    bool overflowed = false;
    int line = 0;  // place in the script
    char file[256] = {};
    void begin_call();
    bool find_place(lua_State* state, int level);
  };
  void begin(Kind kind);
  void end();
  void stop(Reason reason);
  void clear_hook_flag();
  bool skip_call(int arguments);
  std::string memory_text() const;
  void capture_fault(int status, int function);
  void set_place_to_function(int function);
  void record_place(lua_State* state, int level = 0);
  static int on_error(lua_State* state);
  static void on_hook(lua_State* state, lua_Debug* at);

  lua_State* state_;
  CallHooks& hooks_;
  ScriptLimits limits_;
  LuaMemory memory_;
  Watch watch_;
  std::shared_ptr<Watchdog> watchdog_;
  ScriptFault fault_;
  Functions functions_;  // with on_error as handler, which calls the prelude's
  CallLog* call_log_ = nullptr;
  Kind kind_ = Kind::call;
  bool jit_enabled_ = false;
  bool running_ = false;
  bool memory_stop_ = false;
  bool resimulating_ = false;
  Stop stop_;
};

}  // namespace limber::script
