// The loop of the programs that step_rates compares: a body of 12 motors gets targets before each tick, and its state
// is read after it. A line "TICKS" on stdin runs this many ticks and prints "WALL PROCESSOR HEIGHT CONTACTS LAST" on
// stdout: seconds, seconds of the thread, mean height of the trunk in m, mean number of contact points (-1: not
// counted), last height.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>

namespace limber::steps {

constexpr std::size_t kMotors = 12;
/// Angles and speeds of the joints; position, rotation and velocities of the trunk.
constexpr std::size_t kObservations = 2 * kMotors + 13;
constexpr int kRate = 240;   ///< Physics steps a second.
constexpr int kCycle = 120;  ///< Steps of a trot on the spot.

using Actions = std::array<double, kMotors>;
using Observations = std::array<double, kObservations>;

/// The targets of a step of the trot: for each leg (front left, front right, back left, back right) hip, thigh, knee.
/// quadruped.lua and step_rates have the same.
inline Actions actions(int step) {
  constexpr double kPi = 3.14159265358979323846;
  Actions targets{};
  for (std::size_t leg = 0; leg < 4; leg++) {
    const double offset = leg == 0 || leg == 3 ? 0 : 0.5;
    const double lift = std::max(0.0, std::sin(2 * kPi * (static_cast<double>(step % kCycle) / kCycle + offset)));
    targets[3 * leg + 1] = -0.5 - 0.15 * lift;
    targets[3 * leg + 2] = 1 + 0.3 * lift;
  }
  return targets;
}

inline double seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Answers the lines of stdin until its end. `Engine` has step(actions, observations), which returns the height of the
/// trunk, and contacts().
template <class Engine>
int serve(Engine& engine, int substeps) {
  std::array<Actions, kCycle> table{};
  for (int i = 0; i < kCycle; i++) table[static_cast<std::size_t>(i)] = actions(i);
  Observations observations{};
  int count = 0;
  for (int ticks = 0; std::cin >> ticks;) {
    double height = 0;
    double last = 0;
    double contacts = 0;
    const double wall = seconds(CLOCK_MONOTONIC);
    const double processor = seconds(CLOCK_THREAD_CPUTIME_ID);
    for (int i = 0; i < ticks; i++, count += substeps) {
      last = engine.step(table[static_cast<std::size_t>(count % kCycle)], observations);
      height += last;
      contacts += engine.contacts();
    }
    std::printf("%.9f %.9f %.6f %.3f %.9f\n", seconds(CLOCK_MONOTONIC) - wall,
                seconds(CLOCK_THREAD_CPUTIME_ID) - processor, height / ticks, contacts / ticks, last);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace limber::steps
