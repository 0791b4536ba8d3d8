// Saves a scene while it plays. Each tick of the scene sends its version, so that the first tick of a new version and
// the gaps between ticks can be measured from outside.
#include "bench/measure/measures.h"

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "app/paths.h"
#include "app/show/scene_loader.h"
#include "base/log/log.h"
#include "bench/measure/show_folder.h"
#include "bench/measure/times.h"

namespace limber {

namespace {

constexpr const char* kScene = R"(
local arm = sim:load_urdf("{0}/urdf/{1}.urdf", {{ name = "arm" }})
for i = 1, {2} - 1 do arm:copy("arm" .. i, {{ position = vec3(2 * (i % 32), 2 * math.floor(i / 32), 0) }}) end
local target = {3}
sim:on_step(function()
  for motor in arm:motors() do motor.target = target end
  osc:send("/version", {4})
end)
)";

void save(const ShowFolder& folder, std::string_view robot, int arms, int version) {
  std::ofstream(folder.scene()) << fmt::format(kScene, app::data_dir(), robot, arms, 0.001 * version, version);
}

// a running show with its SceneLoader, and a reader of its messages
class ReloadedShow {
 public:
  explicit ReloadedShow(const std::string& scene) : engine_(link_, options_of(scene)), loader_(link_, engine_, scene) {
    started_ = engine_.start();
    if (!started_) return;
    sim_ = std::thread([this] { engine_.run(); });
    loader_.start();
  }
  ~ReloadedShow() {
    engine_.stop();
    if (sim_.joinable()) sim_.join();
    loader_.stop();
  }
  ReloadedShow(const ReloadedShow&) = delete;
  ReloadedShow& operator=(const ReloadedShow&) = delete;

  const Result<void>& started() const { return started_; }

  /// Reads messages until a tick of `version` arrives, then `more` further ticks; adds the gaps between ticks.
  void listen(int version, int more, TimeSamples& gaps) {
    bool reloaded = false;
    while (!reloaded || more > 0) {
      link_.output_queue.drain(out_);
      const double now = system::clock_seconds();
      for (const engine::Outgoing& o : out_) {
        if (o.message.address != "/version") continue;
        if (last_ > 0) gaps.add(now - last_);
        last_ = now;
        if (reloaded) more--;
        if (reloaded || static_cast<int>(o.message.args[0].number) != version) continue;
        reloaded = true;
        first_ = now;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  double first() const { return first_; }

 private:
  static engine::EngineOptions options_of(const std::string& scene) {
    engine::EngineOptions options;
    options.scene = scene;
    return options;
  }

  engine::EngineLink link_;
  engine::Engine engine_;
  app::SceneLoader loader_;
  Result<void> started_;
  std::thread sim_;
  std::vector<engine::Outgoing> out_;
  double last_ = 0;
  double first_ = 0;
};

nlohmann::ordered_json milliseconds(const TimeSamples& samples) {
  const auto at = [&](double part) { return rounded(samples.quantile(part) * 1e3, 2); };
  return {{"min", at(0)}, {"median", at(0.5)}, {"max", at(1)}};
}

nlohmann::ordered_json reload(std::string_view robot, int arms, int saves) {
  const ShowFolder folder;
  save(folder, robot, arms, 0);
  ReloadedShow played(folder.scene());
  if (!played.started()) return {{"fault", played.started().error()}};
  TimeSamples quiet;
  TimeSamples near;
  TimeSamples latency;
  played.listen(0, 10, quiet);
  for (int version = 1; version <= saves; version++) {
    const double start = system::clock_seconds();
    save(folder, robot, arms, version);
    played.listen(version, 2, near);
    latency.add(played.first() - start);
    played.listen(version, 1 + version % 7, quiet);
  }
  return {{"arms", arms},
          {"saves", saves},
          {"save_to_first_tick_ms", milliseconds(latency)},
          {"from_tick_to_tick_ms", milliseconds(quiet)},
          {"from_tick_to_tick_near_a_save_ms", milliseconds(near)}};
}

}  // namespace

nlohmann::ordered_json measure_reload(const MeasureOptions& options) {
  log_to_stderr(false);
  const int saves = options.ticks > 0 ? options.ticks : 40;
  nlohmann::ordered_json figures = {{"a few", reload("arm6", 16, saves)},
                                    {"many", reload("arm17", 1000, std::max(1, saves / 8))}};
  log_to_stderr(true);
  return figures;
}

}  // namespace limber
