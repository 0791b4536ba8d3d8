// `limber play`: the first line, stdout, and the end by time, Ctrl+C or an error.
#include <memory>
#include <regex>
#include <thread>

#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app::test {
namespace {

constexpr const char* kBall = R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 10) })
)";

TEST(Play, PrintsTheFirstLineBeforeLoading) {
  const TempFolder folder;
  const std::string scene = folder.file("endless.lua", "while true do end\n");
  Process running(limber_command({scene}));
  // the scene never finishes loading: the line must be printed before
  EXPECT_TRUE(running.wait_for("limber 0.")) << running.err();
  EXPECT_TRUE(running.wait_for(scene + "\n"));
  EXPECT_EQ(running.out(), "");
}

TEST(Play, StdoutHasScriptOutputAndHash) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + "print('hello', 1, true)\nwarn('mind')\n");
  const RunResult result = run({"play", scene, "--fast", "--ticks", "5", "--hash"});
  EXPECT_EQ(result.code, 0);
  ASSERT_TRUE(result.out.starts_with("hello\t1\ttrue\nhash ")) << result.out;
  const std::string hash = result.out.substr(std::string("hello\t1\ttrue\nhash ").size());
  EXPECT_EQ(hash.substr(16), " tick 5\n");
  EXPECT_EQ(hash.substr(0, 16).find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(result.err.find("mind"), std::string::npos);
}

TEST(Play, EndsByTicksAndByTime) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kBall);
  EXPECT_NE(run({scene, "--fast", "--ticks", "90", "--hash"}).out.find(" tick 90\n"), std::string::npos);
  EXPECT_NE(run({scene, "--fast", "--duration", "1.5", "--hash"}).out.find(" tick 90\n"), std::string::npos);
  EXPECT_NE(run({scene, "--fast", "--ticks", "0", "--hash"}).out.find(" tick 0\n"), std::string::npos);
}

TEST(Play, SetsValuesBeforeTheStart) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + R"(
params { { "wind", 0, min = 0, max = 10, doc = "How hard." } }
sim:on_start(function() print(sim.gravity, sim.substeps, params.wind, ball:part("ball").position) end)
)");
  const RunResult result =
      run({scene, "--fast", "--ticks", "1", "--set", "/physics/sim/gravity=0, 0 -1.5", "--set",
           "physics/sim/substeps=7", "--set", "/scene/wind=3", "--set", "/physics/body/ball/part/ball/position=1,2,3"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "vec3(0, 0, -1.5)\t7\t3\tvec3(1, 2, 3)\n");
}

TEST(Play, CtrlCEndsCleanly) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kBall);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Process running(limber_command({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--hash"}));
    ASSERT_TRUE(running.wait_for("playing headless"));
    running.signal(signal);
    const RunResult result = running.finish();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("limber: ended at "), std::string::npos) << result.err;
    EXPECT_TRUE(result.out.starts_with("hash ")) << result.out;
  }
}

TEST(Play, RetriesPortsInUse) {
  const TempFolder folder;
  auto udp = std::make_unique<PortInUse>(SOCK_DGRAM);
  auto tcp = std::make_unique<PortInUse>(SOCK_STREAM);
  const std::string osc = "127.0.0.1:" + udp->port();
  const std::string web = "127.0.0.1:" + tcp->port();
  Process running(limber_command({folder.file("s.lua", kBall), "--headless", "--osc-optional", "--osc-in", osc,
                                  "--osc-out", "off", "--query", web}));
  ASSERT_TRUE(running.wait_for("playing headless"));
  EXPECT_NE(running.err().find("retrying every second"), std::string::npos) << running.err();
  ASSERT_TRUE(running.wait_for("OSC in 0 out"));  // a status line, which follows a retry
  ASSERT_TRUE(running.wait_for("s  tick"));
  udp.reset();
  tcp.reset();
  EXPECT_TRUE(running.wait_for("OSC in " + osc)) << running.err();
  EXPECT_TRUE(running.wait_for("remote panel http://" + web + "/")) << running.err();
  running.signal(SIGTERM);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  const std::regex reports("can't listen");
  EXPECT_EQ(std::distance(std::sregex_iterator(result.err.begin(), result.err.end(), reports), {}), 2) << result.err;
}

TEST(Play, ReportsAStallOnce) {
  const TempFolder folder;
  Process running(
      limber_command({folder.file("s.lua", kBall), "--osc-in", "off", "--osc-out", "off", "--query", "off"}));
  ASSERT_TRUE(running.wait_for("s  tick"));
  for (int i = 0; i < 2; i++) {
    running.signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    running.signal(SIGCONT);
    ASSERT_TRUE(running.wait_for("warning: the show was stalled for ")) << running.err();
  }
  running.signal(SIGTERM);
  const RunResult result = running.finish();
  const std::regex reports("the show was stalled for [0-9.]+ s");
  EXPECT_EQ(std::distance(std::sregex_iterator(result.err.begin(), result.err.end(), reports), {}), 1) << result.err;
}

// `timeout` sends both, to the program and to its group
TEST(Play, TwoSignalsEndCleanly) {
  const TempFolder folder;
  const std::string scene =
      folder.file("s.lua", std::string(kBall) + "sim:on_step(function() for i = 1, 2e6 do math.sin(i) end end)\n");
  Process running(limber_command({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--hash"}));
  ASSERT_TRUE(running.wait_for("playing headless"));
  running.signal(SIGINT);
  running.signal(SIGTERM);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("hash ")) << result.out;
}

TEST(Play, StrictExitsWith1AfterAnError) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + "sim:on_step(function() error('oh') end)\n");
  EXPECT_EQ(run({scene, "--fast", "--ticks", "20"}).code, 0) << "the show continues";
  const RunResult strict = run({scene, "--fast", "--ticks", "20", "--strict", "--hash"});
  EXPECT_EQ(strict.code, 1);
  EXPECT_NE(strict.err.find("s.lua:4"), std::string::npos) << strict.err;
  EXPECT_NE(strict.out.find(" tick 1\n"), std::string::npos) << strict.out;
  EXPECT_EQ(run({folder.file("good.lua", kBall), "--fast", "--ticks", "20", "--strict"}).code, 0);
}

TEST(Play, DefaultSceneIsArms) {
  const RunResult result = run({"--fast", "--ticks", "2", "--strict"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find(": scripts/arms.lua\n"), std::string::npos);
}

TEST(Play, FastOpensNoPortsByDefault) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kBall);
  const RunResult quiet = run({scene, "--fast", "--ticks", "1"});
  EXPECT_NE(quiet.err.find("OSC in off\nlimber: OSC out off\nlimber: OSCQuery off\n"), std::string::npos) << quiet.err;
  const PortInUse sink(SOCK_DGRAM);
  const std::string out = "127.0.0.1:" + sink.port();
  const RunResult asked = run({scene, "--fast", "--ticks", "1", "--osc-in", "127.0.0.1:0", "--osc-out", out});
  EXPECT_NE(asked.err.find("OSC in 127.0.0.1:"), std::string::npos) << asked.err;
  EXPECT_NE(asked.err.find("OSC out " + out + " (pos+rot+relrot at 60 Hz)"), std::string::npos) << asked.err;
}

}  // namespace
}  // namespace limber::app::test
