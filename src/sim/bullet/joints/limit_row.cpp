// LimitRow: speed, softness and bounds of the row of a limit.
#include "sim/bullet/joints/limit_row.h"

#include <algorithm>

namespace limber::sim::bullet {
namespace {

/// Largest repair speed of a hard limit, rad/s and m/s. It is lower than that of locks because contacts may have pushed
/// the joint past its limit, and the repair presses against them.
constexpr btScalar kMaxLimitRepairSpeed = btScalar(2);

}  // namespace

// The solver repairs erp/h of the error per second.
btScalar stop_softness(btScalar stop_erp, btScalar stop_cfm, btScalar h) { return stop_cfm * stop_erp / (h * h); }

bool limit_is_near(const LimitState& limit, btScalar h) {
  return limit.distance <= limit.margin + 2 * h * std::max(-limit.speed, btScalar(0));
}

LimitRow limit_row(const LimitState& limit, btScalar h) {
  LimitRow row{-limit.distance / h, limit.softness, 0, JointRow::Kind::other};
  if (limit.distance < 0) {
    row.min_speed *= limit.stop_erp;
    // a limit only pushes, but may revert its repair impulse of the last step; else the axis would bounce off at the
    // repair speed
    if (limit.softness == 0) {
      row.min_speed = std::min(row.min_speed, kMaxLimitRepairSpeed);
      row.repair_impulse = limit.repair_impulse;
      row.kind = JointRow::Kind::repair;
    }
  }
  if (limit.bounce > 0 && limit.distance + h * limit.speed <= 0 && -limit.bounce * limit.speed > row.min_speed) {
    row.min_speed = -limit.bounce * limit.speed;
    row.kind = JointRow::Kind::other;
  }
  return row;
}

}  // namespace limber::sim::bullet
