// TreeSolver: bodies joined to trees, and what impulses and wanted rates do to all of them at once, exactly, in time
// linear in the number of bodies. Featherstone's articulated bodies, in impulses; docs/solver.md. No Bullet.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/tree_algebra.h"

namespace limber {

/// A body and the joint that bears it. A joint has six axes; each is held (its rate is given, the impulse follows) or
/// free (the impulse is given, the rate follows).
struct TreeNode {
  // what it is
  int parent = -1;              ///< A node before this one; -1: the world.
  Vec3 shift{0};                ///< From the parent's centre of mass to this one's.
  SpatialInertia inertia;       ///< Of the body alone, at its centre of mass.
  std::array<Spatial, 6> axis;  ///< The body's motion at rate 1 of each axis, its parent at rest.

  // what is asked
  unsigned held = 0;                    ///< Bit i: axis i.
  std::array<double, 6> conductance{};  ///< Of a free axis: impulse that it loses per rate, >= 0.
  std::array<double, 6> ask{};          ///< Held: change of rate. Free: impulse at no change of rate.
  Spatial load;                         ///< Impulse on the body from outside.

  // what comes out of solve()
  Spatial change;                   ///< Of the body's velocity.
  std::array<double, 6> rate{};     ///< Change of each axis's rate.
  std::array<double, 6> impulse{};  ///< What the joint gives about each axis, on the body.

  // the factor
  SpatialInertia rigid;          ///< Of all that hangs here, as the parent feels it.
  std::array<Spatial, 6> lean;   ///< Free axes: inertia · axis, when their turn came.
  std::array<double, 6> ease{};  ///< Free axes: 1 / (axis · lean + conductance).
  int first_free = 0;            ///< Number of its first free axis, among those of its tree.
  std::array<double, 6> left{};
  Spatial carried_motion;
};

/// An impulse from outside on one body; node < 0: none.
struct TreeLoad {
  int node = -1;
  Spatial impulse;
};

/// [sim]
class TreeSolver {
 public:
  /// No nodes; memory for so many is at hand.
  void clear(int room);
  /// A node after its parent; those of one tree follow each other. It keeps nothing of what was there before.
  TreeNode& add(int parent);
  int size() const { return static_cast<int>(nodes_.size()); }
  TreeNode& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  const TreeNode& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  /// For nodes first .. last - 1, whole trees. False when an axis moves no mass: nothing can be said then.
  bool factor(int first, int last);
  /// What `ask` and `load` do, with the factor of the present `held` and `conductance`.
  void solve(int first, int last);
  /// What loads and asks of free axes do, held axes asking for nothing: `change`, and `rate` of free axes.
  void respond(int first, int last);
  /// Half of a response, for loads on two bodies of one tree and asks of free axes on the way to its root: what each
  /// free axis there feels, times the root of its ease, at its number in `felt`, whose other numbers stay. The product
  /// of what two loads let the axes feel is the rate that an impulse of one gives the other.
  void feel(TreeLoad a, TreeLoad b, std::span<double> felt) const;
  /// Numbers in use on the way from a node to its root lie below this.
  int free_axes(int node) const;

 private:
  std::vector<TreeNode> nodes_;
};

}  // namespace limber
