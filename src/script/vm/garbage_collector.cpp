// Incremental garbage collection.
#include "script/vm/garbage_collector.h"

#include <algorithm>
#include <chrono>

#include <lua.hpp>

#include "base/memory/archive.h"
#include "script/vm/lua_memory.h"

namespace limber::script {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kSlice = std::chrono::microseconds(100);
constexpr std::size_t kGrowth = std::size_t{512} << 10u;  // a cycle begins when the heap has grown by half plus this

}  // namespace

GarbageCollector::GarbageCollector(lua_State* state, const LuaMemory& memory) : state_(state), memory_(memory) {
  lua_gc(state_, LUA_GCCOLLECT, 0);
  used_after_cycle_ = memory_.used();
  pause();
}

void GarbageCollector::pause() { lua_gc(state_, LUA_GCSTOP, 0); }

void GarbageCollector::serialize(Archive& archive) { archive.serialize_all(used_after_cycle_, cycles_left_); }

void GarbageCollector::begin_run() { lua_gc(state_, LUA_GCRESTART, 0); }

// most of the memory allocated by a run stays in use, so it must not count as growth
void GarbageCollector::end_run() {
  used_after_cycle_ = memory_.used();
  pause();
}

void GarbageCollector::begin_calls() {
  if (memory_.used() > memory_.cap() / 2) lua_gc(state_, LUA_GCRESTART, 0);
}

void GarbageCollector::after_tick() {
  const std::size_t used = memory_.used();
  const std::size_t limit = used_after_cycle_ + used_after_cycle_ / 2 + kGrowth;
  if (cycles_left_ == 0 && used < limit) return pause();
  cycles_left_ = std::max(cycles_left_, 1);
  // use longer slices if scripts allocate more than a normal slice can collect
  const bool behind = used > 2 * limit || used > memory_.cap() / 2;
  const Clock::time_point end = Clock::now() + (behind ? 10 * kSlice : kSlice);
  do {
    if (lua_gc(state_, LUA_GCSTEP, 1) == 0) continue;
    cycles_left_--;
    used_after_cycle_ = memory_.used();
    if (cycles_left_ == 0) break;
  } while (Clock::now() < end);
  pause();  // LUA_GCSTEP restarts the automatic collector
}

}  // namespace limber::script
