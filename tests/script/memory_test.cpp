// The counting allocator: counts, signals, and headroom.
#include "script/vm/lua_memory.h"

#include <gtest/gtest.h>

#include <memory>

#include <lua.hpp>

namespace limber::script {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20u;

struct MemoryTest : testing::Test {
  explicit MemoryTest(std::size_t cap = 8 * kMiB)
      : memory(
            cap, [](void* self) { static_cast<MemoryTest*>(self)->signals++; }, this) {
    memory.attach(state);
    lua_gc(state, LUA_GCSTOP, 0);
  }
  ~MemoryTest() override {
    memory.detach(state);
    lua_close(state);
  }
  // allocates a text of that many bytes, referenced from the stack
  bool allocate(std::size_t bytes) {
    lua_pushcfunction(state, [](lua_State* L) {
      const auto size = static_cast<std::size_t>(lua_tonumber(L, 1));
      const std::unique_ptr<char[]> text(new char[size]());
      text[0] = static_cast<char>(lua_tonumber(L, 2));
      lua_pushlstring(L, text.get(), size);
      return 1;
    });
    lua_pushnumber(state, static_cast<double>(bytes));
    lua_pushnumber(state, ++allocations);
    return lua_pcall(state, 2, 1, 0) == 0;
  }
  lua_State* state = luaL_newstate();
  LuaMemory memory;
  int signals = 0;
  int allocations = 0;
};

TEST_F(MemoryTest, CountsLikeLua) {
  const auto lua_count = [&] {
    return static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNT, 0)) * 1024 +
           static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNTB, 0));
  };
  EXPECT_EQ(memory.used(), lua_count());
  ASSERT_TRUE(allocate(3 * kMiB));
  EXPECT_EQ(memory.used(), lua_count());
  EXPECT_GT(memory.used(), 3 * kMiB);
  lua_settop(state, 0);
  lua_gc(state, LUA_GCCOLLECT, 0);
  EXPECT_EQ(memory.used(), lua_count());
  EXPECT_LT(memory.used(), kMiB);
}

TEST_F(MemoryTest, SignalsOnlyDuringACall) {
  ASSERT_TRUE(allocate(10 * kMiB));
  EXPECT_EQ(signals, 0);
  memory.begin_call();
  ASSERT_TRUE(allocate(2 * kMiB));
  EXPECT_GT(signals, 0);
  memory.end_call();
  signals = 0;
  ASSERT_TRUE(allocate(2 * kMiB));
  EXPECT_EQ(signals, 0);
}

TEST_F(MemoryTest, SignalsAgainWhileItGrows) {
  memory.begin_call();
  ASSERT_TRUE(allocate(7 * kMiB));
  EXPECT_EQ(signals, 0);
  for (int i = 0; i < 4; i++) ASSERT_TRUE(allocate(kMiB));
  EXPECT_GE(signals, 2);
}

TEST_F(MemoryTest, SmallAllocationsSucceedBeyondTheCap) {
  ASSERT_TRUE(allocate(10 * kMiB));  // a quarter beyond the cap: three quarters of a megabyte are left for a call
  memory.begin_call();
  ASSERT_TRUE(allocate(kMiB / 2));
  EXPECT_EQ(signals, 0);
  ASSERT_TRUE(allocate(kMiB / 2));
  EXPECT_EQ(signals, 1);
  memory.end_call();
  signals = 0;
  ASSERT_TRUE(allocate(15 * kMiB));  // nothing is left at three times the cap
  memory.begin_call();
  ASSERT_TRUE(allocate(100));
  EXPECT_EQ(signals, 1);
}

TEST_F(MemoryTest, LargeRequestsStopAndHugeOnesAreRejected) {
  memory.begin_call();
  EXPECT_TRUE(allocate(17 * kMiB));
  EXPECT_EQ(signals, 1);
  EXPECT_FALSE(allocate(33 * kMiB));
  EXPECT_STREQ(lua_tostring(state, -1), "not enough memory");
  memory.end_call();
  EXPECT_TRUE(allocate(33 * kMiB));  // requests by C++ are never rejected
}

}  // namespace
}  // namespace limber::script
