// Guard: calls scripts' code so that nothing it does harms the show. What errs, computes too long or eats memory is
// stopped, what it had done to the world is taken back, and the fault says where. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "script/limits.h"
#include "script/memory.h"
#include "script/watchdog.h"

struct lua_Debug;
struct lua_State;

namespace limber {

class KeyBytes;
struct ScriptContext;

/// Why a call failed, as a person reads it.
struct ScriptFault {
  std::string file;
  int line = 0;
  std::string text;      ///< "file:line: what", the source line, the traceback.
  bool stopped = false;  ///< By the guard, for time or memory; else it erred by itself.
};

class Guard {
 public:
  enum class Kind : std::uint8_t {
    call,  ///< A callback, a handler, a step of a behavior: its budget is ScriptLimits::call_ms; taken back on failure.
    run,   ///< A scene's top level: run_ms; nothing is taken back, since a scene whose run fails is thrown away.
  };

  Guard(lua_State* state, ScriptContext& context, const ScriptLimits& limits);
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// Calls the function that lies below its `arguments` on the stack, as lua_pcall does, on the state's main thread.
  /// True: `results` values lie there instead. False: nothing does, and fault() tells why; what the call had written
  /// is taken back, what it wanted to send is not sent. Not from inside another guarded call.
  bool call(int arguments, int results, Kind kind = Kind::call);
  const ScriptFault& fault() const { return fault_; }
  /// In the middle of a call: what it did until here was good and stays, and another begins, with a budget of its own.
  /// False: it is to be stopped, or has much garbage, and should end first. `changed` becomes true where the call did
  /// more than push parts.
  bool next_call(bool& changed);
  /// A fault that tells no place is that of the function on top of the stack.
  void blame_function();

  /// From the next call on, these limits hold.
  void limit(const ScriptLimits& limits);
  const ScriptLimits& limits() const { return limits_; }

  /// Registry references of functions of the prelude: the message handler; the fault of a call that was stopped
  /// without an error coming out; what is to be done after a failure.
  void use(int handler, int stopped_fault, int failed);

  VmMode mode() const { return live_ ? VmMode::live : VmMode::draft; }
  /// Draft to live: false while another state of the process is live. Compiled code is forgotten.
  bool arm();
  /// Live to draft.
  void disarm();

  // what the prelude asks in the middle of a call
  bool stopped() const { return fired_; }
  /// Whether native code that works on for long should end: the call that runs is going to be stopped.
  bool stop_asked() { return running_ && (reason_ != Reason::none || watch_.stop_asked()); }
  std::string_view stop_file() const { return stop_file_; }
  int stop_line() const { return stop_line_; }
  std::string stop_text() const;
  /// Whether a call was stopped for memory since the last time that this was asked.
  bool take_memory_stop() { return std::exchange(memory_stop_, false); }
  const Memory& memory() const { return memory_; }
  /// A key state takes the count of what Lua holds, and brings it back with that.
  void pass_memory(KeyBytes& key);
  /// While `on`, what was done once is done again: only the calls that the ledger forbids are stopped, and those that
  /// take many times what they took then, because the runs differ.
  void do_again(bool on) { again_ = on; }

 private:
  enum class Reason : std::uint8_t { none, time, memory };
  void begin(Kind kind);
  void end();
  void stop(Reason reason);
  void heal();
  bool skip_call(int arguments);
  std::string memory_text() const;
  void take_fault(int status, int function);
  void place_at_function(int function);
  void note_place(lua_State* state, int level = 0);
  static int on_error(lua_State* state);
  bool place_of(lua_State* state, int level);
  static void on_hook(lua_State* state, lua_Debug* at);

  lua_State* state_;
  ScriptContext& context_;
  ScriptLimits limits_;
  Memory memory_;
  Watch watch_;
  std::shared_ptr<Watchdog> watchdog_;
  ScriptFault fault_;
  int handler_ = -1;
  int stopped_fault_ = -1;
  int failed_ = -1;
  Kind kind_ = Kind::call;
  bool live_ = false;
  bool running_ = false;
  bool memory_stop_ = false;
  bool again_ = false;
  // written from the signal too
  volatile bool hooked_ = false;
  volatile Reason reason_ = Reason::none;
  bool overflowed_ = false;
  // where the stop, or the overflow of the stack, met the script
  bool fired_ = false;
  int stop_line_ = 0;
  char stop_file_[256] = {};
};

}  // namespace limber
