// Stock Bullet, the direct solver, and Bullet's exact solver (Dantzig), which falls back silently.
#include <utility>

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <fmt/format.h>

#include "bench/compare/contender.h"
#include "sim/bullet/bullet.h"

namespace limber {
namespace {

class BulletContender : public Contender {
 public:
  explicit BulletContender(std::unique_ptr<RawSimulation> player) : player_(std::move(player)) {}
  void step() override { player_->step(); }
  Pose pose(int part) const override { return player_->pose(part); }
  std::string note() const override {
    const RawSimulation::Direct d = player_->direct();
    return d.direct + d.plain > 0 ? fmt::format("{} fall-backs", d.fallbacks) : std::string();
  }

 private:
  std::unique_ptr<RawSimulation> player_;
};

class DantzigContender : public Contender {
 public:
  explicit DantzigContender(const RawScene& scene) : player_(RawSimulation::make_stock(scene, solver_)) {
    solver_.setNumFallbacks(0);
  }
  void step() override {
    player_->step();
    ++steps_;
  }
  Pose pose(int part) const override { return player_->pose(part); }
  std::string note() const override {
    return fmt::format("{} silent fall-backs in {} steps", solver_.getNumFallbacks(), steps_);
  }

 private:
  btDantzigSolver dantzig_;
  btMLCPSolver solver_{&dantzig_};
  std::unique_ptr<RawSimulation> player_;
  int steps_ = 0;
};

}  // namespace

std::vector<ContenderFactory> bullet_contenders() {
  const auto raw = [](RawSolver solver, double share) {
    return [=](RawScene scene) {
      scene.servo_erp = share;
      return std::make_unique<BulletContender>(RawSimulation::make(scene, solver));
    };
  };
  const auto dantzig = [](double share) {
    return [=](RawScene scene) {
      scene.servo_erp = share;
      return std::make_unique<DantzigContender>(scene);
    };
  };
  return {{"Bullet, stock", raw(RawSolver::stock, 0)},
          {"Bullet, stock, servo 0.9", raw(RawSolver::stock, kServoShare)},
          {"Limber, direct", raw(RawSolver::direct, 0)},
          {"Bullet, Dantzig", dantzig(0)},
          {"Bullet, Dantzig, servo 0.9", dantzig(kServoShare)}};
}

}  // namespace limber
