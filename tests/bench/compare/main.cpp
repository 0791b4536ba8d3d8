// limber_compare: runs the same mechanisms in stock Bullet, with the direct solver and in other engines, alternating in
// one process. All measurements use the poses of the parts and the same formulas. First it checks that each engine
// simulates the scene: a passive chain falls equally in all, and a slow servo reaches its targets.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/compare/contender.h"
#include "bench/measure/times.h"
#include "bench/raw/machines.h"

namespace limber {
namespace {

constexpr int kRounds = 5;             // per scene; the motion is identical in all rounds, times are collected over all
constexpr int kConsecutiveSteps = 10;  // consecutive steps of one engine, so that its caches are warm
// quantile of the fastest steps; not the minimum, because the thread clock of a virtual machine is sometimes far off
constexpr double kFastQuantile = 0.05;

// Measures joint gaps (m) and angles from the poses of the parts.
class SceneMeasures {
 public:
  explicit SceneMeasures(const RawScene& scene) : scene_(scene) {}
  double gap(const Contender& contender) const {
    double largest = 0;
    for (const RawJoint& j : scene_.joints) {
      const auto place = [&](int part) { return contender.pose(part) * (start(part).inverse() * j.position); };
      largest = std::max(largest, distance(place(j.parent), place(j.child)));
    }
    return largest;
  }
  double angle(const Contender& contender, const RawJoint& j) const {
    const Quat now = glm::conjugate(contender.pose(j.parent).rotation) * contender.pose(j.child).rotation;
    const Quat then = glm::conjugate(start(j.parent).rotation) * start(j.child).rotation;
    const Quat turned = now * glm::conjugate(then);
    const Vec3 axis = glm::conjugate(start(j.parent).rotation) * j.axis;
    return 2 * std::atan2(glm::dot(Vec3(turned.x, turned.y, turned.z), axis), turned.w);
  }
  double servo_error(const Contender& contender, double time) const {
    double largest = 0;
    for (const RawJoint& j : scene_.joints) {
      if (j.force <= 0) continue;
      const double error = std::fabs(std::remainder(angle(contender, j) - j.target(time), 2 * kPi));
      largest = std::max(largest, std::isnan(error) ? INFINITY : error);
    }
    return largest;
  }

 private:
  static double distance(const Vec3& a, const Vec3& b) {
    const double d = glm::length(a - b);
    return std::isnan(d) ? INFINITY : d;
  }
  const Pose& start(int part) const { return scene_.parts[static_cast<std::size_t>(part)].pose; }
  const RawScene& scene_;
};

std::vector<ContenderFactory> all_factories() {
  std::vector<ContenderFactory> all = bullet_contenders();
  for (ContenderFactory& e : ode_contenders()) all.push_back(std::move(e));
  for (ContenderFactory& e : mujoco_contenders()) all.push_back(std::move(e));
  return all;
}

// Position of the last of three parts after swinging 0.4 s without servos, with gravity across them. The parts are
// heavy because Bullet leaves out the gyroscopic torque of light ones: its 3x3 solver treats a determinant below 1.2e-7
// as zero.
Vec3 position_after_fall(const ContenderFactory& factory) {
  RawScene s = raw_with_step(raw_arm(3, 13, 0, 0, false), 2.5e-4);
  for (RawPart& part : s.parts) part.mass *= 100;
  s.gravity = {6.9, 3.1, -6.2};
  s.floor = false;
  const auto contender = factory.make(s);
  for (int i = 0; i < 1600; ++i) contender->step();
  return contender->pose(3).position;
}

// Two parts follow a sine with a period of 20 s for one period: the maximal error after 1 s, and the smallest fraction
// of the amplitude that a joint reaches.
std::pair<double, double> slow_motion(const ContenderFactory& factory) {
  RawScene s = raw_arm(2, 1, 10000, 0.3, false);
  for (RawJoint& j : s.joints) j.frequency = 0.05;
  const SceneMeasures measures(s);
  const auto contender = factory.make(s);
  double worst = 0;
  std::vector<double> amplitudes(s.joints.size(), 0);
  for (int i = 1; i <= 1200; ++i) {
    contender->step();
    if (i * s.step > 1) worst = std::max(worst, measures.servo_error(*contender, i * s.step));
    for (std::size_t k = 0; k < amplitudes.size(); ++k) {
      amplitudes[k] = std::max(amplitudes[k], std::fabs(measures.angle(*contender, s.joints[k])));
    }
  }
  return {worst, *std::min_element(amplitudes.begin(), amplitudes.end()) / 0.3};
}

bool check(const std::vector<ContenderFactory>& factories) {
  const Vec3 ours = position_after_fall(*std::find_if(
      factories.begin(), factories.end(), [](const ContenderFactory& e) { return e.name.starts_with("Limber"); }));
  bool good = true;
  fmt::print(
      "| checked | slow servo's error, rad | amplitude reached | fallen chain, distance to Limber's, mm "
      "|\n|---|---|---|---|\n");
  for (const ContenderFactory& e : factories) {
    const auto [error, amplitudes] = slow_motion(e);
    const double distance = glm::length(position_after_fall(e) - ours);
    fmt::print("| {} | {:.4f} | {:.3f} | {:.2f} |\n", e.name, error, amplitudes, 1e3 * distance);
    good = good && error < 0.02 && amplitudes > 0.98 && distance < 2e-3;
  }
  return good;
}

struct Result {
  double gap = 0;
  double servo_error = 0;
  TimeSamples times;
  std::string note;
};

void play(const RawScene& scene, const std::vector<ContenderFactory>& factories, std::vector<Result>& results) {
  const SceneMeasures measures(scene);
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.reserve(factories.size());
  for (const ContenderFactory& e : factories) contenders.push_back(e.make(scene));
  const int steps = static_cast<int>(6 / scene.step);
  for (int from = 0; from < steps; from += kConsecutiveSteps) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      Contender& contender = *contenders[k];
      for (int i = from; i < std::min(steps, from + kConsecutiveSteps); ++i) {
        const double start = system::thread_seconds();
        contender.step();
        results[k].times.add(system::thread_seconds() - start);
        results[k].gap = std::max(results[k].gap, measures.gap(contender));
        results[k].servo_error =
            std::max(results[k].servo_error, measures.servo_error(contender, (i + 1) * scene.step));
      }
      results[k].note = contender.note();
    }
  }
}

void compare(const char* name, const RawScene& scene, const std::vector<ContenderFactory>& factories) {
  std::vector<Result> results(factories.size());
  for (int i = 0; i < kRounds; ++i) play(scene, factories, results);
  fmt::print("\n| {} | gap, mm | servo error, rad | step, us: p5 | median | relative to stock: p5 | median | notes |\n",
             name);
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < results.size(); ++k) {
    const Result& r = results[k];
    const auto relative_to_stock = [&](double part) {
      return r.times.quantile(part) / results[0].times.quantile(part);
    };
    fmt::print("| {} | {:.3g} | {:.3g} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {} |\n", factories[k].name, 1e3 * r.gap,
               r.servo_error, 1e6 * r.times.quantile(kFastQuantile), 1e6 * r.times.quantile(0.5),
               relative_to_stock(kFastQuantile), relative_to_stock(0.5), r.note);
  }
}

}  // namespace
}  // namespace limber

int main() {
  using namespace limber;
  const std::vector<ContenderFactory> factories = all_factories();
  if (!check(factories)) {
    fmt::print("an engine simulates the scenes wrongly\n");
    return EXIT_FAILURE;
  }
  compare("arm of 17", raw_arm(17, 1, 10000, 0.3, false), factories);
  compare("the predecessor's robot", raw_robot(10000, 0.3), factories);
  compare("square wave, 10000 N·m", raw_arm(17, 1, 10000, 0.6, true), factories);
  return EXIT_SUCCESS;
}
