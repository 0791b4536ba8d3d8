// Runs each mechanism in stock Bullet and with the direct solver, alternating step by step.
#include "bench/measure/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/measure/arms.h"
#include "bench/measure/times.h"
#include "bench/raw/machines.h"

namespace limber {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRandomTrees = 300;
/// Runs per scene. All runs are identical, so the minimum over the runs is used for each step; disturbances hit
/// different steps.
constexpr int kRuns = 3;
constexpr unsigned kFirstSeed = 90001;  // not used during the development of the solver

struct SolverRun {
  explicit SolverRun(const RawScene& scene, RawSolver solver) : player(RawSimulation::make(scene, solver)) {}
  void restart(const RawScene& scene, RawSolver solver) {
    player = RawSimulation::make(scene, solver);
    steps = 0;
  }
  void restart_timing() {
    times = {};
    steps = 0;
  }
  void step() {
    const double start = system::thread_seconds();
    player->step();
    times.add_min(steps++, system::thread_seconds() - start);
    worst.accumulate_max(player->measurements());
  }
  Json figures() const {
    Json out = {{"gap_mm", rounded(worst.gap * 1e3, 3)},
                {"servo_error_rad", rounded(worst.servo_error, 4)},
                {"limit_passed_rad", rounded(worst.limit_violation, 4)},
                {"step_us", times.microseconds()}};
    if (!worst.finite) out["finite"] = false;
    return out;
  }
  std::unique_ptr<RawSimulation> player;
  std::size_t steps = 0;
  TimeSamples times;
  RawMeasurements worst;
};

Json island_steps(const RawSimulation::Direct& d) {
  return {{"direct", d.direct}, {"by_rule_plain", d.plain}, {"fallbacks", d.fallbacks}};
}

// A separate run, because computing residuals costs time.
Json residuals(RawScene scene, int steps) {
  scene.measure = true;
  const auto player = RawSimulation::make(scene, RawSolver::direct);
  for (int i = 0; i < steps; ++i) player->step();
  const RawSimulation::Direct d = player->direct();
  return {{"unbounded", d.unbounded}, {"bounded", d.bounded}, {"coupled", d.coupled}};
}

Json play(const RawScene& scene, int steps, double seconds = 6) {
  const int count = steps > 0 ? steps : static_cast<int>(seconds / scene.step);
  SolverRun stock(scene, RawSolver::stock);
  SolverRun direct(scene, RawSolver::direct);
  for (int run = 0; run < kRuns; ++run) {
    if (run > 0) stock.restart(scene, RawSolver::stock);
    if (run > 0) direct.restart(scene, RawSolver::direct);
    for (int i = 0; i < count; ++i) {
      stock.step();
      direct.step();
    }
  }
  Json out = {{"stock", stock.figures()}, {"direct", direct.figures()}};
  out["direct"]["island_steps"] = island_steps(direct.player->direct());
  out["direct"]["residuals"] = residuals(scene, count);
  out["time_ratio"] = {{"min", rounded(direct.times.quantile(0) / stock.times.quantile(0), 2)},
                       {"median", rounded(direct.times.quantile(0.5) / stock.times.quantile(0.5), 2)},
                       {"worst_to_median", rounded(direct.times.quantile(1) / stock.times.quantile(0.5), 2)}};
  return out;
}

// Times the second half of the steps, which has the most contacts. Both solvers use the program's default number of
// iterations.
Json play_crowd(RawScene scene, int steps) {
  scene.iterations = default_iterations();
  SolverRun stock(scene, RawSolver::stock);
  SolverRun ours(scene, RawSolver::direct);
  for (int i = 0; i < steps; ++i) {
    if (i == steps / 2) {
      stock.restart_timing();
      ours.restart_timing();
    }
    stock.step();
    ours.step();
  }
  return {{"stock", stock.figures()},
          {"ours", ours.figures()},
          {"island_steps", island_steps(ours.player->direct())},
          {"time_ratio",
           {{"min", rounded(ours.times.quantile(0) / stock.times.quantile(0), 2)},
            {"median", rounded(ours.times.quantile(0.5) / stock.times.quantile(0.5), 2)}}}};
}

// Counts the random trees that are clearly worse than in stock Bullet: a gap of more than 1.1 times the other plus 2
// mm.
Json play_random(double step, bool floor, int trees, int steps) {
  int worse = 0;
  int lost = 0;
  RawSimulation::Direct all;
  std::array<int, 2> torn{};
  for (int i = 0; i < trees; ++i) {
    const RawScene scene = raw_with_step(raw_random_tree(kFirstSeed + static_cast<unsigned>(i), floor), step);
    SolverRun stock(scene, RawSolver::stock);
    SolverRun direct(scene, RawSolver::direct);
    const int count = steps > 0 ? steps : static_cast<int>(3 / step);
    for (int k = 0; k < count; ++k) {
      stock.step();
      direct.step();
    }
    worse += direct.worst.gap > 1.1 * stock.worst.gap + 2e-3 ? 1 : 0;
    lost += direct.worst.finite ? 0 : 1;
    torn[0] += stock.worst.gap > 0.1 ? 1 : 0;
    torn[1] += direct.worst.gap > 0.1 ? 1 : 0;
    const RawSimulation::Direct d = direct.player->direct();
    all.direct += d.direct;
    all.plain += d.plain;
    all.fallbacks += d.fallbacks;
  }
  return {{"trees", trees},
          {"clearly_worse", worse},
          {"no_number", lost},
          {"gap_over_100_mm", {{"stock", torn[0]}, {"direct", torn[1]}}},
          {"island_steps", island_steps(all)}};
}

// An undriven, undamped chain that starts horizontally and swings for a minute.
Json play_passive(int parts, double step, int steps) {
  RawScene s = raw_with_step(raw_arm(17, 1, 0, 0, false), step);
  s.floor = false;
  s.parts.resize(static_cast<std::size_t>(parts) + 1);
  s.joints.resize(static_cast<std::size_t>(parts));
  s.gravity = {9.81, 0, 0};
  const double swing = 9.81 * parts * 0.1 * parts;
  Json out;
  for (const RawSolver solver : {RawSolver::stock, RawSolver::direct}) {
    const auto player = RawSimulation::make(s, solver);
    const double start_energy = player->energy().potential;  // starts at rest
    player->step();
    RawEnergyMeter meter(*player);
    double now = start_energy;
    double max_energy = -swing;
    RawMeasurements worst;
    const int count = steps > 0 ? steps : static_cast<int>(60 / step);
    for (int i = 0; i < count; ++i) {
      player->step();
      worst.accumulate_max(player->measurements());
      now = meter.measure();
      max_energy = std::max(max_energy, now);
    }
    out[solver == RawSolver::stock ? "stock" : "direct"] = {
        {"gain_percent_of_swing", rounded(100 * (max_energy - start_energy) / swing, 3)},
        {"at_end_percent", rounded(100 * (now - start_energy) / swing, 1)},
        {"gap_mm", rounded(worst.gap * 1e3, 3)}};
  }
  return out;
}

// Displacement of the ball after three seconds: with sweeps until convergence, at two step sizes, and with the direct
// solver.
Json play_hand(double torque, int steps) {
  Json out;
  const auto sink = [&](double step, RawSolver solver, int iterations) {
    RawScene s = raw_with_step(raw_gripper(torque), step);
    s.iterations = iterations;
    const auto player = RawSimulation::make(s, solver);
    const int ball = static_cast<int>(s.parts.size()) - 1;
    const double from = player->pose(ball).position.z;
    const int count = steps > 0 ? steps : static_cast<int>(3 / step);
    for (int i = 0; i < count; ++i) player->step();
    return rounded(1e3 * (player->pose(ball).position.z - from), 2);
  };
  out["moved_mm"] = {{"stock", sink(1.0 / 60, RawSolver::stock, 10)},
                     {"sweeps_1000", sink(1.0 / 60, RawSolver::iterative, 1000)},
                     {"sweeps_1000_at_240", sink(1.0 / 240, RawSolver::iterative, 1000)},
                     {"direct", sink(1.0 / 60, RawSolver::direct, 10)},
                     {"direct_at_240", sink(1.0 / 240, RawSolver::direct, 10)}};
  out["residuals"] = residuals(raw_gripper(torque), steps > 0 ? steps : 180);
  return out;
}

// Runs several steps of one scene before the next scene, so that each finds warm caches.
struct BenchRun {
  explicit BenchRun(const RawScene& scene, int count) : side(scene, RawSolver::direct), steps(count) {}
  void run_steps() {
    for (int i = 0; i < steps; ++i) side.step();
  }
  // results per unit, relative to those of `base`
  Json figures(const char* unit, double units, const BenchRun& base, double base_units) const {
    const auto each = [&](double part) { return 1e6 * side.times.quantile(part) / units; };
    const auto ratio = [&](double part) {
      return rounded(each(part) / (1e6 * base.side.times.quantile(part) / base_units), 3);
    };
    Json out = side.figures();
    out[fmt::format("us_per_{}", unit)] = {{"p5", rounded(each(kLowQuantile), 3)}, {"median", rounded(each(0.5), 3)}};
    out["times_the_first"] = {{"p5", ratio(kLowQuantile)}, {"median", ratio(0.5)}};
    out["island_steps"] = island_steps(side.player->direct());
    return out;
  }
  // not the minimum: the thread clock of a virtual machine is sometimes far off for a single step
  static constexpr double kLowQuantile = 0.05;
  SolverRun side;
  int steps;
};

// Time per joint of an arm that gets longer, and time per part with ten times as many arms.
Json play_growth(int steps) {
  constexpr double kStrong = 1e6;  // N·m: holds 170 parts; servos of long arms give way with less
  Json out;
  const int rounds = steps > 0 ? steps : 60;
  std::vector<std::pair<int, std::unique_ptr<BenchRun>>> arms;
  for (const int parts : {17, 34, 85, 170}) {
    arms.emplace_back(parts, std::make_unique<BenchRun>(raw_arm(parts, 1, kStrong, 0.3, false), 10));
  }
  for (int i = 0; i < rounds; ++i) {
    for (const auto& [parts, bench_run] : arms) bench_run->run_steps();
  }
  for (const auto& [parts, bench_run] : arms) {
    out[fmt::format("{} joints", parts)] = bench_run->figures("joint", parts, *arms[0].second, arms[0].first);
  }
  BenchRun few(raw_arms(100), 10);
  BenchRun many(raw_arms(1000), 1);
  for (int i = 0; i < rounds; ++i) {
    few.run_steps();
    many.run_steps();
  }
  out["100 arms"] = few.figures("part", 1800, few, 1800);
  out["1000 arms"] = many.figures("part", 18000, few, 1800);
  return out;
}

void add_arms(Json& out, int steps) {
  const auto arm = [](double ratio, double force, double amplitude, bool square) {
    return raw_arm(17, ratio, force, amplitude, square);
  };
  out["arm"] = play(arm(1, 10000, 0.3, false), steps);
  out["arm, masses 13:1"] = play(arm(13, 10000, 0.3, false), steps);
  out["arm, masses 129:1"] = play(arm(129, 10000, 0.3, false), steps);
  out["the predecessor's robot, 129:1"] = play(raw_robot(10000, 0.3), steps);
  out["arm upright"] = play(arm(1, 10000, 0, false), steps, 60);
  for (const int rate : {30, 60, 240}) {
    for (const int force : {5, 50, 10000}) {
      out[fmt::format("square wave, {} N·m, 1/{} s", force, rate)] =
          play(raw_with_step(arm(1, force, 0.6, true), 1.0 / rate), steps);
    }
  }
  out["limits met in free fall"] = play(raw_lying_arm(0.2), steps);
  out["servos past their limits"] = play(raw_limited(arm(1, 10000, 0.6, true), 0.2, true), steps);
}

}  // namespace

Json measure_solver(const MeasureOptions& options) {
  const int steps = options.ticks;
  Json out;
  add_arms(out, steps);
  out["tree, standing"] = play(raw_tree(false), steps);
  out["tree, floating"] = play(raw_tree(true), steps);
  out["four legs, 10 kg on 0.5 kg"] = play(raw_legs(10, 0.5, false), steps);
  out["four legs, 50 kg on 1 kg"] = play(raw_legs(50, 1, false), steps);
  out["four legs walking"] = play(raw_legs(10, 0.5, true), steps);
  out["four legs walking, 50 kg on 1 kg"] = play(raw_legs(50, 1, true), steps);
  out["hand, 0.3 N·m"] = play_hand(0.3, steps);
  out["hand, 3 N·m"] = play_hand(3, steps);
  out["clump of 100 creatures"] = play(raw_clump(100), steps, 3);
  for (const int parts : {17, 5}) {
    for (const int rate : {60, 240}) {
      out[fmt::format("passive chain of {}, 1/{} s", parts, rate)] = play_passive(parts, 1.0 / rate, steps);
    }
  }
  out["100 arms"] = play(raw_arms(100), steps > 0 ? steps : 60);
  out["growth"] = play_growth(steps);
  out["1000 arms"] = play(raw_arms(1000), steps > 0 ? steps : 16);
  const int trees = steps > 0 ? 10 : kRandomTrees;
  for (const bool floor : {false, true}) {
    for (const int rate : {30, 60, 240}) {
      out[fmt::format("random trees{}, 1/{} s", floor ? " over a floor" : "", rate)] =
          play_random(1.0 / rate, floor, trees, steps);
    }
  }
  return out;
}

Json measure_swarm(const MeasureOptions& options) {
  return play_crowd(raw_clump(300), options.ticks > 0 ? options.ticks : 300);
}

Json measure_pile(const MeasureOptions& options) {
  return play_crowd(raw_pile(2000), options.ticks > 0 ? options.ticks : 400);
}

}  // namespace limber
