// LogFile: rotation by size, files that are removed or renamed, paths that can't be written.
#include "base/log/log_file.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class LogFileTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  std::string path(int number = 0) const {
    const std::string file = (folder / "show.log").string();
    return number == 0 ? file : fmt::format("{}.{}", file, number);
  }
  std::string text(int number = 0) const {
    std::ifstream in(path(number), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::unique_ptr<LogFile> open(LogRotation rotation) const {
    auto log = LogFile::open(path(), rotation);
    EXPECT_TRUE(log) << log.error();
    return log ? std::move(*log) : nullptr;
  }
  /// Writes in as many pieces as the file accepts, until the first error.
  static int write(LogFile& log, std::string_view bytes) {
    while (!bytes.empty()) {
      const system::Written written = log.write(bytes, 1s);
      if (written.count == 0) return written.error;
      bytes.remove_prefix(written.count);
    }
    return 0;
  }

  fs::path folder = fs::path(::testing::TempDir()) / fmt::format("limber_log_{}", ::getpid());
};

TEST_F(LogFileTest, RotatesBySizeAndKeepsWholeLines) {
  Random random(7);
  const std::unique_ptr<LogFile> log = open({.bytes = 20000, .old_files = 3});
  std::vector<std::string> files{""};  // the newest is last
  for (int i = 0; i < 100; i++) {
    const std::string line = fmt::format("{} {}\n", i, std::string(random.next() % 9000, 'x'));
    if (!files.back().empty() && files.back().size() + line.size() > 20000) files.emplace_back();
    files.back() += line;
    ASSERT_EQ(write(*log, line), 0);
  }
  ASSERT_GT(files.size(), 5U);
  for (int number = 0; number <= 3; number++)
    EXPECT_EQ(text(number), files[files.size() - 1 - static_cast<std::size_t>(number)]) << number;
  EXPECT_FALSE(fs::exists(path(4)));
}

TEST_F(LogFileTest, AppendsToTheFileOfAnEarlierRun) {
  write(*open({}), "before\n");
  write(*open({}), "now\n");
  EXPECT_EQ(text(), "before\nnow\n");
  EXPECT_EQ(write(*open({.bytes = 12, .old_files = 1}), "full\n"), 0);
  EXPECT_EQ(text(1), "before\nnow\n");
  EXPECT_EQ(text(), "full\n");
}

TEST_F(LogFileTest, KeepsNoOldFileIfNoneIsWanted) {
  const std::unique_ptr<LogFile> log = open({.bytes = 6, .old_files = 0});
  for (const char* line : {"one\n", "two\n", "three is long\n", "four\n"}) EXPECT_EQ(write(*log, line), 0);
  EXPECT_EQ(text(), "four\n");
  EXPECT_FALSE(fs::exists(path(1)));
}

TEST_F(LogFileTest, ReopensAfterRemovalOrRename) {
  const std::unique_ptr<LogFile> log = open({});
  write(*log, "one\n");
  fs::rename(path(), folder / "moved");
  write(*log, "two\n");
  EXPECT_EQ(text(), "two\n");
  fs::remove(path());
  write(*log, "three\n");
  EXPECT_EQ(text(), "three\n");
  fs::remove_all(folder);
  EXPECT_EQ(write(*log, "lost\n"), ENOENT);
  fs::create_directories(folder);
  EXPECT_EQ(write(*log, "four\n"), 0);
  EXPECT_EQ(text(), "four\n");
}

TEST_F(LogFileTest, WritesNothingIfRotationFails) {
  const std::unique_ptr<LogFile> log = open({.bytes = 8, .old_files = 2});
  write(*log, "one\n");
  write(*log, "two\n");
  fs::create_directories(path(2) + "/folder");
  EXPECT_EQ(write(*log, "three\n"), EEXIST);
  EXPECT_EQ(text(), "one\ntwo\n");
  EXPECT_TRUE(fs::exists(path(2) + "/folder"));
  EXPECT_FALSE(fs::exists(path(1)));
  fs::remove_all(path(2));
  EXPECT_EQ(write(*log, "three\n"), 0);
  EXPECT_EQ(text(1) + text(), "one\ntwo\nthree\n");
}

// a file size limit of the process simulates a full disk
TEST_F(LogFileTest, ContinuesAfterAFullDisk) {
  const std::unique_ptr<LogFile> log = open({});
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  write(*log, "one\n");
  rlimit small = limit;
  small.rlim_cur = 6;
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_EQ(write(*log, "two\n"), EFBIG);
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  EXPECT_EQ(text(), "one\ntw") << "the part that fits";
  EXPECT_EQ(write(*log, "\nthree\n"), 0);
  EXPECT_EQ(text(), "one\ntw\nthree\n");
}

TEST_F(LogFileTest, ReportsWhyAFileCannotBeWritten) {
  const auto missing = LogFile::open((folder / "none/show.log").string(), {});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("No such file or directory. Create its folder first"), std::string::npos)
      << missing.error();
  const auto other = LogFile::open(folder.string(), {});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().find("must be a regular file"), std::string::npos) << other.error();
}

}  // namespace
}  // namespace limber
