// Builds arms from urdf/arm17.urdf, doubles their number until a tick takes too long, and interpolates.
#include "app/commands/commands.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/paths.h"
#include "base/build_info.h"
#include "base/check.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/clock.h"
#include "base/system/process.h"
#include "base/text.h"
#include "engine/engine.h"
#include "model/model_library.h"
#include "sim/shapes/shape_list.h"
#include "sim/world/body.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kTick = 1.0 / 60;  // duration of a tick in real time, s
constexpr int kWarmTicks = 20;
constexpr int kFewest = 4;
constexpr int kMost = 4096;
// Real time means that 19 of 20 ticks are in time.
constexpr double kInTime = 0.95;

struct Setting {
  const char* solver;  // value of sim.solver
  int threads;
};

using Model = std::shared_ptr<const model::BodyModel>;

// Arms on a floor, two meters apart. All servos follow a wave.
class PlayedArms {
 public:
  PlayedArms(const Model& model, int count, const Setting& setting) : engine_(link_, engine_options(setting)) {
    LIMBER_CHECK(engine_.start().ok());
    sim::World& world = engine_.world();
    const double direct = std::string_view(setting.solver) == "direct" ? 1 : 0;
    LIMBER_CHECK(world.store().set(world.id(), "solver", {&direct, 1}).ok());
    model::ShapeModel plane;
    plane.kind = model::ShapeKind::plane;
    sim::Shape& ground = **world.shapes().add("ground", plane);
    LIMBER_CHECK((*world.add_body("floor"))->add_part("ground", ground, 0, Pose{}).ok());
    sim::Body& first = **world.add_body(model, "arm1", sim::BuildOptions{});
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 1; i < count; i++) {
      sim::Body& copy = **world.copy_body(first, fmt::format("arm{}", i + 1));
      const int row = i / side;
      Pose pose = copy.pose();
      pose.position += Vec3(2.0 * (i % side), 2.0 * row, 0);
      copy.set_pose(pose);
    }
  }
  // Plays a tick and returns its duration in seconds.
  double tick() {
    const double start = system::clock_seconds();
    const double time = engine_.world().time();
    const double amplitude = 0.3 * std::min(1.0, time);  // rad
    for (const auto& body : engine_.world().bodies()) {
      double phase = 0;
      for (const auto& motor : body->motors()) {
        motor->set_target(amplitude * fixed::sin(kPi * time + phase));
        phase += 0.4;
      }
    }
    engine_.tick();
    return system::clock_seconds() - start;
  }

 private:
  static engine::EngineOptions engine_options(const Setting& setting) {
    engine::EngineOptions options;
    options.threads = setting.threads;
    return options;
  }

  engine::EngineLink link_;
  engine::Engine engine_;
};

struct Measurement {
  int arms;
  double tick;  // s
};

Measurement measure_arms(const Model& model, int count, const Setting& setting, int ticks) {
  PlayedArms arms(model, count, setting);
  for (int i = 0; i < kWarmTicks; i++) arms.tick();
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; i++) times.push_back(arms.tick());
  std::sort(times.begin(), times.end());
  return {count, times[static_cast<std::size_t>(kInTime * (ticks - 1))]};
}

// Returns the number of arms whose tick takes kTick, from the last two measurements. Two digits are significant.
int arms_in_real_time(const std::vector<Measurement>& all) {
  const Measurement& last = all.back();
  if (last.tick <= kTick) return last.arms;
  const Measurement before = all.size() > 1 ? all[all.size() - 2] : Measurement{0, 0};
  const double arms = before.arms + (last.arms - before.arms) * (kTick - before.tick) / (last.tick - before.tick);
  const int unit = arms < 100 ? 1 : arms < 1000 ? 10 : 100;
  return static_cast<int>(arms) / unit * unit;
}

Json measure_setting(const Model& model, const Setting& setting, int ticks) {
  std::vector<Measurement> all;
  Json measured = Json::array();
  for (int count = kFewest; count <= kMost && (all.empty() || all.back().tick <= kTick); count *= 2) {
    all.push_back(measure_arms(model, count, setting, ticks));
    measured.push_back({{"arms", count}, {"tick_ms", std::round(all.back().tick * 1e5) / 100}});
  }
  return {{"solver", setting.solver},
          {"threads", setting.threads},
          {"arms_in_real_time", arms_in_real_time(all)},
          {"measured", measured}};
}

std::vector<Setting> settings(int cores) {
  std::vector<Setting> all;
  for (const char* solver : {"direct", "iterative"}) {
    all.push_back({solver, 1});
    if (cores > 1) all.push_back({solver, cores});
  }
  return all;
}

}  // namespace

int bench_command(const BenchOptions& options) {
  model::ModelLibrary library;
  const auto model = library.load(data_dir() + "/urdf/arm17.urdf");
  if (!model) return fail(kMachineError, model.error());
  const int ticks = options.ticks > 0 ? options.ticks : 60;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const std::string processor = system::processor_name();
  Json all = {{"limber", std::string(version())},
              {"commit", std::string(commit())},
              {"cpu", processor.empty() ? "unknown" : printable(processor)},
              {"cores", cores},
              {"ticks", ticks},
              {"settings", Json::array()}};
  if (!options.json) {
    print_result(
        "Arms of 17 servo-driven joints that this machine plays in real time, 60 ticks a second.\n"
        "Processor: {}, {}\n\n{:<10}{:>8}{:>8}\n",
        all["cpu"].get<std::string>(), counted(cores, "core"), "solver", "threads", "arms");
  }
  for (const Setting& setting : settings(cores)) {
    all["settings"].push_back(measure_setting(*model, setting, ticks));
    if (options.json) continue;
    const int arms = all["settings"].back()["arms_in_real_time"];
    if (!print_result("{:<10}{:>8}{:>8}\n", setting.solver, setting.threads, arms)) break;
  }
  if (options.json) print_result("{}\n", all.dump(2));
  return kSuccess;
}

}  // namespace limber::app
