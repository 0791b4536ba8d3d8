// Replays the bytes that real clients sent for tests/clients/score.lua, recorded in tests/osc/recorded. Each file
// begins with the client's version and command.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/log/log.h"
#include "engine/show.h"
#include "net/osc/receiver.h"
#include "osc/bad_packets.h"

namespace limber::osc::test {
namespace {

const std::filesystem::path kTests = std::filesystem::path(LIMBER_SOURCE_DIR) / "tests";

struct Recording {
  std::string head;
  std::vector<std::string> datagrams;
};

Recording read_recording(const std::filesystem::path& path) {
  Recording recording;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) {
      recording.head += line + "\n";
    } else {
      recording.datagrams.push_back(from_hex(line));
    }
  }
  return recording;
}

engine::EngineOptions options() {
  engine::EngineOptions options = engine::test::fast_options((kTests / "clients" / "score.lua").string());
  options.print = false;
  return options;
}

class Recorded : public testing::TestWithParam<const char*> {};

TEST_P(Recorded, ReplaysTheScore) {
  log_to_stderr(false);
  const Recording recording = read_recording(kTests / "osc" / "recorded" / (std::string(GetParam()) + ".hex"));
  ASSERT_GE(recording.datagrams.size(), 9u);
  engine::test::Show show(options());
  const NetClock clock;
  std::vector<engine::Outgoing> errors;
  Receiver receiver(show.link, {}, {.error = [&](const engine::Outgoing& out) { errors.push_back(out); }}, clock);
  const std::uint64_t before = log_newest();
  for (const std::string& datagram : recording.datagrams) {
    receiver.process(datagram.data(), datagram.size(), {0x7f000001, 5000});
    receiver.process_pending();
    show.ticks(1);
  }
  EXPECT_EQ(show.link.counters.malformed + show.link.counters.refused + show.link.counters.unknown, 0u);
  EXPECT_TRUE(errors.empty());
  std::string log;
  for (const LogLine& line : log_since(before)) log += line.text + "\n";
  EXPECT_NE(log.find("score\t-3\t0.75\t0.25\t0.5\tfalse\twild\ttrue\t4.5\tvec3(1, 2, 3)"), std::string::npos) << log;
  EXPECT_EQ(show.read("/scene/wind"), 4.5);
  const std::vector<std::string> out = show.sent_texts();
  EXPECT_EQ(std::ranges::count(out, "/score 4.5"), 1);
  EXPECT_TRUE(recording.head.starts_with("# " + std::string(GetParam()))) << recording.head;
  log_to_stderr(true);
}

INSTANTIATE_TEST_SUITE_P(All, Recorded,
                         testing::Values("sclang", "npm-osc", "npm-node-osc", "npm-osc-js", "pd", "liblo"),
                         [](const auto& info) {
                           std::string name(info.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace limber::osc::test
