// Time that Bullet spends in the phases of a step, from Bullet's own profile zones. For the benchmark.
#pragma once

namespace limber::sim::bullet {

/// Seconds, summed over all worlds.
struct BulletPhases {
  double broadphase = 0;   ///< Bounding boxes and overlapping pairs.
  double narrowphase = 0;  ///< Contact points.
  double islands = 0;      ///< Finding islands.
  double solver = 0;       ///< Joints and contacts, including set-up and motion.
};

/// Measures while it exists; only one may exist at a time. Zones are entered tens of times per step, so the result is
/// slightly larger than the time of a step without it. [sim]
class BulletPhaseCounter {
 public:
  BulletPhaseCounter();
  ~BulletPhaseCounter();
  BulletPhaseCounter(const BulletPhaseCounter&) = delete;
  BulletPhaseCounter& operator=(const BulletPhaseCounter&) = delete;

  const BulletPhases& phases() const;
};

}  // namespace limber::sim::bullet
