// IslandDirect: one island solved exactly: its joints as trees, contacts and joints that close loops around them, with
// the trees' response. docs/solver.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/box_solver.h"
#include "sim/bullet.h"
#include "sim/effort.h"
#include "sim/gear_constraint.h"
#include "sim/joint_constraint.h"
#include "sim/spin.h"
#include "sim/tree_rows.h"

namespace limber {

/// What Bullet set up for the island: read, and written to only when all is solved; but see calm_whips().
struct IslandPools {
  btAlignedObjectArray<btSolverBody>& bodies;
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& rollings;
};

/// Steps of islands that have joints or contacts, by the solver that solved them.
struct DirectCounts {
  std::uint64_t islands = 0;  ///< All of them; what is not `direct` is left to the iterative solver.
  std::uint64_t direct = 0;
  std::uint64_t plain = 0;      ///< Left by rule: too many contacts.
  std::uint64_t fallbacks = 0;  ///< Not solved to the end.
};

/// How far rows miss their laws, most of the last island solved: m/s, rad/s.
struct DirectResiduals {
  double locked = 0;
  double bounded = 0;
  double contact = 0;
};

/// [sim]
class IslandDirect {
 public:
  void start();
  /// A joint with its rows planned, and its two solver bodies.
  void add_joint(JointConstraint& joint, int body_a, int body_b);
  /// A gear with its row planned, and the solver body of each of its sides.
  void add_gear(GearConstraint& gear, const std::array<int, 4>& bodies) { gears_.push_back({&gear, bodies, 0}); }
  int joint_count() const { return static_cast<int>(links_.size()); }
  /// False when the iterative solver has to do it, with nothing written; after a failed attempt, impulses of the step
  /// before are taken back, too.
  bool solve(IslandPools pools, const btContactSolverInfo& info);

  const DirectCounts& counts() const { return counts_; }
  /// Islands that have joints or contacts and are about to be solved, by this or by the iterative solver.
  void count_islands(int islands) { counts_.islands += static_cast<std::uint64_t>(islands); }
  /// Measured after each solve while asked for: it costs as much again.
  void measure(bool on) { measured_ = on; }
  const DirectResiduals& residuals() const { return residuals_; }

 private:
  struct Link {  // a joint between two solver bodies
    JointConstraint* joint;
    int body_a;
    int body_b;
    int node;   // that hangs on it; -1: it closes a loop
    int outer;  // then: its first row in outer_
    Vec3 bent;  // what was already asked of its locked linear axes, m
    Vec3 bend;  // and what should be
  };
  struct GearLink {
    GearConstraint* gear;
    std::array<int, 4> bodies;
    int outer;  // its row in outer_
  };
  struct Tree {
    int first;
    int last;
  };
  struct Rigid {  // motion of a tree as if it were one piece
    Vec3 center{0};
    Spatial velocity;  // of the centre of mass
  };
  struct Side {  // what an outer row does to one body
    int node = -1;
    Spatial pull;
  };
  struct Pull {  // what an impulse acts on: two bodies (of a gear up to four), or an axis of the first
    Side a, b;
    int axis = -1;
    int gear = -1;
  };
  struct KnownAxes {
    unsigned held;
    std::array<double, 6> conductance;
  };
  struct Way {  // of a body in the step, by the velocity that was found
    Spatial velocity;
    Vec3 shift;
    Quat rotation;
    bool clamped;  // its rotation is
  };
  struct Gyro {  // the gyroscopic impulse on a fast body of a tree with joints, N·m·s
    int node;
    double scale;                         // of its moment of inertia, kg·m²
    Vec3 impulse;                         // what is applied so far
    Vec3 miss;                            // what the velocities found say beyond that
    std::array<Vec3, 2> impulse_changes;  // of the last passes, newest first
    std::array<Vec3, 2> miss_changes;
  };
  struct Reach {  // what an outer row lets a tree feel
    int tree = -1;
    int begin = 0;  // in felt_
    int count = 0;
  };
  /// Trees that a row acts on; those behind the last have no tree.
  using Reaches = std::array<Reach, 4>;
  struct OuterRow {
    Side a, b;
    int gear = -1;                          // in gears_: the row acts on gear_sides_ of it, too
    TreeRow* axis = nullptr;                // a row of a tree's axis instead
    btSolverConstraint* contact = nullptr;  // where the impulse goes
    double target = 0;                      // rate + softness·impulse, as changes from the start
    double softness = 0;
    double begun = 0;  // impulse when the stage began
    double impulse = 0;
    double kept = 0;   // impulse before the first round
    double eases = 0;  // rate per impulse of the two bodies alone
    double lower = 0;
    double upper = 0;
    int normal = -1;
    double friction = 0;
    double most = 0;
    bool loop = false;
    bool softened = false;                         // its softness counts what joints hold
    bool aside = false;                            // a contact that would not touch: its rows are not solved for
    BoxSolver::Status guess = BoxSolver::unknown;  // where it stood in the round before
    double likely = 0;                             // its impulse then
  };

  bool build_forest(const IslandPools& pools);
  int root_of(int body);
  bool grow(int body, int parent, int link, const IslandPools& pools);
  bool add_node(int body, int parent, int link, const IslandPools& pools);
  Spatial velocity(int body, const IslandPools& pools) const;
  Spatial solved_velocity(int body, const IslandPools& pools) const;
  static SpatialInertia inertia_of(const btRigidBody& body);
  void mark_acted_on(const IslandPools& pools);
  void add_geometric_inertia(TreeNode& node, int body);
  static void float_free(TreeNode& node);
  /// The node hangs on the joint, as parts stand now; forward: the joint's child is the node. False: a singular pose.
  static bool hang(TreeNode& node, const JointConstraint& joint, bool forward);

  void collect_contacts(IslandPools& pools);
  void add_contact(btSolverConstraint& row, int normal, double most);
  void collect_loops(const IslandPools& pools);
  void collect_gears(const IslandPools& pools);
  void collect_axes();
  void allow_work();
  /// Calls f(side) for each body that a row, or a pull, acts on.
  template <class Row, class F>
  void for_each_side(const Row& row, F&& f) const {
    if (row.a.node >= 0) f(row.a);
    if (row.b.node >= 0) f(row.b);
    if (row.gear < 0) return;
    for (const Side& side : gear_sides_[at(row.gear)]) {
      if (side.node >= 0) f(side);
    }
  }
  double rate_of(const OuterRow& row) const;
  int tree_at(int node) const { return node < 0 ? -1 : tree_of_[static_cast<std::size_t>(node)]; }
  void load(const OuterRow& row, double impulse);
  void feel(const OuterRow& row, Reaches& reaches);
  int take_contacts();
  void gather_rows();
  int name_of(int outer) const;
  void respond(BoxSolver& box, std::span<const int> rows);
  void soften(BoxSolver& box, int i);
  bool build_responses();
  bool extend_responses();
  int released_with(const OuterRow& row) const;
  static Pull pull_on(const OuterRow& row);
  void answer(const Pull& to, std::span<double> rows, std::span<double> axes);
  bool give_up_pinned_gears();
  int give_up_gear(OuterRow& row);
  int give_up_touched();
  int give_up_broken();
  enum class Solve : std::uint8_t { anew, polish };
  double solve_outer(Solve how);
  bool settle();
  bool settle_trees();
  bool settle_outer();
  bool settle_all(IslandPools& pools, double h);
  bool bend_all(const IslandPools& pools, double h);
  enum class Whips : std::uint8_t { before, after };  // as the step began; as it was solved
  bool calm_whips(IslandPools& pools, double h, Whips which);
  Vec3 angular_velocity(int node, const IslandPools& pools, Whips which) const;
  Spatial moving(int node, const IslandPools& pools, Whips which, double h) const;
  Rigid motion_of(const Tree& tree, const IslandPools& pools, Whips which, double h) const;
  void forget_calm(IslandPools& pools) const;
  bool narrow_friction();
  bool limit_turns(const IslandPools& pools, double h);
  double bend_locks(const IslandPools& pools, double h);
  void straighten(double h);
  void ask_for_bend(Link& link, double h);
  void predict_turns(const IslandPools& pools, double h);
  Way way_of(int body, const IslandPools& pools, double h) const;
  Vec3 bend_of(const Link& link, const IslandPools& pools, double h);
  Turn turn_of(int body, const Vec3& w, const IslandPools& pools, double h) const;
  bool drives_spin(const Link& link, int axis, const IslandPools& pools, double h) const;
  void collect_gyroscopes(const IslandPools& pools, double h);
  bool correct_gyroscopes(const IslandPools& pools, double h);
  double work_of_locks(const Tree& tree, const IslandPools& pools) const;
  bool driven(const Tree& tree) const;
  bool passive(const Tree& tree) const;
  JointConstraint& first_joint(const Tree& tree) const;
  bool ease_bends(const IslandPools& pools, double h);
  void push_apart(IslandPools& pools, const btContactSolverInfo& info);
  void close_joints(IslandPools& pools, const btContactSolverInfo& info);
  void foresee(const IslandPools& pools, const btContactSolverInfo& info);
  void place(const IslandPools& pools);
  double gape();
  bool build_poses(const IslandPools& pools);
  void go_there(IslandPools& pools, const btContactSolverInfo& info) const;
  bool finite() const;
  void write(IslandPools& pools);
  void take_residuals(const IslandPools& pools);

  /// More contact and friction rows than this go to the plain solver: the dense response would cost more than it gains.
  static constexpr int kMostContactRows = 360;
  /// The same for an island without joints, where the iterative solver is cheaper and does nearly as well.
  static constexpr int kMostRowsWithoutJoints = 60;
  /// What outer rows may miss, m/s and rad/s, when they count as solved; and when they still will do.
  static constexpr double kOuterTolerance = 1e-6;
  static constexpr double kOuterMiss = 1e-2;
  /// A gear is pinned if its response is below this part of that of its bodies alone.
  static constexpr double kPinned = 1e-6;

  Effort effort_;
  TreeRows system_{effort_};
  BoxSolver box_{effort_};
  BoxSolver push_box_{effort_};
  std::vector<Link> links_;
  std::vector<GearLink> gears_;
  std::vector<std::array<Side, 2>> gear_sides_;  // gear: the sides that its row has no room for
  std::vector<Tree> trees_;
  std::vector<int> tree_of_;  // node
  std::vector<int> body_of_;  // node
  std::vector<int> link_of_;  // node; -1: floats
  std::vector<int> node_of_;  // body; -1: static
  std::vector<int> group_;    // body: union-find
  std::vector<int> link_start_;
  std::vector<int> body_links_;
  std::vector<int> stack_;
  std::vector<OuterRow> outer_;
  std::vector<int> boxed_;         // rows of outer_ that are solved for
  std::vector<int> place_;         // outer row: where in boxed_; -1: aside
  std::vector<double> felt_;       // by rows of a box, one after the other
  std::vector<double> felt_more_;  // by a third and fourth body in one tree
  std::vector<Reaches> reaches_;   // row of a box: the trees it touches
  std::vector<double> impulses_;
  std::vector<int> push_rows_;
  std::vector<std::pair<btVector3, btVector3>>
      before_calm_;                    // body: changes that contacts began with; empty: not calmed
  std::size_t fixed_outer_ = 0;        // contacts, loops and gears; behind them axes that were given up
  std::vector<double> unbent_work_;    // tree: of its locks, unbent, J
  std::uint64_t box_factors_ = 0;      // that box_ has the responses of
  std::vector<int> names_;             // of boxed_
  std::vector<int> known_names_;       // of the rows that box_ has the responses of
  std::vector<KnownAxes> known_axes_;  // node: as it was then
  std::vector<Pull> released_;         // axes that were, and are no more
  std::vector<int> from_;              // row of a box: where it was
  std::vector<double> lines_;
  std::vector<double> answers_;
  double settle_cost_ = 0;  // of the last settle()
  std::vector<Gyro> gyros_;
  int gyro_passes_ = 0;
  std::vector<unsigned char> acted_on_;       // by solver body: whether it has contacts, drives or gears
  std::vector<Way> way_;                      // by node
  double step_ = 0;                           // length of the step that is being solved, s
  bool gapes_ = false;                        // perhaps: bends do not fit yet, or do not know of so wide a turn
  TreeRows poses_{effort_};                   // the trees where the step will end
  std::vector<Pose> ends_;                    // node: there
  std::vector<std::array<double, 6>> goals_;  // link: where its locked axes are to be then
  bool measured_ = false;
  DirectCounts counts_;
  DirectResiduals residuals_;
};

}  // namespace limber
