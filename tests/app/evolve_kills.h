// A search whose processes are killed at random moments.
#pragma once

#include <sys/wait.h>

#include <csignal>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/program.h"
#include "base/random.h"

namespace limber::app::test {

/// A search over a ball without gravity that is pushed at the start, with noise, so that elites are often replaced.
class KilledSearch {
 public:
  /// `search`: the options of the algorithm.
  explicit KilledSearch(int generations, std::vector<std::string> search = {"--descriptor", "distance"})
      : generations_(generations), search_(std::move(search)) {
    folder_.file("push.lua", R"(
params { { "push", 1, min = 0, max = 4 }, { "mass", 1, min = 0.5, max = 2, rerun = true } }
sim.gravity = vec3()
local part = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = params.mass })
sim:on_start(function() part:apply_impulse(vec3(params.push, 0, 0)) end)
result("distance", function() return part.position.x end, { min = 0, max = 4, cells = 30 })
result("noise", function() return rng:uniform() + part.position.x end)
)");
  }

  /// Runs without a kill.
  void run_whole() const { EXPECT_EQ(Process(command("whole"), folder_.path()).finish().code, 0); }

  /// Kills this number of child processes, one after each saved generation at most.
  void run_with_killed_children(int kills) {
    Process process(command("children"), folder_.path());
    const std::string list = fmt::format("/proc/{}/task/{}/children", process.pid(), process.pid());
    std::string seen;
    int killed = 0;
    for (; killed < kills && !ended(process); usleep(500)) {
      const std::string state = content(file("children", "state.json"));
      if (state == seen) continue;
      seen = state;
      std::vector<pid_t> children;
      std::istringstream pids(content(list));
      for (pid_t pid = 0; pids >> pid;) children.push_back(pid);
      if (children.empty()) continue;
      ::kill(children[random_.next() % children.size()], SIGKILL);
      killed++;
    }
    const RunResult result = process.finish();
    EXPECT_EQ(killed, kills);
    EXPECT_EQ(result.code, 0) << result.err;
  }

  /// Kills the whole search this number of times, each time a random number of generations after it was resumed.
  void run_with_killed_jobs(int kills) {
    std::string saved;
    for (int i = 0; i < kills; i++) {
      Process process(command("jobs", !saved.empty()), folder_.path());
      for (auto left = 1 + random_.next() % 3; left > 0 && !ended(process); usleep(200)) {
        const std::string state = content(file("jobs", "state.json"));
        if (state == saved) continue;
        saved = state;
        left--;
      }
      usleep(static_cast<useconds_t>(random_.next() % 20'000));  // anywhere within a generation
      EXPECT_FALSE(ended(process)) << "the search has too few generations";
      process.signal(SIGKILL);
      (void)process.finish();
    }
    const RunResult result = Process(command("jobs", !saved.empty()), folder_.path()).finish();
    EXPECT_EQ(result.code, 0) << result.err;
  }

  void expect_same(const std::string& out) const {
    for (const char* name : {"elites.csv", "elites.presets.json", "state.json"}) {
      EXPECT_FALSE(content(file("whole", name)).empty()) << name;
      EXPECT_TRUE(content(file("whole", name)) == content(file(out, name))) << out << "/" << name;
    }
  }

 private:
  std::vector<std::string> command(const std::string& out, bool resume = false) const {
    std::vector<std::string> words{
        "evolve", "push.lua", "--maximize", "noise", "--duration", "0.1",           "--population",
        "4",      "--jobs",   "2",          "--out", out,          "--generations", std::to_string(generations_)};
    words.insert(words.end(), search_.begin(), search_.end());
    if (resume) words.emplace_back("--resume");
    return limber_command(words);
  }
  std::string file(const std::string& out, const std::string& name) const {
    return folder_.path() + "/" + out + "/" + name;
  }
  static bool ended(const Process& process) {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(process.pid()), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid != 0;
  }

  TempFolder folder_;
  int generations_;
  std::vector<std::string> search_;
  Random random_{1, "kills"};
};

}  // namespace limber::app::test
