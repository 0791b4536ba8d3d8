// Collector: Lua's garbage, collected between ticks in short slices. [sim]
#pragma once

#include <cstddef>

struct lua_State;

namespace limber {

class KeyBytes;
class Memory;

class Collector {
 public:
  Collector(lua_State* state, const Memory& memory);

  /// Before a scene's top level, and after it: the collector works by itself meanwhile.
  void begin_run();
  void end_run();
  /// Before a tick's calls. It rests in them, unless memory is scarce.
  void begin_calls();
  /// After the tick: about 100 µs at most when there is enough to collect; longer when scripts make more than that, and
  /// at the end of a cycle when very much is written to all the time, which is looked at again in one go.
  void after_tick();
  /// After a script was stopped for memory: whole cycles, in slices too.
  void collect_all() { cycles_ = 2; }
  /// For a key state.
  void pass_memory(KeyBytes& key);

 private:
  void rest();

  lua_State* state_;
  const Memory& memory_;
  std::size_t used_after_cycle_;
  int cycles_ = 0;  // to be finished
};

}  // namespace limber
