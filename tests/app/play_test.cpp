// Playing: the first line, what goes to stdout, ending by time, by Ctrl+C and by a fault.
#include <memory>
#include <regex>
#include <thread>

#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app_test {
namespace {

constexpr const char* kBall = R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 10) })
)";

TEST(Play, TheFirstLineComesBeforeTheSceneIsRead) {
  const Folder folder;
  const std::string scene = folder.file("endless.lua", "while true do end\n");
  Running running(limber({scene}));
  // the scene never ends: what is said comes before it, or never
  EXPECT_TRUE(running.wait_for("limber 0.")) << running.err();
  EXPECT_TRUE(running.wait_for(scene + "\n"));
  EXPECT_EQ(running.out(), "");
}

TEST(Play, StdoutIsTheScriptsAndTheHashs) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + "print('hello', 1, true)\nwarn('mind')\n");
  const Ran ran = run({"play", scene, "--fast", "--ticks", "5", "--hash"});
  EXPECT_EQ(ran.code, 0);
  ASSERT_TRUE(ran.out.starts_with("hello\t1\ttrue\nhash ")) << ran.out;
  const std::string hash = ran.out.substr(std::string("hello\t1\ttrue\nhash ").size());
  EXPECT_EQ(hash.substr(16), " tick 5\n");
  EXPECT_EQ(hash.substr(0, 16).find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(ran.err.find("mind"), std::string::npos);
}

TEST(Play, EndsByTicksAndByTime) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kBall);
  EXPECT_NE(run({scene, "--fast", "--ticks", "90", "--hash"}).out.find(" tick 90\n"), std::string::npos);
  EXPECT_NE(run({scene, "--fast", "--duration", "1.5", "--hash"}).out.find(" tick 90\n"), std::string::npos);
  EXPECT_NE(run({scene, "--fast", "--ticks", "0", "--hash"}).out.find(" tick 0\n"), std::string::npos);
}

TEST(Play, SetsReachTheWorldAndTheSceneSeesThem) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + R"(
params { { "wind", 0, min = 0, max = 10, doc = "How hard." } }
sim:on_start(function() print(sim.gravity, sim.substeps, params.wind, ball:part("ball").position) end)
)");
  const Ran ran =
      run({scene, "--fast", "--ticks", "1", "--set", "/physics/sim/gravity=0, 0 -1.5", "--set",
           "physics/sim/substeps=7", "--set", "/scene/wind=3", "--set", "/physics/body/ball/part/ball/position=1,2,3"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.out, "vec3(0, 0, -1.5)\t7\t3\tvec3(1, 2, 3)\n");
}

TEST(Play, CtrlCEndsCleanly) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kBall);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Running running(limber({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--hash"}));
    ASSERT_TRUE(running.wait_for("playing headless"));
    running.signal(signal);
    const Ran ran = running.finish();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("limber: ended at "), std::string::npos) << ran.err;
    EXPECT_TRUE(ran.out.starts_with("hash ")) << ran.out;
  }
}

TEST(Play, PortsThatAreTakenAreTriedAgain) {
  const Folder folder;
  auto udp = std::make_unique<TakenPort>(SOCK_DGRAM);
  auto tcp = std::make_unique<TakenPort>(SOCK_STREAM);
  const std::string osc = "127.0.0.1:" + udp->number();
  const std::string web = "127.0.0.1:" + tcp->number();
  Running running(limber({folder.file("s.lua", kBall), "--headless", "--osc-optional", "--osc-in", osc, "--osc-out",
                          "off", "--query", web}));
  ASSERT_TRUE(running.wait_for("playing headless"));
  EXPECT_NE(running.err().find("it is tried again every second"), std::string::npos) << running.err();
  ASSERT_TRUE(running.wait_for("OSC in 0 out"));  // a status line, and so another try
  ASSERT_TRUE(running.wait_for("s  tick"));
  udp.reset();
  tcp.reset();
  EXPECT_TRUE(running.wait_for("OSC in " + osc)) << running.err();
  EXPECT_TRUE(running.wait_for("remote panel http://" + web + "/")) << running.err();
  running.signal(SIGTERM);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  const std::regex reports("can't listen");
  EXPECT_EQ(std::distance(std::sregex_iterator(ran.err.begin(), ran.err.end(), reports), {}), 2) << ran.err;
}

TEST(Play, AStallIsReportedOnce) {
  const Folder folder;
  Running running(limber({folder.file("s.lua", kBall), "--osc-in", "off", "--osc-out", "off", "--query", "off"}));
  ASSERT_TRUE(running.wait_for("s  tick"));
  for (int i = 0; i < 2; i++) {
    running.signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    running.signal(SIGCONT);
    ASSERT_TRUE(running.wait_for("warning: the show stood still for ")) << running.err();
  }
  running.signal(SIGTERM);
  const Ran ran = running.finish();
  const std::regex reports("the show stood still for [0-9.]+ s");
  EXPECT_EQ(std::distance(std::sregex_iterator(ran.err.begin(), ran.err.end(), reports), {}), 1) << ran.err;
}

// as `timeout` sends them, to the program and to its group
TEST(Play, TwoSignalsAtOnceEndCleanlyToo) {
  const Folder folder;
  const std::string scene =
      folder.file("s.lua", std::string(kBall) + "sim:on_step(function() for i = 1, 2e6 do math.sin(i) end end)\n");
  Running running(limber({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--hash"}));
  ASSERT_TRUE(running.wait_for("playing headless"));
  running.signal(SIGINT);
  running.signal(SIGTERM);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(ran.out.starts_with("hash ")) << ran.out;
}

TEST(Play, StrictEndsWithOneAtAFault) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", std::string(kBall) + "sim:on_step(function() error('oh') end)\n");
  EXPECT_EQ(run({scene, "--fast", "--ticks", "20"}).code, 0) << "the show goes on";
  const Ran strict = run({scene, "--fast", "--ticks", "20", "--strict", "--hash"});
  EXPECT_EQ(strict.code, 1);
  EXPECT_NE(strict.err.find("s.lua:4"), std::string::npos) << strict.err;
  EXPECT_NE(strict.out.find(" tick 1\n"), std::string::npos) << strict.out;
  EXPECT_EQ(run({folder.file("good.lua", kBall), "--fast", "--ticks", "20", "--strict"}).code, 0);
}

TEST(Play, TheDefaultSceneIsTheArms) {
  const Ran ran = run({"--fast", "--ticks", "2", "--strict"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find(": scripts/arms.lua\n"), std::string::npos);
}

TEST(Play, FastOpensNoPortsUnlessAsked) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", kBall);
  const Ran quiet = run({scene, "--fast", "--ticks", "1"});
  EXPECT_NE(quiet.err.find("OSC in off\nlimber: OSC out off\nlimber: OSCQuery off\n"), std::string::npos) << quiet.err;
  const TakenPort sink(SOCK_DGRAM);
  const std::string out = "127.0.0.1:" + sink.number();
  const Ran asked = run({scene, "--fast", "--ticks", "1", "--osc-in", "127.0.0.1:0", "--osc-out", out});
  EXPECT_NE(asked.err.find("OSC in 127.0.0.1:"), std::string::npos) << asked.err;
  EXPECT_NE(asked.err.find("OSC out " + out + " (pos+rot+relrot at 60 Hz)"), std::string::npos) << asked.err;
}

}  // namespace
}  // namespace limber::app_test
