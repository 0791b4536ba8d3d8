// Contender: one engine that plays a RawScene, so that engines can be compared on the same machine.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/raw_scene.h"

namespace limber {

class Contender {
 public:
  virtual ~Contender() = default;
  /// One step of the scene's; servos go where they should be at the present time.
  virtual void step() = 0;
  /// Where a part's centre of mass is, and how it is turned.
  virtual Pose pose(int part) const = 0;
  /// What else there is to say about the steps so far.
  virtual std::string note() const { return {}; }
};

/// The law of our servo, for engines that have none: a motor turns at this share of what would end the error within
/// the step, but no faster than the joint's speed.
constexpr double kServoShare = 0.9;

struct Entrant {
  std::string name;
  std::function<std::unique_ptr<Contender>(const RawScene& scene)> make;
};

std::vector<Entrant>
bullet_entrants();  ///< Stock, our direct solver, Dantzig; those of Bullet's with its own servo and with our law.
std::vector<Entrant> ode_entrants();
std::vector<Entrant> mujoco_entrants();

}  // namespace limber
