// Vm: the one LuaJIT state of a scene, with the trusted prelude inside. Everything runs on the simulation thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/evaluation.h"
#include "base/message.h"
#include "base/result.h"

struct lua_State;

namespace limber {

struct ScriptContext;

class Vm {
 public:
  /// The context is what the prelude's calls work on; it outlives the Vm. [sim]
  explicit Vm(ScriptContext& context);
  ~Vm();
  Vm(const Vm&) = delete;
  Vm& operator=(const Vm&) = delete;

  /// Runs a scene's text in a fresh environment. The error: file:line: what, the source line, the traceback. [sim]
  Result<void> run(std::string_view text, std::string_view name);
  /// The callbacks of on_start. Those that err are told to the host. [sim]
  void start();
  /// Timers, contacts, on_step. Allocates nothing here; what scripts make is Lua's. [sim]
  void tick(double dt);
  /// The handlers of osc:on that fit; whether there were any. [sim]
  bool message(const Message& message, const Origin& origin);
  /// Asks an entry of the prelude's 95_console.lua, "evaluate" or "complete", about a text. [sim]
  Evaluation ask(const char* entry, std::string_view text);
  /// Every name that a scene sees, one a line: globals, library.member, thing.member, thing:method. [sim]
  std::string names();
  /// Collects for about 100 µs when there is enough to collect. The collector rests at all other times. [sim]
  void collect_garbage();

 private:
  void load_prelude(ScriptContext& context);
  void keep_entries();
  bool call(int arguments, int results);

  struct Close {
    void operator()(lua_State* state) const;
  };
  std::unique_ptr<lua_State, Close> state_;
  int entries_ = -1;  // registry references of the prelude's entries
  int run_ = -1;
  int start_ = -1;
  int tick_ = -1;
  int message_ = -1;
  int names_ = -1;
  double used_after_cycle_ = 0;  // kB
  bool collecting_ = false;
};

}  // namespace limber
