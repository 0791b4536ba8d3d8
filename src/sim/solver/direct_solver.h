// DirectSolver: solves one island exactly. Its joints form trees (articulated bodies); contacts, gears and joints that
// close loops are coupled rows, solved as an LCP with the trees' response. docs/solver.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/bullet/bullet.h"
#include "sim/bullet/gear_constraint.h"
#include "sim/bullet/joint_constraint.h"
#include "sim/bullet/spin.h"
#include "sim/solver/axis_rows.h"
#include "sim/solver/boxed_lcp.h"
#include "sim/solver/work_budget.h"

namespace limber {

/// Bullet's data of the island. Written to only once everything is solved, except by clamp_spin().
struct IslandPools {
  btAlignedObjectArray<btSolverBody>& bodies;
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& rollings;
};

/// Numbers of solves of islands that have joints or contacts (one per island and internal step), by solver.
struct DirectCounts {
  std::uint64_t islands = 0;  ///< All of them; those not counted as `direct` were solved by the iterative solver.
  std::uint64_t direct = 0;
  std::uint64_t too_large = 0;  ///< Too large for the direct solver.
  std::uint64_t fallbacks = 0;  ///< The direct solver failed.
};

/// Largest residuals of the last island solved: m/s, rad/s.
struct DirectResiduals {
  double locked = 0;
  double bounded = 0;
  double contact = 0;
};

/// Per island: begin(), add_joint() and add_gear(), then solve(). [sim]
class DirectSolver {
 public:
  /// Removes all joints and gears; call before adding those of an island.
  void begin();
  /// Adds a joint whose rows are planned, with its two solver bodies.
  void add_joint(JointConstraint& joint, int body_a, int body_b);
  /// Adds a gear whose row is planned, with the solver body of each of its sides.
  void add_gear(GearConstraint& gear, const std::array<int, 4>& bodies) { gears_.push_back({&gear, bodies, 0}); }
  int joint_count() const { return static_cast<int>(links_.size()); }
  /// Solves the island. Returns false if the iterative solver must do it; nothing is written then, but after a failed
  /// attempt the warm-start impulses of the previous step are removed.
  bool solve(IslandPools pools, const btContactSolverInfo& info);
  /// Counts since construction.

  const DirectCounts& counts() const { return counts_; }
  /// Counts islands that have joints or contacts and are about to be solved, by this or by the iterative solver.
  void count_islands(int islands) { counts_.islands += static_cast<std::uint64_t>(islands); }
  /// Enables measuring residuals after each solve, which costs as much as a solve.
  void measure(bool on) { measured_ = on; }
  const DirectResiduals& residuals() const { return residuals_; }

 private:
  struct Link {  // a joint between two solver bodies
    JointConstraint* joint;
    int body_a;
    int body_b;
    int node;              // child node of the joint in a tree; -1: the joint closes a loop
    int coupled_row;       // of a loop: its first row in coupled_
    Vec3 applied_drift;    // drift correction of its locked linear axes that is applied, m
    Vec3 predicted_drift;  // drift correction that was predicted last, m
  };
  struct GearLink {
    GearConstraint* gear;
    std::array<int, 4> bodies;
    int coupled_row;  // its row in coupled_
  };
  struct Tree {
    int first;
    int last;
  };
  struct RigidMotion {  // motion of a tree as one rigid piece
    Vec3 center{0};
    Spatial velocity;  // of the center of mass
  };
  struct BodyJacobian {  // Jacobian of a row with respect to one body
    int node = -1;
    Spatial jacobian;
  };
  struct ImpulseSite {  // the bodies that a unit impulse acts on (two; of a gear up to four), or an axis of the first
    BodyJacobian a, b;
    int axis = -1;
    int gear = -1;
  };
  struct KnownAxes {  // state of a node's axes when the Delassus matrix was built
    unsigned prescribed;
    std::array<double, 6> conductance;
  };
  struct BodyMotion {  // motion of a body in the step, with the velocity found
    Spatial velocity;
    Vec3 translation;
    Quat rotation;
    bool clamped;  // Bullet clamps its rotation
  };
  struct GyroscopicImpulse {  // the gyroscopic impulse on a fast body of a tree with joints, N·m·s
    int node;
    double scale;                         // mean moment of inertia, kg·m²
    Vec3 impulse;                         // applied so far
    Vec3 residual;                        // fixed-point residual: by the velocities found, minus `impulse`
    std::array<Vec3, 2> impulse_changes;  // of the last passes, newest first
    std::array<Vec3, 2> residual_changes;
  };
  struct HalfResponse {  // half response of a row in one tree
    int tree = -1;
    int begin = 0;  // in half_values_
    int count = 0;
  };
  /// By tree that a row acts on; tree < 0 marks the end.
  using HalfResponses = std::array<HalfResponse, 4>;
  struct CoupledRow {
    BodyJacobian a, b;
    int gear = -1;                          // in gears_: the row also acts on the gear_jacobians_ of that gear
    TreeRow* axis = nullptr;                // set if the row is a deferred row of a tree
    btSolverConstraint* contact = nullptr;  // receives the impulse
    double target = 0;  // right-hand side of rate + softness·impulse, as a change from the start of the step
    double softness = 0;
    double start_impulse = 0;  // impulse before the current LCP solve
    double impulse = 0;
    double saved_impulse = 0;  // impulse before the first LCP solve
    double mobility = 0;       // inverse effective mass: rate per impulse of the two bodies alone
    double lower = 0;
    double upper = 0;
    int normal = -1;
    double friction = 0;
    double max_impulse = 0;
    bool loop = false;
    bool softened = false;                                // add_softness() was applied
    bool inactive = false;                                // contact that doesn't press: its rows are not in the LCP
    BoxedLcp::Status initial_status = BoxedLcp::unknown;  // status in the previous LCP solve
    double initial_impulse = 0;                           // impulse in the previous LCP solve
  };

  bool build_forest(const IslandPools& pools);
  int root_of(int body);
  bool add_subtree(int body, int parent, int link, const IslandPools& pools);
  bool add_node(int body, int parent, int link, const IslandPools& pools);
  Spatial velocity(int body, const IslandPools& pools) const;
  Spatial solved_velocity(int body, const IslandPools& pools) const;
  static SpatialInertia inertia_of(const btRigidBody& body);
  void find_acted_on(const IslandPools& pools);
  void add_geometric_inertia(TreeNode& node, int body);
  static void make_floating(TreeNode& node);
  /// Attaches the node to the joint at the present poses. `forward`: the node is the joint's child. Returns false at a
  /// singular pose.
  static bool attach(TreeNode& node, const JointConstraint& joint, bool forward);

  void collect_contacts(IslandPools& pools);
  void add_contact(btSolverConstraint& row, int normal, double max_impulse);
  void collect_loops(const IslandPools& pools);
  void collect_gears(const IslandPools& pools);
  void collect_deferred_axes();
  void set_work_limit();
  /// Calls f(jacobian) for each body that the row acts on.
  template <class Row, class F>
  void for_each_jacobian(const Row& row, F&& f) const {
    if (row.a.node >= 0) f(row.a);
    if (row.b.node >= 0) f(row.b);
    if (row.gear < 0) return;
    for (const BodyJacobian& body : gear_jacobians_[at(row.gear)]) {
      if (body.node >= 0) f(body);
    }
  }
  double rate_of(const CoupledRow& row) const;
  int tree_at(int node) const { return node < 0 ? -1 : tree_of_[static_cast<std::size_t>(node)]; }
  void apply_load(const CoupledRow& row, double impulse);
  void add_half_response(const CoupledRow& row, HalfResponses& responses);
  int activate_contacts();
  void gather_lcp_rows();
  int row_id(int coupled_row) const;
  void build_delassus(BoxedLcp& lcp, std::span<const int> rows);
  void add_softness(BoxedLcp& lcp, int i);
  bool update_delassus();
  bool extend_delassus();
  int released_index(const CoupledRow& row) const;
  static ImpulseSite impulse_site(const CoupledRow& row);
  void delassus_column(const ImpulseSite& site, std::span<double> rows, std::span<double> axes);
  bool defer_ill_conditioned_gears();
  int defer_gear(CoupledRow& row);
  int defer_touched_trees();
  int defer_violated();
  enum class LcpSolve : std::uint8_t { full, refine };
  double solve_lcp(LcpSolve how);
  bool solve_velocities();
  bool solve_trees();
  bool solve_coupled_rows();
  bool solve_without_corrections(IslandPools& pools, double h);
  bool correct_drift(const IslandPools& pools, double h);
  enum class ClampStage : std::uint8_t { before, after };  // clamps the velocities before, or those after, the solve
  bool clamp_spin(IslandPools& pools, double h, ClampStage stage);
  Vec3 angular_velocity(int node, const IslandPools& pools, ClampStage stage) const;
  Spatial velocity_without_spin(int node, const IslandPools& pools, ClampStage stage, double h) const;
  RigidMotion rigid_motion(const Tree& tree, const IslandPools& pools, ClampStage stage, double h) const;
  void undo_spin_clamp(IslandPools& pools) const;
  bool restore_friction_cone();
  bool limit_rotation(const IslandPools& pools, double h);
  double update_drift_correction(const IslandPools& pools, double h);
  void remove_drift_correction(double h);
  void apply_drift_correction(Link& link, double h);
  void predict_motions(const IslandPools& pools, double h);
  BodyMotion predict_motion(int body, const IslandPools& pools, double h) const;
  Vec3 predict_drift(const Link& link, const IslandPools& pools, double h);
  RotationStep rotation_step(int body, const Vec3& w, const IslandPools& pools, double h) const;
  bool drives_spin(const Link& link, int axis, const IslandPools& pools, double h) const;
  void collect_gyroscopes(const IslandPools& pools, double h);
  bool correct_gyroscopes(const IslandPools& pools, double h);
  double work_of_locks(const Tree& tree, const IslandPools& pools) const;
  bool has_motors(const Tree& tree) const;
  bool is_passive(const Tree& tree) const;
  JointConstraint& first_joint(const Tree& tree) const;
  bool limit_drift_energy(const IslandPools& pools, double h);
  void apply_split_impulse(IslandPools& pools, const btContactSolverInfo& info);
  void close_joints(IslandPools& pools, const btContactSolverInfo& info);
  void predict_poses(const IslandPools& pools, const btContactSolverInfo& info);
  void set_poses(const IslandPools& pools);
  double position_error();
  bool build_pose_rows(const IslandPools& pools);
  void set_push_velocities(IslandPools& pools, const btContactSolverInfo& info) const;
  bool has_finite_velocities() const;
  void write(IslandPools& pools);
  void measure_residuals(const IslandPools& pools);

  /// Islands with more contact and friction rows use the iterative solver, because the dense matrix would cost too
  /// much.
  static constexpr int kMaxContactRows = 360;
  /// The same for an island without joints, where the iterative solver is cheaper and nearly as accurate.
  static constexpr int kMaxRowsWithoutJoints = 60;
  /// Tolerance of coupled rows, m/s and rad/s; and the largest violation that is accepted.
  static constexpr double kCoupledTolerance = 1e-6;
  static constexpr double kMaxCoupledViolation = 1e-2;
  /// A gear is ill-conditioned if its response is below this fraction of the response of its bodies alone.
  static constexpr double kIllConditioned = 1e-6;

  WorkBudget budget_;
  TreeRows tree_rows_{budget_};
  BoxedLcp lcp_{budget_};
  BoxedLcp split_lcp_{budget_};
  std::vector<Link> links_;
  std::vector<GearLink> gears_;
  std::vector<std::array<BodyJacobian, 2>> gear_jacobians_;  // by gear: of its third and fourth body
  std::vector<Tree> trees_;
  std::vector<int> tree_of_;  // by node
  std::vector<int> body_of_;  // by node
  std::vector<int> link_of_;  // by node; -1: floating root
  std::vector<int> node_of_;  // by body; -1: static
  std::vector<int> group_;    // by body: union-find
  std::vector<int> link_start_;
  std::vector<int> body_links_;
  std::vector<int> stack_;
  std::vector<CoupledRow> coupled_;
  std::vector<int> lcp_rows_;                  // rows of coupled_ in the LCP
  std::vector<int> lcp_index_;                 // by coupled row: index in lcp_rows_; -1: inactive
  std::vector<double> half_values_;            // half responses of the LCP's rows
  std::vector<double> half_scratch_;           // of a third and fourth body in one tree
  std::vector<HalfResponses> half_responses_;  // by LCP row
  std::vector<double> impulses_;
  std::vector<int> split_rows_;
  std::vector<std::pair<btVector3, btVector3>>
      before_clamp_;                      // by body: velocity changes before the clamp; empty: not clamped
  std::size_t fixed_coupled_ = 0;         // number of contacts, loops and gears in coupled_; deferred axes follow
  std::vector<double> uncorrected_work_;  // by tree: of its locks without drift correction, J
  std::uint64_t lcp_factor_version_ = 0;  // factor version that lcp_ was built with
  std::vector<int> row_ids_;              // of lcp_rows_
  std::vector<int> known_row_ids_;        // of the rows that lcp_ has responses of
  std::vector<KnownAxes> known_axes_;     // by node: when lcp_ was built
  std::vector<ImpulseSite> released_;     // axes that have become free since then
  std::vector<int> previous_index_;       // by LCP row: its index before
  std::vector<double> updates_;
  std::vector<double> columns_;
  double solve_cost_ = 0;  // of the last solve_velocities()
  std::vector<GyroscopicImpulse> gyroscopic_;
  int gyro_passes_ = 0;
  std::vector<unsigned char> acted_on_;  // by solver body: it has contacts, drives or gears
  std::vector<BodyMotion> motions_;      // by node
  double step_ = 0;                      // length of the current step, s
  bool needs_closing_ = false;  // position errors are possible at the step's end: the correction has not converged or a
                                // rotation is clamped
  TreeRows pose_rows_{budget_};                    // the trees at the poses at the step's end
  std::vector<Pose> end_poses_;                    // by node
  std::vector<std::array<double, 6>> lock_goals_;  // by link: positions of its locked axes at the step's end
  bool measured_ = false;
  DirectCounts counts_;
  DirectResiduals residuals_;
};

}  // namespace limber
