// GarbageCollector: runs Lua's garbage collection between ticks in short slices. [sim]
#pragma once

#include <cstddef>

struct lua_State;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::script {

class LuaMemory;

class GarbageCollector {
 public:
  GarbageCollector(lua_State* state, const LuaMemory& memory);

  /// Around a scene's top level, during which Lua's automatic collection is enabled.
  void begin_run();
  void end_run();
  /// Before a tick's calls. The collector is paused during calls unless memory is scarce.
  void begin_calls();
  /// After the tick: collects for up to about 100 µs if enough has been allocated. Takes longer if scripts allocate
  /// more than that, and at the end of a cycle that has to traverse frequently written tables again (atomic phase).
  void after_tick();
  /// After a script was stopped for memory: runs two full cycles, in slices as well.
  void collect_all() { cycles_left_ = 2; }
  /// For a checkpoint.
  void serialize(Archive& archive);

 private:
  void pause();

  lua_State* state_;
  const LuaMemory& memory_;
  std::size_t used_after_cycle_;
  int cycles_left_ = 0;  // cycles still to complete
};

}  // namespace limber::script
