// LimitRow: the constraint row that stops a joint at a limit, or returns it to one that it exceeds.
#pragma once

#include "sim/bullet/joints/axis_settings.h"
#include "sim/bullet/joints/joint_rows.h"

namespace limber::sim::bullet {

/// State of a limit at the start of a substep.
struct LimitState {
  btScalar distance;        ///< To the limit, rad or m; negative: exceeded.
  btScalar speed;           ///< Rate of `distance`; negative: approaching.
  btScalar margin;          ///< A limit that is farther away, and isn't reached within two steps, has no row.
  btScalar stop_erp;        ///< Part of the error that one substep repairs.
  btScalar softness;        ///< Change of the rate per impulse.
  btScalar bounce;          ///< Restitution.
  btScalar repair_impulse;  ///< Of the last substep, on this limit.
};

/// rate of the distance + softness·impulse >= min_speed, with an impulse of at least -repair_impulse.
struct LimitRow {
  btScalar min_speed;
  btScalar softness;
  btScalar repair_impulse;
  JointRow::Kind kind;
};

/// True if the limit may be reached within two steps of `h` s.
bool limit_is_near(const LimitState& limit, btScalar h);
/// Plans the row for a substep of `h` s.
LimitRow limit_row(const LimitState& limit, btScalar h);
/// Compliance of a lock or limit (per load, at rest) as softness (per impulse) for a substep of `h` s.
btScalar stop_softness(btScalar stop_erp, btScalar stop_cfm, btScalar h);

/// A limit gets a row if it is nearer than this plus the distance covered in two steps: rad, m.
inline constexpr btScalar kAngularLimitMargin = btScalar(0.05);
inline constexpr btScalar kLinearLimitMargin = btScalar(0.005);
/// Largest repair speed of a hard lock, rad/s and m/s, so that a joint torn apart closes without an impact.
inline constexpr btScalar kMaxLockRepairSpeed = btScalar(20);

}  // namespace limber::sim::bullet
