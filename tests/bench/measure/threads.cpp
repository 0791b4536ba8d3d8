// Alternates the two runs, so that disturbances affect both equally.
#include "bench/measure/measures.h"

#include "bench/measure/arms.h"
#include "bench/measure/times.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kPairs = 15;
constexpr int kWarmTicks = 4;

double play_ticks(BenchArms& arms, int ticks) {
  double seconds = 0;
  for (int i = 0; i < ticks; i++) {
    arms.drive(arms.time());
    const double start = system::clock_seconds();
    arms.tick();
    seconds += system::clock_seconds() - start;
  }
  return seconds;
}

Json compare_threads(const ArmScene& scene, int ticks) {
  BenchArms one(scene, 1);
  BenchArms two(scene, 2);
  play_ticks(one, kWarmTicks);
  play_ticks(two, kWarmTicks);
  TimeSamples alone, together, ratio;
  for (int i = 0; i < kPairs; i++) {
    const double a = play_ticks(one, ticks);
    const double b = play_ticks(two, ticks);
    alone.add(a / ticks);
    together.add(b / ticks);
    ratio.add(b / a);
  }
  return {{"one_us", alone.microseconds()},
          {"two_us", together.microseconds()},
          {"ratio", {{"min", rounded(ratio.quantile(0), 3)}, {"median", rounded(ratio.quantile(0.5), 3)}}},
          {"same_state", one.engine().state_hash() == two.engine().state_hash()}};
}

}  // namespace

nlohmann::ordered_json measure_threads(const MeasureOptions& options) {
  const auto ticks = [&](int default_ticks) { return options.ticks > 0 ? options.ticks : default_ticks; };
  Json figures = {{"pairs", kPairs}};
  figures["100 arms, direct"] = compare_threads(direct_arm_scene(100), ticks(10));
  figures["1000 arms, direct"] = compare_threads(direct_arm_scene(1000), ticks(2));
  figures["100 arms, iterative"] = compare_threads(arm_scene(100), ticks(4));
  return figures;
}

}  // namespace limber
