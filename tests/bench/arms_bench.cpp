// The arms of `limber bench` with Google Benchmark: a tick of Limber, a tick of the plain Bullet loop, a snapshot.
#include <benchmark/benchmark.h>

#include "app/commands/bench_arms.h"

namespace limber {
namespace {

template <class Loop>
void play(benchmark::State& state) {
  const ArmScene scene = bench_arm_scene(static_cast<int>(state.range(0)));
  Loop loop(scene);
  double time = 0;
  for (auto _ : state) {
    state.PauseTiming();
    loop.drive(time);
    time += scene.step * scene.substeps;
    state.ResumeTiming();
    loop.tick();
  }
  state.counters["parts"] = static_cast<double>(scene.arms * scene.parts);
}
BENCHMARK(play<BenchArms>)->Name("arms")->Arg(1)->Arg(16)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(play<RawLoop>)->Name("raw")->Arg(1)->Arg(16)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void snapshot(benchmark::State& state) {
  BenchArms arms(bench_arm_scene(static_cast<int>(state.range(0))));
  arms.tick();
  Publisher publisher(arms.engine().world(), arms.link().snapshots);
  for (auto _ : state) publisher.publish(false, 1);
}
BENCHMARK(snapshot)->Arg(1)->Arg(16)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace limber
