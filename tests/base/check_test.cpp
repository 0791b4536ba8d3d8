// LIMBER_CHECK: a hook hears every failure; without one each place is logged once and the program goes on.
#include "base/check.h"

#include <gtest/gtest.h>

#include "base/log.h"

namespace limber {
namespace {

int failures = 0;
std::string last;
int last_line = 0;

void heard(const char* condition, const char* /*file*/, int line) {
  failures++;
  last = condition;
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

TEST_F(Check, TheHookHearsEachFailure) {
  set_check_hook(heard);
  int line = 0;
  for (int i = 0; i < 3; i++) {
    line = __LINE__ + 1;
    LIMBER_CHECK(i < 1);
  }
  EXPECT_EQ(failures, 2);
  EXPECT_EQ(last, "i < 1");
  EXPECT_EQ(last_line, line);
}

TEST_F(Check, WithoutAHookEachPlaceIsLoggedOnce) {
  const std::uint64_t errors = log_count(LogLevel::error);
  for (int i = 0; i < 3; i++) LIMBER_CHECK(i < 0);
  EXPECT_EQ(log_count(LogLevel::error), errors + 1);
  LIMBER_CHECK(errors == errors + 1);
  EXPECT_EQ(log_count(LogLevel::error), errors + 2);
  EXPECT_NE(log_since(0).back().text.find("'errors == errors + 1' does not hold"), std::string::npos);
  EXPECT_NE(log_since(0).back().text.find("check_test.cpp:"), std::string::npos);
}

}  // namespace
}  // namespace limber
