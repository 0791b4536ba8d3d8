// The hostile suite: each file of tests/script/hostile plays next to a healthy body for 600 ticks. The healthy body
// moves bit for bit as if it were alone, and each fault names file and line of its cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "base/text.h"
#include "stage.h"

namespace limber::script {
namespace {

namespace fs = std::filesystem;

// Two moving bodies, one of them driven; the guest script runs between them, and prints are discarded.
constexpr const char* kHealthyScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.2)
for i, name in ipairs { "healthy", "victim" } do
  sim:add_body(name):add_part("part", ball, { position = { 4 * i, 0, 0.5 }, report_contacts = true, friction = 0.4 })
end
local body, random, sin = sim:body("healthy"), rng, math.sin
local part = body.root
local touched = 0
sim:on_contact(function(what) if what == part then touched = touched + 1 end end)
require("guest")
sim:on_step(function()
  local t = sim.time
  part:apply_force(vec3(3 * sin(t * 5), 2 * sin(t * 3), 9 + 2 * sin(t * 7)) + random:direction() * 0.3)
  part.friction = 0.4 + 0.1 * touched % 3
end)
)";

// options in the first lines of a file: "-- key: value"
struct FileHeader {
  struct Expected {
    int first = 0;
    int last = 0;
    std::vector<std::string> texts;  // one of them must be in the fault
  };
  std::vector<Expected> expected;
  ScriptLimits limits;
  int messages = 0;
  int sent = -1;
  int printed = -1;
};

FileHeader header_of(const std::string& text) {
  FileHeader header;
  // A short budget for scripts that the watchdog must stop; scripts that end by themselves or by another limit get a
  // budget that no machine exceeds.
  const bool to_be_stopped = text.find(": stopped") != std::string::npos || text.find("|stopped") != std::string::npos;
  header.limits.call_ms = (to_be_stopped ? 4 : 10000) * kBudgetScale;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with("-- ");) {
    const auto value = [&](std::string_view key) -> std::string {
      const std::string start = fmt::format("-- {}: ", key);
      return line.starts_with(start) ? line.substr(start.size()) : "";
    };
    if (const std::string v = value("expect"); !v.empty()) {
      FileHeader::Expected expected;
      const std::size_t colon = v.find(": ");
      const std::string place = v.substr(0, colon);
      expected.first = std::stoi(place);
      expected.last =
          place.find('-') == std::string::npos ? expected.first : std::stoi(place.substr(place.find('-') + 1));
      for (const std::string_view one : split(std::string_view(v).substr(colon + 2), '|'))
        expected.texts.emplace_back(one);
      header.expected.push_back(expected);
    }
    if (const std::string v = value("limits"); !v.empty()) {
      for (const std::string_view word : split(v, ' ')) {
        const double number = std::stod(std::string(word.substr(word.find('=') + 1)));
        if (word.starts_with("call_ms")) header.limits.call_ms = number * kBudgetScale;
        if (word.starts_with("memory")) header.limits.memory = static_cast<std::size_t>(number) << 20u;
      }
    }
    if (const std::string v = value("messages"); !v.empty()) header.messages = std::stoi(v);
    if (const std::string v = value("sent"); !v.empty()) header.sent = std::stoi(v);
    if (const std::string v = value("printed"); !v.empty()) header.printed = std::stoi(v);
  }
  return header;
}

// the motion of the healthy body, tick by tick
struct MotionTrack {
  std::vector<std::uint64_t> hashes;
  std::vector<RecordingHost::Fault> faults;
  std::size_t sent = 0;
  std::size_t printed = 0;
};

MotionTrack play(const std::string& guest, const FileHeader& header) {
  SceneOptions options;
  options.limits = header.limits;
  ScriptFixture fixture(options);
  fixture.write("scripts/lib/guest.lua", guest);
  EXPECT_EQ(fixture.play(kHealthyScene), "");
  MotionTrack trajectory;
  for (int tick = 0; tick < 600; tick++) {
    if (tick % 100 == 50 && tick / 100 < header.messages) fixture.scene.handle_message({"/hit", {}}, {});
    fixture.tick();
    const sim::Body* const healthy = fixture.world.find_body("healthy");
    EXPECT_NE(healthy, nullptr) << "tick " << tick;
    if (healthy == nullptr) break;
    trajectory.hashes.push_back(sim::body_hash(*healthy, 0));
  }
  trajectory.faults = fixture.host.faults;
  trajectory.sent = fixture.host.sent.size() + fixture.host.replies.size();
  trajectory.printed = fixture.host.printed.size();
  return trajectory;
}

std::vector<fs::path> hostile_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(LIMBER_SOURCE_DIR "/tests/script/hostile")) files.push_back(entry);
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const MotionTrack& alone() {
  static const MotionTrack trajectory = play("-- empty", header_of(""));
  return trajectory;
}

class HostileScript : public testing::TestWithParam<fs::path> {};

TEST_P(HostileScript, DoesNotAffectTheHealthyBody) {
  const std::string text = text_of_file(GetParam());
  const FileHeader header = header_of(text);
  const MotionTrack trajectory = play(text, header);
  const auto [mine, theirs] = std::ranges::mismatch(trajectory.hashes, alone().hashes);
  EXPECT_TRUE(mine == trajectory.hashes.end() && theirs == alone().hashes.end())
      << "the healthy body differs from tick " << mine - trajectory.hashes.begin();
  for (std::size_t i = 0; i < std::max(trajectory.faults.size(), header.expected.size()); i++) {
    ASSERT_LT(i, trajectory.faults.size()) << "one fault fewer than expected";
    const RecordingHost::Fault& fault = trajectory.faults[i];
    ASSERT_LT(i, header.expected.size()) << "unexpected fault: " << fault.text;
    const FileHeader::Expected& expected = header.expected[i];
    EXPECT_EQ(fault.file, "scripts/lib/guest.lua") << fault.text;
    EXPECT_TRUE(fault.line >= expected.first && fault.line <= expected.last) << fault.text;
    const std::string line = first_line(fault.text);
    EXPECT_EQ(line.find(fmt::format("scripts/lib/guest.lua:{}: ", fault.line)), 0u) << line;
    EXPECT_TRUE(std::ranges::any_of(expected.texts, [&](const std::string& t) { return line.find(t) != line.npos; }))
        << line;
    EXPECT_LT(fault.text.size(), 10000u);
  }
  if (header.sent >= 0) {
    EXPECT_EQ(trajectory.sent, static_cast<std::size_t>(header.sent));
  }
  if (header.printed >= 0) {
    EXPECT_EQ(trajectory.printed, static_cast<std::size_t>(header.printed));
  }
}

INSTANTIATE_TEST_SUITE_P(Each, HostileScript, testing::ValuesIn(hostile_files()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(HostileSuite, HasEnoughScripts) {
  std::size_t endless = 0;
  for (const fs::path& file : hostile_files()) endless += file.stem().string().starts_with("endless") ? 1 : 0;
  EXPECT_GE(hostile_files().size(), 60u);
  EXPECT_GE(endless, 30u);
}

TEST(HostileSuite, TheHealthyBodyMoves) {
  // otherwise the other tests would be meaningless
  std::vector<std::uint64_t> hashes = alone().hashes;
  ASSERT_EQ(hashes.size(), 600u);
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::unique(hashes.begin(), hashes.end()), hashes.end());
}

}  // namespace
}  // namespace limber::script
