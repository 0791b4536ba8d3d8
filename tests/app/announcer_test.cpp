// Announcing ports by zeroconf, with a program in place of avahi-publish.
#include "app/service/announcer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <thread>

#include "app/program.h"
#include "base/log/log.h"

namespace limber::app::test {
namespace {

// Lines that a program has written to a file, when there are `count`, or after a minute. Calls `meanwhile` while it
// waits.
std::multiset<std::string> lines_of(
    const std::string& file, std::size_t count, const std::function<void()>& meanwhile = [] {}) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  for (;;) {
    std::multiset<std::string> lines;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) lines.insert(line);
    if (lines.size() >= count || std::chrono::steady_clock::now() > limit) return lines;
    meanwhile();
    std::this_thread::yield();
  }
}

std::string program(const TempFolder& folder, const std::string& name, const std::string& script) {
  const std::string path = folder.file(name, "#!/bin/sh\n" + script);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

TEST(Announcer, AnnouncesThePortsAndWhatHasChanged) {
  const TempFolder folder;
  const std::string calls = folder.path() + "/calls";
  Announcer announcer("Stage left", program(folder, "publish", "echo \"$*\" >> " + calls + "\nexec sleep 600\n"));
  const AnnouncedPort osc{"_osc._udp", 9003};
  announcer.update({osc, {"_oscjson._tcp", 9003}});
  EXPECT_EQ(lines_of(calls, 2),
            (std::multiset<std::string>{"-s Stage left _osc._udp 9003", "-s Stage left _oscjson._tcp 9003"}));
  announcer.update({osc, {"_oscjson._tcp", 9004}});
  EXPECT_EQ(lines_of(calls, 3).count("-s Stage left _oscjson._tcp 9004"), 1u);
  EXPECT_EQ(lines_of(calls, 3).size(), 3u) << "the other one runs on";
}

TEST(Announcer, AProgramThatEndsIsStartedAgainAndReportedOnce) {
  log_to_stderr(false);
  const TempFolder folder;
  const std::string calls = folder.path() + "/calls";
  Announcer announcer("a", program(folder, "publish", "echo \"$*\" >> " + calls + "\n"));
  const std::uint64_t before = log_newest();
  EXPECT_GE(lines_of(calls, 3, [&] { announcer.update({{"_osc._udp", 1}}); }).size(), 3u);
  const std::vector<LogLine> lines = log_since(before);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].text.find("doesn't announce 'a': it has ended; is the Avahi daemon running?"), std::string::npos)
      << lines[0].text;
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::app::test
