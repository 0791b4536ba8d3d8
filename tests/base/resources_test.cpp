// check_resources() with temporarily lowered limits.
#include "base/system/resources.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>

namespace limber {
namespace {

// Returns the error with this limit, or "" if nothing is missing.
template <class Limit>
std::string error_with_limit(Limit limit, rlim_t value, const system::Resources& needed) {
  rlimit before{};
  EXPECT_EQ(getrlimit(limit, &before), 0);
  const rlimit lowered{value, before.rlim_max};
  EXPECT_EQ(setrlimit(limit, &lowered), 0);
  const Result<void> checked = system::check_resources(needed);
  EXPECT_EQ(setrlimit(limit, &before), 0);
  return checked ? "" : checked.error();
}

constexpr system::Resources kNeeded{.descriptors = 20, .threads = 3, .stack = std::size_t{256} * 1024};

TEST(Resources, SufficientLimitsPass) { EXPECT_EQ(error_with_limit(RLIMIT_NOFILE, 256, kNeeded), ""); }

TEST(Resources, ErrorNamesTheLimitAndTheCommand) {
  const std::string files = error_with_limit(RLIMIT_NOFILE, 12, kNeeded);
  EXPECT_TRUE(files.starts_with("only ")) << files;
  EXPECT_TRUE(files.ends_with(" more files and sockets can be opened, and 20 are needed: ulimit -n 1024")) << files;
  EXPECT_EQ(error_with_limit(RLIMIT_STACK, 65536, kNeeded),
            "the stack is limited to 64 KiB, and 256 are needed: ulimit -s 8192");
}

}  // namespace
}  // namespace limber
