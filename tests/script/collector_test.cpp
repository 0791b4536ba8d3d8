// The garbage collector: pauses while scripts run, keeps up with their garbage, and cleans up after a memory stop.
#include "script/vm/garbage_collector.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include <lua.hpp>

#include "script/vm/lua_memory.h"

namespace limber::script {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20u;

struct CollectorTest : testing::Test {
  CollectorTest() {
    luaL_openlibs(state);
    memory.attach(state);
    collector.emplace(state, memory);
  }
  ~CollectorTest() override {
    memory.detach(state);
    lua_close(state);
  }
  void run(const std::string& text) { ASSERT_EQ(luaL_dostring(state, text.c_str()), 0) << lua_tostring(state, -1); }
  // unreferenced tables of about 40 bytes each
  void litter(int count) { run("for i = 1, " + std::to_string(count) + " do local t = {} x = t end x = nil"); }

  lua_State* state = luaL_newstate();
  LuaMemory memory{16 * kMegabyte, [](void*) {}, nullptr};
  std::optional<GarbageCollector> collector;
};

TEST_F(CollectorTest, PausesDuringCalls) {
  collector->begin_calls();
  const std::size_t before = memory.used();
  litter(100000);
  EXPECT_GT(memory.used(), before + 2 * kMegabyte);  // all of it is still allocated
}

TEST_F(CollectorTest, PausesBetweenSlices) {
  run("stored = {} for i = 1, 20000 do stored[i] = { i } end");
  litter(20000);
  collector->after_tick();  // may complete the cycle or not, depending on the machine
  collector->begin_calls();
  const std::size_t before = memory.used();
  ASSERT_LT(before, 5 * kMegabyte);
  litter(200000);  // an active collector would wait until twice as much is allocated
  EXPECT_GT(memory.used(), before + 6 * kMegabyte);
}

TEST_F(CollectorTest, RunsDuringCallsWhenMemoryIsScarce) {
  run("stored = {} for i = 1, 150000 do stored[i] = { i } end");
  ASSERT_GT(memory.used(), 8 * kMegabyte);
  const std::size_t before = memory.used();
  collector->begin_calls();
  litter(2000000);  // 80 MB
  EXPECT_LT(memory.used(), before + 16 * kMegabyte);
}

TEST_F(CollectorTest, AllocationsOfARunDoNotCountAsGrowth) {
  collector->begin_run();
  run("stored = {} for i = 1, 100000 do stored[i] = { i } end");
  collector->end_run();
  const std::size_t made = memory.used();
  ASSERT_GT(made, 4 * kMegabyte);
  litter(1000);
  const std::size_t before = memory.used();
  // a cycle that began by mistake would have ended after that many ticks, however slow the machine is
  for (int tick = 0; tick < 20000; tick++) {
    collector->begin_calls();
    collector->after_tick();
    ASSERT_EQ(memory.used(), before) << "tick " << tick << ": nothing to collect yet";
  }
}

TEST_F(CollectorTest, KeepsUpWithTheGarbageOfTicks) {
  for (int tick = 0; tick < 3000; tick++) {
    collector->begin_calls();
    litter(2000);  // 240 MB in total
    collector->after_tick();
    ASSERT_LT(memory.used(), 12 * kMegabyte) << tick;
  }
}

TEST_F(CollectorTest, DoesNothingWithLittleGarbage) {
  collector->after_tick();
  litter(5000);
  const std::size_t before = memory.used();
  collector->after_tick();
  EXPECT_EQ(memory.used(), before);
}

TEST_F(CollectorTest, RunsFullCyclesInSlices) {
  const std::size_t before = memory.used();
  litter(300000);
  collector->collect_all();
  int slices = 0;
  while (memory.used() > before + kMegabyte && slices < 100000) {
    collector->after_tick();
    slices++;
  }
  EXPECT_LT(memory.used(), before + kMegabyte);
  EXPECT_GT(slices, 1);
}

}  // namespace
}  // namespace limber::script
