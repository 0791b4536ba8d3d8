// LIMBER_CHECK: a hook is called for every failure; without one, each location is logged once and the program
// continues.
#include "base/check.h"

#include <gtest/gtest.h>

#include "base/log/log.h"

namespace limber {
namespace {

int failures = 0;
std::string last_condition;
int last_line = 0;

void record_failure(const char* condition, const char* /*file*/, int line) {
  failures++;
  last_condition = condition;
  last_line = line;
}

struct Check : testing::Test {
  Check() {
    failures = 0;
    log_to_stderr(false);
  }
  ~Check() override {
    set_check_hook(nullptr);
    log_to_stderr(true);
  }
};

TEST_F(Check, HookIsCalledForEachFailure) {
  set_check_hook(record_failure);
  int line = 0;
  for (int i = 0; i < 3; i++) {
    line = __LINE__ + 1;
    LIMBER_CHECK(i < 1);
  }
  EXPECT_EQ(failures, 2);
  EXPECT_EQ(last_condition, "i < 1");
  EXPECT_EQ(last_line, line);
}

TEST_F(Check, LogsEachLocationOnceWithoutAHook) {
  const std::uint64_t errors = log_count(LogLevel::error);
  for (int i = 0; i < 3; i++) LIMBER_CHECK(i < 0);
  EXPECT_EQ(log_count(LogLevel::error), errors + 1);
  LIMBER_CHECK(errors == errors + 1);
  EXPECT_EQ(log_count(LogLevel::error), errors + 2);
  EXPECT_NE(log_since(0).back().text.find("the check 'errors == errors + 1' failed"), std::string::npos);
  EXPECT_NE(log_since(0).back().text.find("check_test.cpp:"), std::string::npos);
}

}  // namespace
}  // namespace limber
