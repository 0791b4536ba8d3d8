// The counting allocator: what is held, when it speaks, whom it stops first.
#include "script/memory.h"

#include <gtest/gtest.h>

#include <memory>

#include <lua.hpp>

namespace limber {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20u;

struct MemoryTest : testing::Test {
  explicit MemoryTest(std::size_t cap = 8 * kMiB)
      : memory(
            cap, [](void* self) { static_cast<MemoryTest*>(self)->full++; }, this) {
    memory.attach(state);
    lua_gc(state, LUA_GCSTOP, 0);
  }
  ~MemoryTest() override {
    memory.detach(state);
    lua_close(state);
  }
  // a text of so many bytes, kept on the stack
  bool hold(std::size_t bytes) {
    lua_pushcfunction(state, [](lua_State* L) {
      const auto size = static_cast<std::size_t>(lua_tonumber(L, 1));
      const std::unique_ptr<char[]> text(new char[size]());
      text[0] = static_cast<char>(lua_tonumber(L, 2));
      lua_pushlstring(L, text.get(), size);
      return 1;
    });
    lua_pushnumber(state, static_cast<double>(bytes));
    lua_pushnumber(state, ++made);
    return lua_pcall(state, 2, 1, 0) == 0;
  }
  lua_State* state = luaL_newstate();
  Memory memory;
  int full = 0;
  int made = 0;
};

TEST_F(MemoryTest, CountsWhatLuaCounts) {
  const auto told = [&] {
    return static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNT, 0)) * 1024 +
           static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNTB, 0));
  };
  EXPECT_EQ(memory.used(), told());
  ASSERT_TRUE(hold(3 * kMiB));
  EXPECT_EQ(memory.used(), told());
  EXPECT_GT(memory.used(), 3 * kMiB);
  lua_settop(state, 0);
  lua_gc(state, LUA_GCCOLLECT, 0);
  EXPECT_EQ(memory.used(), told());
  EXPECT_LT(memory.used(), kMiB);
}

TEST_F(MemoryTest, SpeaksOnlyInACall) {
  ASSERT_TRUE(hold(10 * kMiB));
  EXPECT_EQ(full, 0);
  memory.begin_call();
  ASSERT_TRUE(hold(2 * kMiB));
  EXPECT_GT(full, 0);
  memory.end_call();
  full = 0;
  ASSERT_TRUE(hold(2 * kMiB));
  EXPECT_EQ(full, 0);
}

TEST_F(MemoryTest, SpeaksAgainWhileItGrows) {
  memory.begin_call();
  ASSERT_TRUE(hold(7 * kMiB));
  EXPECT_EQ(full, 0);
  for (int i = 0; i < 4; i++) ASSERT_TRUE(hold(kMiB));
  EXPECT_GE(full, 2);
}

TEST_F(MemoryTest, WhoTakesLittleGoesOnWhenOthersFilledIt) {
  ASSERT_TRUE(hold(10 * kMiB));  // a quarter beyond: three quarters of a megabyte are left to a call
  memory.begin_call();
  ASSERT_TRUE(hold(kMiB / 2));
  EXPECT_EQ(full, 0);
  ASSERT_TRUE(hold(kMiB / 2));
  EXPECT_EQ(full, 1);
  memory.end_call();
  full = 0;
  ASSERT_TRUE(hold(15 * kMiB));  // at three times the cap nothing is
  memory.begin_call();
  ASSERT_TRUE(hold(100));
  EXPECT_EQ(full, 1);
}

TEST_F(MemoryTest, LargePiecesStopAndImpossibleOnesAreRefused) {
  memory.begin_call();
  EXPECT_TRUE(hold(17 * kMiB));
  EXPECT_EQ(full, 1);
  EXPECT_FALSE(hold(33 * kMiB));
  EXPECT_STREQ(lua_tostring(state, -1), "not enough memory");
  memory.end_call();
  EXPECT_TRUE(hold(33 * kMiB));  // ours is never refused
}

}  // namespace
}  // namespace limber
