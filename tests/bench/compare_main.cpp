// limber_compare: the same machines in stock Bullet, with our direct solver and in other engines, in turn in one
// process. Everything is measured from the poses of the parts, by one formula for all. First it is checked that each
// engine plays what it was given: a passive chain falls alike in all, a slow servo gets where it is sent.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/bench_times.h"
#include "bench/contender.h"
#include "sim/raw_machines.h"

namespace limber {
namespace {

constexpr int kRounds = 5;  // of each scene; the motion is the same in all, times are those of all
constexpr int kTurn = 10;   // steps before the next one has its turn, so that each finds its own caches again
// not the very least: a thread's clock on a virtual machine now and then tells far too little of a single step
constexpr double kLeast = 0.05;

// How far the joints' sides are apart, m, and their angles, as the parts' poses say.
class Look {
 public:
  explicit Look(const RawScene& scene) : scene_(scene) {}
  double gap(const Contender& contender) const {
    double most = 0;
    for (const RawJoint& j : scene_.joints) {
      const auto place = [&](int part) { return contender.pose(part) * (start(part).inverse() * j.place); };
      most = std::max(most, distance(place(j.parent), place(j.child)));
    }
    return most;
  }
  double angle(const Contender& contender, const RawJoint& j) const {
    const Quat now = glm::conjugate(contender.pose(j.parent).rotation) * contender.pose(j.child).rotation;
    const Quat then = glm::conjugate(start(j.parent).rotation) * start(j.child).rotation;
    const Quat turned = now * glm::conjugate(then);
    const Vec3 axis = glm::conjugate(start(j.parent).rotation) * j.axis;
    return 2 * std::atan2(glm::dot(Vec3(turned.x, turned.y, turned.z), axis), turned.w);
  }
  double servo_error(const Contender& contender, double time) const {
    double most = 0;
    for (const RawJoint& j : scene_.joints) {
      if (j.force <= 0) continue;
      const double error = std::fabs(std::remainder(angle(contender, j) - j.target(time), 2 * kPi));
      most = std::max(most, std::isnan(error) ? INFINITY : error);
    }
    return most;
  }

 private:
  static double distance(const Vec3& a, const Vec3& b) {
    const double d = glm::length(a - b);
    return std::isnan(d) ? INFINITY : d;
  }
  const Pose& start(int part) const { return scene_.parts[static_cast<std::size_t>(part)].pose; }
  const RawScene& scene_;
};

std::vector<Entrant> all_entrants() {
  std::vector<Entrant> all = bullet_entrants();
  for (Entrant& e : ode_entrants()) all.push_back(std::move(e));
  for (Entrant& e : mujoco_entrants()) all.push_back(std::move(e));
  return all;
}

// Three parts swing 0.4 s without servos, weight across them: where the last one is. They are heavy, since Bullet
// leaves out the gyroscopic torque of light ones: its 3x3 solver takes a determinant under 1.2e-7 for none.
Vec3 fallen(const Entrant& entrant) {
  RawScene s = raw_at_step(raw_arm(3, 13, 0, 0, false), 2.5e-4);
  for (RawPart& part : s.parts) part.mass *= 100;
  s.gravity = {6.9, 3.1, -6.2};
  s.floor = false;
  const auto contender = entrant.make(s);
  for (int i = 0; i < 1600; ++i) contender->step();
  return contender->pose(3).position;
}

// Two parts follow a sine of 20 s for one period, once it has begun: the worst error, and the least part of the
// amplitude reached.
std::pair<double, double> slow_motion(const Entrant& entrant) {
  RawScene s = raw_arm(2, 1, 10000, 0.3, false);
  for (RawJoint& j : s.joints) j.frequency = 0.05;
  const Look look(s);
  const auto contender = entrant.make(s);
  double worst = 0;
  std::vector<double> reached(s.joints.size(), 0);
  for (int i = 1; i <= 1200; ++i) {
    contender->step();
    if (i * s.step > 1) worst = std::max(worst, look.servo_error(*contender, i * s.step));
    for (std::size_t k = 0; k < reached.size(); ++k) {
      reached[k] = std::max(reached[k], std::fabs(look.angle(*contender, s.joints[k])));
    }
  }
  return {worst, *std::min_element(reached.begin(), reached.end()) / 0.3};
}

bool check(const std::vector<Entrant>& entrants) {
  const Vec3 ours = fallen(
      *std::find_if(entrants.begin(), entrants.end(), [](const Entrant& e) { return e.name.starts_with("Limber"); }));
  bool good = true;
  fmt::print(
      "| checked | slow servo's error, rad | amplitude reached | fallen chain beside ours, mm |\n|---|---|---|---|\n");
  for (const Entrant& e : entrants) {
    const auto [error, reached] = slow_motion(e);
    const double away = glm::length(fallen(e) - ours);
    fmt::print("| {} | {:.4f} | {:.3f} | {:.2f} |\n", e.name, error, reached, 1e3 * away);
    good = good && error < 0.02 && reached > 0.98 && away < 2e-3;
  }
  return good;
}

struct Result {
  double gap = 0;
  double servo_error = 0;
  Samples times;
  std::string note;
};

void play(const RawScene& scene, const std::vector<Entrant>& entrants, std::vector<Result>& results) {
  const Look look(scene);
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.reserve(entrants.size());
  for (const Entrant& e : entrants) contenders.push_back(e.make(scene));
  const int steps = static_cast<int>(6 / scene.step);
  for (int from = 0; from < steps; from += kTurn) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      Contender& contender = *contenders[k];
      for (int i = from; i < std::min(steps, from + kTurn); ++i) {
        const double start = system::thread_seconds();
        contender.step();
        results[k].times.add(system::thread_seconds() - start);
        results[k].gap = std::max(results[k].gap, look.gap(contender));
        results[k].servo_error = std::max(results[k].servo_error, look.servo_error(contender, (i + 1) * scene.step));
      }
      results[k].note = contender.note();
    }
  }
}

void compare(const char* name, const RawScene& scene, const std::vector<Entrant>& entrants) {
  std::vector<Result> results(entrants.size());
  for (int i = 0; i < kRounds; ++i) play(scene, entrants, results);
  fmt::print("\n| {} | gap, mm | servo error, rad | step, us: p5 | median | beside stock: p5 | median | notes |\n",
             name);
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < results.size(); ++k) {
    const Result& r = results[k];
    const auto beside = [&](double part) { return r.times.at(part) / results[0].times.at(part); };
    fmt::print("| {} | {:.3g} | {:.3g} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {} |\n", entrants[k].name, 1e3 * r.gap,
               r.servo_error, 1e6 * r.times.at(kLeast), 1e6 * r.times.at(0.5), beside(kLeast), beside(0.5), r.note);
  }
}

}  // namespace
}  // namespace limber

int main() {
  using namespace limber;
  const std::vector<Entrant> entrants = all_entrants();
  if (!check(entrants)) {
    fmt::print("an engine does not play what it was given\n");
    return EXIT_FAILURE;
  }
  compare("arm of 17", raw_arm(17, 1, 10000, 0.3, false), entrants);
  compare("the predecessor's robot", raw_robot(10000, 0.3), entrants);
  compare("square wave, 10000 N·m", raw_arm(17, 1, 10000, 0.6, true), entrants);
  return EXIT_SUCCESS;
}
