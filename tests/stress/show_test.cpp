// The program with all of its threads at once: a window, a flood of OSC messages, saves of the scene, and mouse and
// keys. A program of its own, so that the thread sanitizer runs it without the other tests of the program.
#include <atomic>
#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include "app/display.h"
#include "app/taken_port.h"
#include "osc/osc_test_tools.h"

namespace limber::app::test {
namespace {

TEST(Show, HandlesFloodReloadsAndInputTogether) {
  const Display display("640x480x24");
  const TempFolder folder;
  const auto save = [&](int number) {
    return folder.file("s.lua", fmt::format(R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1 + 0.001 * {0}), {{ mass = 1 }})
ball:add_behavior("random_force", "wind", {{ max_amp = {0} }})
sim:on_step(function() if sim.tick % 10 == 0 then print("run {0} tick " .. sim.tick) end end)
)",
                                            number));
  };
  const PortInUse sink(SOCK_DGRAM);
  Process running(limber_command({save(1), "--osc-in", "127.0.0.1:0", "--osc-out", "127.0.0.1:" + sink.port(),
                                  "--query", "off", "--size", "640x480", "--quality", "low"},
                                 display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 640 × 480")) << running.err();
  ASSERT_TRUE(running.wait_for("OSC in 127.0.0.1:"));
  ASSERT_TRUE(running.wait_for("run 1 tick 60", true)) << "by then its files are watched";
  const system::Endpoint in{0x7f000001,
                            static_cast<std::uint16_t>(std::atoi(running.text_after("OSC in 127.0.0.1:").c_str()))};
  ASSERT_NE(in.port, 0);
  const osc::test::Client client;
  std::atomic<bool> floods{true};
  std::thread flood([&] {
    for (int i = 0; floods; i++) {
      client.send(in, osc::test::one_float("/physics/body/ball/behavior/wind/max_amp", static_cast<float>(i % 7)));
      client.send(in, osc::test::one_float("/visuals/look/overlay", static_cast<float>(i % 2)));
      client.send(in, osc::test::one_float("/visuals/shape/ball/transparency", 0.01F * static_cast<float>(i % 90)));
      if (i % 50 == 0) std::this_thread::yield();
    }
  });
  for (int run = 2; run <= 6; run++) {
    save(run);
    display.xdotool({"mousemove", "320", "200", "key", "F3", "key", "F10", "mousedown", "1", "mousemove_relative", "20",
                     "10", "mouseup", "1", "key", "F2"});
    EXPECT_TRUE(running.wait_for(fmt::format("run {} tick", run), true)) << running.err();
  }
  floods = false;
  flood.join();
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("ThreadSanitizer"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test
