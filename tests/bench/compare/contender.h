// Contender: one engine that simulates a RawScene, so that engines can be compared on the same scene.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/raw/scene.h"

namespace limber {

class Contender {
 public:
  virtual ~Contender() = default;
  /// Runs one step of the scene with the servo targets of the current time.
  virtual void step() = 0;
  /// Returns the position of a part's center of mass and its rotation.
  virtual Pose pose(int part) const = 0;
  /// Remarks on the steps so far, for the table.
  virtual std::string note() const { return {}; }
};

/// Law of Limber's servo, for engines without servos: the motor speed is this fraction of the speed that would
/// eliminate the error within the step, limited to the joint's speed.
constexpr double kServoShare = 0.9;

struct ContenderFactory {
  std::string name;
  std::function<std::unique_ptr<Contender>(const RawScene& scene)> make;
};

std::vector<ContenderFactory>
bullet_contenders();  ///< Stock, direct and Dantzig solvers; Bullet's with its own servo and with the law above.
std::vector<ContenderFactory> ode_contenders();
std::vector<ContenderFactory> mujoco_contenders();

}  // namespace limber
