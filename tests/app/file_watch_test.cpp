// Every editor's way of saving, on a folder of its own; the clock is the test's, so nobody waits.
#include "app/file_watch.h"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "app/program.h"
#include "base/random.h"
#include "base/system/process.h"

namespace limber::app_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

struct Watched : testing::TestWithParam<FileWatch::Way> {
  Folder folder;
  FileWatch watch{GetParam()};
  FileWatch::Time now{};

  std::string path(const std::string& name) const { return folder.path() + "/" + name; }
  void follow(const Names& names) {
    std::vector<SourceFile> files;
    for (const std::string& name : names) files.push_back({path(name), {}});
    watch.watch(files, now);
  }
  /// Called as its owner would, until all is quiet: what was told, by file name, each with how often.
  Names told() {
    Names names;
    for (int i = 0; i < 60; i++) {
      now += std::chrono::milliseconds(20);
      for (const std::string& file : watch.poll(now)) names.push_back(fs::path(file).lexically_relative(folder.path()));
    }
    return names;
  }
  /// Whether something is told within so many milliseconds.
  bool told_within(int ms) {
    const FileWatch::Time end = now + std::chrono::milliseconds(ms);
    for (; now < end; now += std::chrono::milliseconds(5)) {
      if (!watch.poll(now).empty()) return true;
    }
    return false;
  }
  void put(const std::string& name, const std::string& text) { std::ofstream(path(name), std::ios::binary) << text; }
};

// POSIX has no events
std::vector<FileWatch::Way> ways() {
  if (system::is_portable()) return {FileWatch::Way::polling};
  return {FileWatch::Way::events, FileWatch::Way::polling};
}

INSTANTIATE_TEST_SUITE_P(Ways, Watched, testing::ValuesIn(ways()),
                         [](const auto& way) { return way.param == FileWatch::Way::events ? "Events" : "Polling"; });

TEST_P(Watched, EveryWayOfSaving) {
  put("a.lua", "0");
  put("other.txt", "0");
  follow({"a.lua"});
  EXPECT_EQ(told(), Names{}) << "nothing happened yet";

  put("a.lua", "1");
  EXPECT_EQ(told(), Names{"a.lua"}) << "in place";

  put("a.lua.tmp", "2");
  fs::rename(path("a.lua.tmp"), path("a.lua"));
  EXPECT_EQ(told(), Names{"a.lua"}) << "a temporary file renamed";

  fs::rename(path("a.lua"), path("a.lua~"));
  put("a.lua", "3");
  fs::remove(path("a.lua~"));
  EXPECT_EQ(told(), Names{"a.lua"}) << "the old one renamed, a new one made";

  fs::remove(path("a.lua"));
  put("a.lua", "4");
  EXPECT_EQ(told(), Names{"a.lua"}) << "unlinked and made again";

  put("b.lua", "5");
  fs::remove(path("a.lua"));
  fs::create_hard_link(path("b.lua"), path("a.lua"));
  EXPECT_EQ(told(), Names{"a.lua"}) << "linked in place";

  put("other.txt", "1");
  put(".a.lua.swp", "x");
  EXPECT_EQ(told(), Names{}) << "what else lies there";
}

TEST_P(Watched, ABurstIsOneTelling) {
  put("a.lua", "0");
  put("b.lua", "0");
  follow({"a.lua", "b.lua"});
  for (int i = 1; i < 10; i++) {
    put("a.lua", std::to_string(i));
    if (i == 5) put("b.lua", "5");
    now += std::chrono::milliseconds(10);
    EXPECT_EQ(watch.poll(now), Names{});
  }
  EXPECT_EQ(told(), (Names{"a.lua", "b.lua"}));
}

TEST_P(Watched, TheContentDecides) {
  put("a.lua", "same");
  follow({"a.lua"});
  put("a.lua", "same");
  EXPECT_EQ(told(), Names{});
  put("a.lua", "else");
  put("a.lua", "same");
  EXPECT_EQ(told(), Names{});
  // old times on a new content, as cp -p leaves them
  struct stat before {};
  stat(path("a.lua").c_str(), &before);
  put("a.lua", "emas");
  const timespec times[2] = {before.st_atim, before.st_mtim};
  utimensat(AT_FDCWD, path("a.lua").c_str(), times, 0);
  EXPECT_EQ(told(), Names{"a.lua"});
}

TEST_P(Watched, ADeletedFileIsToldWhenItIsBackWithAnotherContent) {
  put("a.lua", "0");
  put("b.lua", "0");
  follow({"a.lua", "b.lua"});
  fs::remove(path("a.lua"));
  EXPECT_EQ(told(), Names{});
  put("a.lua", "0");
  EXPECT_EQ(told(), Names{}) << "as it was";
  fs::remove(path("a.lua"));
  EXPECT_EQ(told(), Names{});
  put("a.lua", "1");
  EXPECT_EQ(told(), Names{"a.lua"});
  // somebody has looked while it was gone: its return is news
  fs::remove(path("a.lua"));
  put("b.lua", "1");
  EXPECT_EQ(told(), Names{"b.lua"});
  put("a.lua", "1");
  EXPECT_EQ(told(), Names{"a.lua"});
}

TEST_P(Watched, AWriterInTwoChunks) {
  put("a.lua", "0");
  follow({"a.lua"});
  std::ofstream out(path("a.lua"), std::ios::binary);
  out << "first" << std::flush;
  if (GetParam() == FileWatch::Way::events) {
    EXPECT_FALSE(told_within(400)) << "nobody has closed it yet";
  }
  out << "second" << std::flush;
  out.close();
  EXPECT_EQ(told(), Names{"a.lua"});
}

TEST_P(Watched, AFileThatIsMadeAndNotClosedYetIsWaitedForAWhile) {
  follow({"a.lua"});
  std::ofstream out(path("a.lua"), std::ios::binary);
  out << "first" << std::flush;
  if (GetParam() == FileWatch::Way::events) {
    EXPECT_FALSE(told_within(400));
    EXPECT_TRUE(told_within(200)) << "it may stay open for ever";
  }
  out << "second" << std::flush;
  out.close();
  EXPECT_EQ(told(), Names{"a.lua"});
}

TEST_P(Watched, FoldersThatComeAndGo) {
  fs::create_directories(path("scripts"));
  put("scripts/a.lua", "0");
  follow({"scripts/a.lua", "scripts/lib/deep/b.lua"});
  fs::create_directories(path("scripts/lib/deep"));
  put("scripts/lib/deep/b.lua", "0");
  EXPECT_EQ(told(), Names{"scripts/lib/deep/b.lua"});
  put("scripts/lib/deep/b.lua", "1");
  EXPECT_EQ(told(), Names{"scripts/lib/deep/b.lua"});
  fs::remove_all(path("scripts/lib"));
  EXPECT_EQ(told(), Names{});
  fs::create_directories(path("scripts/lib/deep"));
  EXPECT_EQ(told(), Names{});
  put("scripts/lib/deep/b.lua", "2");
  EXPECT_EQ(told(), Names{"scripts/lib/deep/b.lua"});
  // the whole folder is put in the place of the old one
  fs::create_directories(path("next"));
  put("next/a.lua", "1");
  fs::rename(path("scripts"), path("gone"));
  EXPECT_EQ(told(), Names{});
  fs::rename(path("next"), path("scripts"));
  EXPECT_EQ(told(), Names{"scripts/a.lua"});
  put("scripts/a.lua", "2");
  EXPECT_EQ(told(), Names{"scripts/a.lua"});
}

TEST_P(Watched, ALinksTargetCounts) {
  fs::create_directories(path("real"));
  put("real/a.lua", "0");
  fs::create_symlink(path("real/a.lua"), path("a.lua"));
  follow({"a.lua"});
  put("real/a.lua", "1");
  EXPECT_EQ(told(), Names{"a.lua"});
  fs::create_directories(path("new"));
  put("new/a.lua", "2");
  fs::remove(path("a.lua"));
  fs::create_symlink(path("new/a.lua"), path("a.lua"));
  EXPECT_EQ(told(), Names{"a.lua"});
  put("new/a.lua", "3");
  EXPECT_EQ(told(), Names{"a.lua"});
}

// as git checkout, rsync and Syncthing replace folders: one far above the file
TEST_P(Watched, AFolderAboveIsReplaced) {
  fs::create_directories(path("show/scripts/lib"));
  put("show/scripts/lib/a.lua", "0");
  follow({"show/scripts/lib/a.lua"});
  for (const char* text : {"1", "2"}) {
    fs::create_directories(path("next/scripts/lib"));
    put("next/scripts/lib/a.lua", text);
    EXPECT_EQ(told(), Names{});
    fs::rename(path("show"), path("old"));
    fs::rename(path("next"), path("show"));
    EXPECT_EQ(told(), Names{"show/scripts/lib/a.lua"});
    put("show/scripts/lib/a.lua", text + std::string("+"));
    EXPECT_EQ(told(), Names{"show/scripts/lib/a.lua"});
    put("old/scripts/lib/a.lua", "no longer it");
    EXPECT_EQ(told(), Names{});
    fs::remove_all(path("old"));
  }
  fs::remove_all(path("show"));
  EXPECT_EQ(told(), Names{});
  fs::create_directories(path("show/scripts/lib"));
  put("show/scripts/lib/a.lua", "3");
  EXPECT_EQ(told(), Names{"show/scripts/lib/a.lua"});
}

// as releases are deployed: `current` leads to one of them, over another link
TEST_P(Watched, ALinkOnTheWayIsSwitched) {
  for (const char* release : {"releases/1/show", "releases/2/show"}) fs::create_directories(path(release));
  put("releases/1/show/a.lua", "1");
  put("releases/2/show/a.lua", "2");
  const auto lead = [this](const std::string& link, const std::string& to) {
    fs::create_symlink(to, path("link.new"));
    fs::rename(path("link.new"), path(link));
  };
  lead("newest", "releases/1");
  lead("current", "newest");
  follow({"current/show/a.lua"});
  EXPECT_EQ(told(), Names{});
  lead("newest", path("releases/2"));
  EXPECT_EQ(told(), Names{"current/show/a.lua"});
  put("releases/2/show/a.lua", "3");
  EXPECT_EQ(told(), Names{"current/show/a.lua"});
  lead("current", "releases/1");
  EXPECT_EQ(told(), Names{"current/show/a.lua"});
  put("releases/1/show/a.lua", "4");
  EXPECT_EQ(told(), Names{"current/show/a.lua"});
  fs::rename(path("releases"), path("old"));
  EXPECT_EQ(told(), Names{});
  fs::create_directories(path("releases/1/show"));
  put("releases/1/show/a.lua", "5");
  EXPECT_EQ(told(), Names{"current/show/a.lua"});
}

TEST_P(Watched, LinksInACircleEnd) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  fs::create_symlink(".", path("self"));
  put("c.lua", "0");
  follow({"a/x.lua", "self/self/self/c.lua"});
  put("c.lua", "1");
  EXPECT_EQ(told(), Names{"self/self/self/c.lua"});
}

TEST_P(Watched, WhatWasReadMayBeOldAlready) {
  put("a.lua", "new");
  put("b.lua", "b");
  watch.watch({{path("a.lua"), hash_bytes("old")}, {path("b.lua"), hash_bytes("b")}}, now);
  EXPECT_EQ(told(), Names{"a.lua"});
  // files that go on to count keep what was told of them
  follow({"a.lua", "b.lua", "c.lua"});
  EXPECT_EQ(told(), Names{});
  follow({"b.lua"});
  put("a.lua", "1");
  EXPECT_EQ(told(), Names{});
}

TEST(FileWatch, SleepsUntilSomethingHappens) {
  const Folder folder;
  folder.file("a.lua", "0");
  FileWatch watch;
  const FileWatch::Time now{};
  watch.watch({{folder.path() + "/a.lua", {}}}, now);
  if (system::is_portable()) {
    EXPECT_EQ(watch.way(), FileWatch::Way::polling);
    EXPECT_EQ(watch.fd(), -1);
    EXPECT_EQ(watch.due(), now + FileWatch::kLook);
    return;
  }
  EXPECT_EQ(watch.way(), FileWatch::Way::events);
  EXPECT_EQ(watch.due(), std::nullopt) << "no time at which it must be called";
  pollfd call{watch.fd(), POLLIN, 0};
  EXPECT_EQ(watch.poll(now), Names{}) << "other programs may do something in the folders above";
  EXPECT_EQ(watch.due(), std::nullopt);
  folder.file("a.lua", "1");
  EXPECT_EQ(::poll(&call, 1, 0), 1);
  EXPECT_EQ(watch.poll(now), Names{});
  EXPECT_EQ(watch.due(), now + FileWatch::kQuiet);
  EXPECT_EQ(watch.poll(now + FileWatch::kQuiet).size(), 1u);
  EXPECT_EQ(watch.due(), std::nullopt);
  FileWatch polling(FileWatch::Way::polling);
  polling.watch({{folder.path() + "/a.lua", {}}}, now);
  EXPECT_EQ(polling.fd(), -1);
  EXPECT_EQ(polling.due(), now + FileWatch::kLook);
}

}  // namespace
}  // namespace limber::app_test
