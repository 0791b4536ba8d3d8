// All ways in which editors save, in a temporary folder; the test provides the clock, so it never waits.
#include "app/show/file_watch.h"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "app/program.h"
#include "base/random.h"
#include "base/system/process.h"

namespace limber::app::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

struct FileWatchModes : testing::TestWithParam<FileWatch::Mode> {
  TempFolder folder;
  FileWatch watch{GetParam()};
  FileWatch::Time now{};

  std::string path(const std::string& name) const { return folder.path() + "/" + name; }
  void follow(const Names& names) {
    std::vector<script::SourceFile> files;
    for (const std::string& name : names) files.push_back({path(name), {}});
    watch.watch(files, now);
  }
  /// Polls like the owner until all is quiet; returns every reported file name.
  Names reported() {
    Names names;
    for (int i = 0; i < 60; i++) {
      now += std::chrono::milliseconds(20);
      for (const std::string& file : watch.poll(now)) names.push_back(fs::path(file).lexically_relative(folder.path()));
    }
    return names;
  }
  /// True if a change is reported within `ms` milliseconds.
  bool reported_within(int ms) {
    const FileWatch::Time end = now + std::chrono::milliseconds(ms);
    for (; now < end; now += std::chrono::milliseconds(5)) {
      if (!watch.poll(now).empty()) return true;
    }
    return false;
  }
  void put(const std::string& name, const std::string& text) { std::ofstream(path(name), std::ios::binary) << text; }
};

// POSIX has no events
std::vector<FileWatch::Mode> modes() {
  if (system::is_portable()) return {FileWatch::Mode::polling};
  return {FileWatch::Mode::events, FileWatch::Mode::polling};
}

INSTANTIATE_TEST_SUITE_P(Ways, FileWatchModes, testing::ValuesIn(modes()),
                         [](const auto& way) { return way.param == FileWatch::Mode::events ? "Events" : "Polling"; });

TEST_P(FileWatchModes, DetectsEveryWayOfSaving) {
  put("a.lua", "0");
  put("other.txt", "0");
  follow({"a.lua"});
  EXPECT_EQ(reported(), Names{}) << "nothing happened yet";

  put("a.lua", "1");
  EXPECT_EQ(reported(), Names{"a.lua"}) << "in place";

  put("a.lua.tmp", "2");
  fs::rename(path("a.lua.tmp"), path("a.lua"));
  EXPECT_EQ(reported(), Names{"a.lua"}) << "a temporary file renamed";

  fs::rename(path("a.lua"), path("a.lua~"));
  put("a.lua", "3");
  fs::remove(path("a.lua~"));
  EXPECT_EQ(reported(), Names{"a.lua"}) << "the old file renamed, a new one created";

  fs::remove(path("a.lua"));
  put("a.lua", "4");
  EXPECT_EQ(reported(), Names{"a.lua"}) << "removed and created";

  put("b.lua", "5");
  fs::remove(path("a.lua"));
  fs::create_hard_link(path("b.lua"), path("a.lua"));
  EXPECT_EQ(reported(), Names{"a.lua"}) << "linked in place";

  put("other.txt", "1");
  put(".a.lua.swp", "x");
  EXPECT_EQ(reported(), Names{}) << "other files";
}

TEST_P(FileWatchModes, ReportsABurstOnce) {
  put("a.lua", "0");
  put("b.lua", "0");
  follow({"a.lua", "b.lua"});
  for (int i = 1; i < 10; i++) {
    put("a.lua", std::to_string(i));
    if (i == 5) put("b.lua", "5");
    now += std::chrono::milliseconds(10);
    EXPECT_EQ(watch.poll(now), Names{});
  }
  EXPECT_EQ(reported(), (Names{"a.lua", "b.lua"}));
}

TEST_P(FileWatchModes, ComparesContent) {
  put("a.lua", "same");
  follow({"a.lua"});
  put("a.lua", "same");
  EXPECT_EQ(reported(), Names{});
  put("a.lua", "else");
  put("a.lua", "same");
  EXPECT_EQ(reported(), Names{});
  // old times with new content, as after cp -p
  struct stat before {};
  stat(path("a.lua").c_str(), &before);
  put("a.lua", "emas");
  const timespec times[2] = {before.st_atim, before.st_mtim};
  utimensat(AT_FDCWD, path("a.lua").c_str(), times, 0);
  EXPECT_EQ(reported(), Names{"a.lua"});
}

TEST_P(FileWatchModes, ReportsADeletedFileWhenItReturnsChanged) {
  put("a.lua", "0");
  put("b.lua", "0");
  follow({"a.lua", "b.lua"});
  fs::remove(path("a.lua"));
  EXPECT_EQ(reported(), Names{});
  put("a.lua", "0");
  EXPECT_EQ(reported(), Names{}) << "as it was";
  fs::remove(path("a.lua"));
  EXPECT_EQ(reported(), Names{});
  put("a.lua", "1");
  EXPECT_EQ(reported(), Names{"a.lua"});
  // another report while it was missing: its return is a change
  fs::remove(path("a.lua"));
  put("b.lua", "1");
  EXPECT_EQ(reported(), Names{"b.lua"});
  put("a.lua", "1");
  EXPECT_EQ(reported(), Names{"a.lua"});
}

TEST_P(FileWatchModes, WaitsForTheWriterToClose) {
  put("a.lua", "0");
  follow({"a.lua"});
  std::ofstream out(path("a.lua"), std::ios::binary);
  out << "first" << std::flush;
  if (GetParam() == FileWatch::Mode::events) {
    EXPECT_FALSE(reported_within(400)) << "still open";
  }
  out << "second" << std::flush;
  out.close();
  EXPECT_EQ(reported(), Names{"a.lua"});
}

TEST_P(FileWatchModes, WaitsForANewFileForALimitedTime) {
  follow({"a.lua"});
  std::ofstream out(path("a.lua"), std::ios::binary);
  out << "first" << std::flush;
  if (GetParam() == FileWatch::Mode::events) {
    EXPECT_FALSE(reported_within(400));
    EXPECT_TRUE(reported_within(200)) << "it may stay open forever";
  }
  out << "second" << std::flush;
  out.close();
  EXPECT_EQ(reported(), Names{"a.lua"});
}

TEST_P(FileWatchModes, FollowsFoldersThatAreCreatedAndRemoved) {
  fs::create_directories(path("scripts"));
  put("scripts/a.lua", "0");
  follow({"scripts/a.lua", "scripts/lib/deep/b.lua"});
  fs::create_directories(path("scripts/lib/deep"));
  put("scripts/lib/deep/b.lua", "0");
  EXPECT_EQ(reported(), Names{"scripts/lib/deep/b.lua"});
  put("scripts/lib/deep/b.lua", "1");
  EXPECT_EQ(reported(), Names{"scripts/lib/deep/b.lua"});
  fs::remove_all(path("scripts/lib"));
  EXPECT_EQ(reported(), Names{});
  fs::create_directories(path("scripts/lib/deep"));
  EXPECT_EQ(reported(), Names{});
  put("scripts/lib/deep/b.lua", "2");
  EXPECT_EQ(reported(), Names{"scripts/lib/deep/b.lua"});
  // another folder replaces the whole folder
  fs::create_directories(path("next"));
  put("next/a.lua", "1");
  fs::rename(path("scripts"), path("gone"));
  EXPECT_EQ(reported(), Names{});
  fs::rename(path("next"), path("scripts"));
  EXPECT_EQ(reported(), Names{"scripts/a.lua"});
  put("scripts/a.lua", "2");
  EXPECT_EQ(reported(), Names{"scripts/a.lua"});
}

TEST_P(FileWatchModes, FollowsLinks) {
  fs::create_directories(path("real"));
  put("real/a.lua", "0");
  fs::create_symlink(path("real/a.lua"), path("a.lua"));
  follow({"a.lua"});
  put("real/a.lua", "1");
  EXPECT_EQ(reported(), Names{"a.lua"});
  fs::create_directories(path("new"));
  put("new/a.lua", "2");
  fs::remove(path("a.lua"));
  fs::create_symlink(path("new/a.lua"), path("a.lua"));
  EXPECT_EQ(reported(), Names{"a.lua"});
  put("new/a.lua", "3");
  EXPECT_EQ(reported(), Names{"a.lua"});
}

// git checkout, rsync and Syncthing replace folders like this, here far above the file
TEST_P(FileWatchModes, DetectsAReplacedParentFolder) {
  fs::create_directories(path("show/scripts/lib"));
  put("show/scripts/lib/a.lua", "0");
  follow({"show/scripts/lib/a.lua"});
  for (const char* text : {"1", "2"}) {
    fs::create_directories(path("next/scripts/lib"));
    put("next/scripts/lib/a.lua", text);
    EXPECT_EQ(reported(), Names{});
    fs::rename(path("show"), path("old"));
    fs::rename(path("next"), path("show"));
    EXPECT_EQ(reported(), Names{"show/scripts/lib/a.lua"});
    put("show/scripts/lib/a.lua", text + std::string("+"));
    EXPECT_EQ(reported(), Names{"show/scripts/lib/a.lua"});
    put("old/scripts/lib/a.lua", "no longer it");
    EXPECT_EQ(reported(), Names{});
    fs::remove_all(path("old"));
  }
  fs::remove_all(path("show"));
  EXPECT_EQ(reported(), Names{});
  fs::create_directories(path("show/scripts/lib"));
  put("show/scripts/lib/a.lua", "3");
  EXPECT_EQ(reported(), Names{"show/scripts/lib/a.lua"});
}

// deployments do this: `current` links to a release through another link
TEST_P(FileWatchModes, DetectsASwitchedLink) {
  for (const char* release : {"releases/1/show", "releases/2/show"}) fs::create_directories(path(release));
  put("releases/1/show/a.lua", "1");
  put("releases/2/show/a.lua", "2");
  const auto link_to = [this](const std::string& link, const std::string& to) {
    fs::create_symlink(to, path("link.new"));
    fs::rename(path("link.new"), path(link));
  };
  link_to("newest", "releases/1");
  link_to("current", "newest");
  follow({"current/show/a.lua"});
  EXPECT_EQ(reported(), Names{});
  link_to("newest", path("releases/2"));
  EXPECT_EQ(reported(), Names{"current/show/a.lua"});
  put("releases/2/show/a.lua", "3");
  EXPECT_EQ(reported(), Names{"current/show/a.lua"});
  link_to("current", "releases/1");
  EXPECT_EQ(reported(), Names{"current/show/a.lua"});
  put("releases/1/show/a.lua", "4");
  EXPECT_EQ(reported(), Names{"current/show/a.lua"});
  fs::rename(path("releases"), path("old"));
  EXPECT_EQ(reported(), Names{});
  fs::create_directories(path("releases/1/show"));
  put("releases/1/show/a.lua", "5");
  EXPECT_EQ(reported(), Names{"current/show/a.lua"});
}

TEST_P(FileWatchModes, HandlesLinkCycles) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  fs::create_symlink(".", path("self"));
  put("c.lua", "0");
  follow({"a/x.lua", "self/self/self/c.lua"});
  put("c.lua", "1");
  EXPECT_EQ(reported(), Names{"self/self/self/c.lua"});
}

TEST_P(FileWatchModes, ReportsFilesChangedSinceTheyWereRead) {
  put("a.lua", "new");
  put("b.lua", "b");
  watch.watch({{path("a.lua"), hash_bytes("old")}, {path("b.lua"), hash_bytes("b")}}, now);
  EXPECT_EQ(reported(), Names{"a.lua"});
  // files that stay in the set keep their last reported state
  follow({"a.lua", "b.lua", "c.lua"});
  EXPECT_EQ(reported(), Names{});
  follow({"b.lua"});
  put("a.lua", "1");
  EXPECT_EQ(reported(), Names{});
}

TEST(FileWatch, SleepsUntilAnEvent) {
  const TempFolder folder;
  folder.file("a.lua", "0");
  FileWatch watch;
  const FileWatch::Time now{};
  watch.watch({{folder.path() + "/a.lua", {}}}, now);
  if (system::is_portable()) {
    EXPECT_EQ(watch.mode(), FileWatch::Mode::polling);
    EXPECT_EQ(watch.fd(), -1);
    EXPECT_EQ(watch.next_poll(), now + FileWatch::kPollInterval);
    return;
  }
  EXPECT_EQ(watch.mode(), FileWatch::Mode::events);
  EXPECT_EQ(watch.next_poll(), std::nullopt) << "no scheduled poll";
  pollfd call{watch.fd(), POLLIN, 0};
  EXPECT_EQ(watch.poll(now), Names{}) << "other programs may do something in the folders above";
  EXPECT_EQ(watch.next_poll(), std::nullopt);
  folder.file("a.lua", "1");
  EXPECT_EQ(::poll(&call, 1, 0), 1);
  EXPECT_EQ(watch.poll(now), Names{});
  EXPECT_EQ(watch.next_poll(), now + FileWatch::kQuietPeriod);
  EXPECT_EQ(watch.poll(now + FileWatch::kQuietPeriod).size(), 1u);
  EXPECT_EQ(watch.next_poll(), std::nullopt);
  FileWatch polling(FileWatch::Mode::polling);
  polling.watch({{folder.path() + "/a.lua", {}}}, now);
  EXPECT_EQ(polling.fd(), -1);
  EXPECT_EQ(polling.next_poll(), now + FileWatch::kPollInterval);
}

}  // namespace
}  // namespace limber::app::test
