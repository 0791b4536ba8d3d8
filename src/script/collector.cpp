// The collector's slices.
#include "script/collector.h"

#include <algorithm>
#include <chrono>

#include <lua.hpp>

#include "base/key_bytes.h"
#include "script/memory.h"

namespace limber {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kSlice = std::chrono::microseconds(100);
constexpr std::size_t kGrowth = std::size_t{512} << 10u;  // a cycle begins when the heap has grown by half and this

}  // namespace

Collector::Collector(lua_State* state, const Memory& memory) : state_(state), memory_(memory) {
  lua_gc(state_, LUA_GCCOLLECT, 0);
  used_after_cycle_ = memory_.used();
  rest();
}

void Collector::rest() { lua_gc(state_, LUA_GCSTOP, 0); }

void Collector::pass_memory(KeyBytes& key) { key.pass_all(used_after_cycle_, cycles_); }

void Collector::begin_run() { lua_gc(state_, LUA_GCRESTART, 0); }

// what a run has made stays, most of it: it is no garbage that came between ticks
void Collector::end_run() {
  used_after_cycle_ = memory_.used();
  rest();
}

void Collector::begin_calls() {
  if (memory_.used() > memory_.cap() / 2) lua_gc(state_, LUA_GCRESTART, 0);
}

void Collector::after_tick() {
  const std::size_t used = memory_.used();
  const std::size_t limit = used_after_cycle_ + used_after_cycle_ / 2 + kGrowth;
  if (cycles_ == 0 && used < limit) return rest();
  cycles_ = std::max(cycles_, 1);
  // a script that makes more than a slice can collect gets longer ones
  const bool much = used > 2 * limit || used > memory_.cap() / 2;
  const Clock::time_point end = Clock::now() + (much ? 10 * kSlice : kSlice);
  do {
    if (lua_gc(state_, LUA_GCSTEP, 1) == 0) continue;
    cycles_--;
    used_after_cycle_ = memory_.used();
    if (cycles_ == 0) break;
  } while (Clock::now() < end);
  rest();  // a step starts the collector again
}

}  // namespace limber
