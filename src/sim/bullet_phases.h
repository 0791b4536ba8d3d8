// What Bullet spends where in its step, told by the zones that Bullet itself marks. For the bench.
#pragma once

namespace limber {

/// Seconds, summed over all worlds.
struct BulletPhases {
  double broadphase = 0;   ///< Bounding boxes and overlapping pairs.
  double narrowphase = 0;  ///< Contact points.
  double islands = 0;      ///< Who is joined to whom.
  double solver = 0;       ///< Joints and contacts, set-up and motion included.
};

/// Counts while it lives; one at a time. Zones are entered tens of times a step, so what it counts is a little more
/// than what the step takes without. [sim]
class BulletPhaseCounter {
 public:
  BulletPhaseCounter();
  ~BulletPhaseCounter();
  BulletPhaseCounter(const BulletPhaseCounter&) = delete;
  BulletPhaseCounter& operator=(const BulletPhaseCounter&) = delete;

  const BulletPhases& phases() const;
};

}  // namespace limber
