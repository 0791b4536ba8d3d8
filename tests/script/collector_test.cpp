// The collector: it rests while scripts run, keeps up with what they leave behind, and clears up after a memory stop.
#include "script/collector.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include <lua.hpp>

#include "script/memory.h"

namespace limber {
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
  // so many tables that nobody keeps, about 40 bytes each
  void litter(int count) { run("for i = 1, " + std::to_string(count) + " do local t = {} x = t end x = nil"); }

  lua_State* state = luaL_newstate();
  Memory memory{16 * kMegabyte, [](void*) {}, nullptr};
  std::optional<Collector> collector;
};

TEST_F(CollectorTest, RestsDuringCalls) {
  collector->begin_calls();
  const std::size_t before = memory.used();
  litter(100000);
  EXPECT_GT(memory.used(), before + 2 * kMegabyte);  // all of it is still there
}

TEST_F(CollectorTest, RestsBetweenSlicesToo) {
  run("kept = {} for i = 1, 20000 do kept[i] = { i } end");
  litter(20000);
  collector->after_tick();  // to its end or not: how much a slice can do is the machine's affair
  collector->begin_calls();
  const std::size_t before = memory.used();
  ASSERT_LT(before, 5 * kMegabyte);
  litter(200000);  // a collector that works waits for twice as much at most
  EXPECT_GT(memory.used(), before + 6 * kMegabyte);
}

TEST_F(CollectorTest, WorksDuringCallsWhenMemoryIsScarce) {
  run("kept = {} for i = 1, 150000 do kept[i] = { i } end");
  ASSERT_GT(memory.used(), 8 * kMegabyte);
  const std::size_t before = memory.used();
  collector->begin_calls();
  litter(2000000);  // 80 MB
  EXPECT_LT(memory.used(), before + 16 * kMegabyte);
}

TEST_F(CollectorTest, WhatARunMadeIsNoGarbageOfTheTicks) {
  collector->begin_run();
  run("kept = {} for i = 1, 100000 do kept[i] = { i } end");
  collector->end_run();
  const std::size_t made = memory.used();
  ASSERT_GT(made, 4 * kMegabyte);
  std::size_t before = 0;
  for (int tick = 0; memory.used() < made + kMegabyte; tick++) {
    collector->begin_calls();
    litter(1000);
    before = memory.used();
    collector->after_tick();
    EXPECT_EQ(memory.used(), before) << "tick " << tick << ": nothing to collect yet";
  }
}

TEST_F(CollectorTest, KeepsUpWithWhatTicksLeave) {
  for (int tick = 0; tick < 3000; tick++) {
    collector->begin_calls();
    litter(2000);  // 240 MB in all
    collector->after_tick();
    ASSERT_LT(memory.used(), 12 * kMegabyte) << tick;
  }
}

TEST_F(CollectorTest, DoesNothingWhileThereIsLittle) {
  collector->after_tick();
  litter(5000);
  const std::size_t before = memory.used();
  collector->after_tick();
  EXPECT_EQ(memory.used(), before);
}

TEST_F(CollectorTest, ClearsUpInSlices) {
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
}  // namespace limber
