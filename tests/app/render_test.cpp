// Still images and films: without a display, at exact times, equal to a headless run, and complete after cancellation.
#include <unistd.h>

#include <algorithm>

#include "app/program.h"

namespace limber::app::test {
namespace {

// a ball that falls past the camera; prints a line at tick 20
constexpr const char* kFall = R"(
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.3), { position = vec3(0, 0, 3) })
sim:on_step(function() if sim.tick == 20 then print("begun") end end)
)";

std::vector<std::string> names(const std::string& folder) {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) all.push_back(entry.path().filename());
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::string> small(std::vector<std::string> args, const std::vector<std::string>& variables = {}) {
  args.insert(args.end(), {"--size", "32x18", "--quality", "low"});
  std::vector<std::string> before = without_leak_check();
  before.insert(before.end(), variables.begin(), variables.end());
  return limber_command(std::move(args), std::move(before));
}

bool has_ffmpeg() { return Process({"sh", "-c", "command -v ffmpeg && command -v ffprobe"}).finish().code == 0; }

TEST(Render, FrameKShowsTheTimeKByFps) {
  const TempFolder folder;
  const std::string scene = folder.file("fall.lua", kFall);
  const std::string shots = folder.file("shots/note", "");
  const std::string pattern = folder.path() + "/shots/shot_%03d.png";
  const RunResult film =
      Process(small({scene, "--render", pattern, "--fps", "25", "--duration", "0.4", "--hash"})).finish();
  EXPECT_EQ(film.code, 0) << film.err;
  EXPECT_EQ(names(folder.path() + "/shots").size(), 11u) << "ten frames and the note";
  EXPECT_EQ(film.out.substr(film.out.find("hash")),
            run({scene, "--fast", "--duration", "0.4", "--hash"}).out.substr(film.out.find("hash")))
      << "the world is that of a headless run";
  for (const int frame : {0, 3, 7}) {  // 7/25 s is between two ticks
    const std::string still = fmt::format("{}/still_{}.png", folder.path(), frame);
    const RunResult shot =
        Process(small({scene, "--screenshot", still, "--at", fmt::format("{}", frame / 25.0)})).finish();
    EXPECT_EQ(shot.code, 0) << shot.err;
    EXPECT_EQ(content(still), content(fmt::format("{}/shots/shot_{:03}.png", folder.path(), frame))) << frame;
  }
  EXPECT_NE(content(folder.path() + "/shots/shot_003.png"), content(folder.path() + "/shots/shot_007.png"));
}

TEST(Render, VideoHasAllFrames) {
  const TempFolder folder;
  const std::string scene = folder.file("fall.lua", kFall);
  const std::string video = folder.path() + "/fall.mp4";
  const RunResult film = Process(small({scene, "--render", video, "--fps", "60", "--seconds", "0.5"})).finish();
  if (!has_ffmpeg()) {
    EXPECT_EQ(film.code, 3);
    EXPECT_NE(film.err.find("apt-get install ffmpeg"), std::string::npos) << film.err;
    return;
  }
  EXPECT_EQ(film.code, 0) << film.err;
  const RunResult probe = Process({"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                   "stream=nb_read_frames,width,height,r_frame_rate", "-of", "csv=p=0", video})
                              .finish();
  EXPECT_EQ(probe.out, "32,18,60/1,30\n") << probe.err;
  EXPECT_EQ(names(folder.path()), (std::vector<std::string>{"fall.lua", "fall.mp4"})) << "nothing else is left";
}

TEST(Render, ReportsMissingFfmpeg) {
  const TempFolder folder;
  const std::string scene = folder.file("fall.lua", kFall);
  const std::string video = folder.path() + "/fall.mp4";
  const RunResult film = Process(small({scene, "--render", video, "--duration", "0.1"}, {"PATH=/nowhere"})).finish();
  EXPECT_EQ(film.code, 3);
  EXPECT_NE(film.err.find("apt-get install ffmpeg"), std::string::npos) << film.err;
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"fall.lua"});
}

TEST(Render, CtrlCLeavesAValidFilm) {
  for (const bool video : {true, false}) {
    if (video && !has_ffmpeg()) continue;
    const TempFolder folder;
    const std::string scene = folder.file("fall.lua", kFall);
    const std::string name = folder.path() + (video ? "/fall.mp4" : "/shot_%05d.png");
    Process running(small({scene, "--render", name, "--duration", "1000"}));
    ASSERT_TRUE(running.wait_for("begun", true)) << running.err();
    running.signal(SIGINT);
    const RunResult result = running.finish();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("cancelled"), std::string::npos) << result.err;
    for (const std::string& file : names(folder.path())) {
      EXPECT_EQ(file.find(".part"), std::string::npos) << file;
      if (file.ends_with(".png")) {
        EXPECT_TRUE(content(folder.path() + "/" + file).ends_with("IEND\xae\x42\x60\x82"));
      }
    }
    if (video) {
      EXPECT_EQ(Process({"ffprobe", "-v", "error", name}).finish().code, 0);
    }
  }
}

TEST(Render, ReportsIgnoredNetworkOptions) {
  const TempFolder folder;
  const std::string scene = folder.file("fall.lua", kFall);
  const auto stderr_of = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {scene, "--screenshot", folder.path() + "/still.png"});
    const RunResult result = Process(small(more)).finish();
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_NE(stderr_of({"--osc-in", "9100", "--query", "9101"}).find("--osc-in, --query are ignored"),
            std::string::npos);
  EXPECT_EQ(stderr_of({"--osc-in", "off", "--osc-out", "off"}).find("ignored"), std::string::npos);
}

TEST(Render, ReportsAPausedSimulation) {
  const TempFolder folder;
  const std::string scene = folder.file("fall.lua", kFall);
  const RunResult result = Process(small({scene, "--screenshot", folder.path() + "/a.png", "--at", "1", "--set",
                                          "/physics/sim/paused=true"}))
                               .finish();
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find("the simulation is paused"), std::string::npos) << result.err;
}

TEST(Render, ErrorsNameTheFix) {
  struct Case {
    std::vector<std::string> args;
    const char* message;
  };
  const Case cases[] = {
      {{"--render", "a.mp4"}, "--duration"},
      {{"--render", "a.gif", "--duration", "1"}, "shot_%05d.png"},
      {{"--render", "a_%d_%d.png", "--duration", "1"}, "shot_%05d.png"},
      {{"--render", "a_%s.png", "--duration", "1"}, "shot_%05d.png"},
      {{"--render", "a.mp4", "--duration", "1", "--size", "33x18"}, "34x18"},
      {{"--screenshot", "a.jpg"}, ".png"},
      {{"--screenshot", "a.png", "--size", "0x9"}, "1280x720"},
      {{"--screenshot", "a.png", "--size", "10x20x30"}, "1280x720"},
      {{"--screenshot", "a.png", "--size", "99999x9"}, "16384"},
      {{"--screenshot", "a.png", "--render", "a.mp4", "--duration", "1"}, "exclude each other"},
      {{"--at", "2"}, "--screenshot"},
      {{"--fps", "2"}, "--render"},
      {{"--quality", "best"}, "low"},
  };
  for (const Case& c : cases) {
    const RunResult result = run(c.args);
    EXPECT_EQ(result.code, 2) << c.args[0] << " " << result.err;
    EXPECT_NE(result.err.find(c.message), std::string::npos) << result.err;
  }
  const TempFolder folder;
  const RunResult nowhere = Process(small({folder.file("s.lua", kFall), "--screenshot", "/nowhere/a.png"})).finish();
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_NE(nowhere.err.find("'/nowhere/a.png'"), std::string::npos) << nowhere.err;
}

}  // namespace
}  // namespace limber::app::test
