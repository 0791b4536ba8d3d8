// DirectSolver: solves one island exactly. Its joints form trees (articulated bodies); contacts, gears, tendons and
// joints that close loops are coupled rows, solved as an LCP with the trees' response (docs/understand/solver.md). The
// stages of a substep are in direct_solver.cpp; other code needs only this header and, of the parts that `bullet`
// shares, axis_active_set.h, gyroscope.h and indexed_array.h.
#pragma once

#include <cstdint>
#include <memory>

struct btContactSolverInfo;
struct btSolverBody;
struct btSolverConstraint;
template <typename T>
class btAlignedObjectArray;

namespace limber::sim::bullet {
class CoupledConstraint;
class JointConstraint;
}  // namespace limber::sim::bullet

namespace limber::sim::solver {

/// Bullet's data of the island. The results are written to them when the whole island is solved. Before, only the
/// velocities of bodies that rotate too fast for the step are reduced (SpinClamp).
struct IslandPools {
  btAlignedObjectArray<btSolverBody>& bodies;
  btAlignedObjectArray<btSolverConstraint>& contacts;
  btAlignedObjectArray<btSolverConstraint>& frictions;
  btAlignedObjectArray<btSolverConstraint>& rollings;
};

/// Counts islands that have joints or contacts, once per substep, by the solver that solved them.
struct DirectCounts {
  std::uint64_t islands = 0;  ///< All of them; those not counted as `direct` were solved by the iterative solver.
  std::uint64_t direct = 0;
  std::uint64_t too_large = 0;  ///< Too large for the direct solver.
  std::uint64_t fallbacks = 0;  ///< The direct solver failed.
};

/// Largest residuals of the last island solved: m/s, rad/s.
struct DirectResiduals {
  double unbounded = 0;  ///< Of rows of tree joints without bounds on the impulse: locks, springs.
  double bounded = 0;    ///< Of the other rows of tree joints: motors, limits, friction.
  double coupled = 0;    ///< Of contacts, gears, tendons and joints that close loops.
};

/// Per island: begin(), add_joint() and add_coupling(), then solve(). [sim]
class DirectSolver {
 public:
  DirectSolver();
  ~DirectSolver();

  /// Removes all joints, gears and tendons; call before adding those of an island.
  void begin();
  /// Adds a joint whose rows are planned, with its two solver bodies.
  void add_joint(bullet::JointConstraint& joint, int body_a, int body_b);
  /// Adds a gear or tendon whose row is planned; add_coupled_body() follows for each of its Jacobians.
  void add_coupling(bullet::CoupledConstraint& coupling);
  void add_coupled_body(int body);
  int joint_count() const;
  /// Solves the island. Returns false if the iterative solver must do it; no result is written then, but after a failed
  /// attempt the warm-start impulses of the previous step are removed from `pools`, joints, gears and
  /// tendons.
  bool solve(const IslandPools& pools, const btContactSolverInfo& info);

  /// Counts since construction.
  const DirectCounts& counts() const { return counts_; }
  /// Counts islands that have joints or contacts and are about to be solved, by this or by the iterative solver.
  void count_islands(int islands) { counts_.islands += static_cast<std::uint64_t>(islands); }
  /// Enables measuring residuals after each solve, which costs as much as a solve.
  void measure(bool on) { measured_ = on; }
  const DirectResiduals& residuals() const { return residuals_; }

 private:
  class Step;
  std::unique_ptr<Step> step_;
  bool measured_ = false;
  DirectCounts counts_;
  DirectResiduals residuals_;
};

}  // namespace limber::sim::solver
