// Forest: articulated bodies in impulse form. Computes the velocity changes of all bodies of the trees for given
// impulses and prescribed joint rates, exactly and in time linear in the number of bodies. Featherstone's
// articulated-body algorithm with hybrid dynamics (Rigid Body Dynamics Algorithms, 2008, chapters 7 and 9);
// docs/understand/solver.md. Doesn't depend on Bullet.
#pragma once

#include <array>
#include <span>

#include "sim/solver/forest/spatial_algebra.h"
#include "sim/solver/indexed_array.h"

namespace limber::sim::solver {

/// A body and the joint that connects it to its parent. A joint has six axes; each is either prescribed (its rate is
/// given, its impulse follows) or free (its impulse is given, its rate follows).
struct TreeNode {
  // the model
  int parent = -1;              ///< Index of a node before this one; -1: the world.
  Vec3 offset{0};               ///< From the parent's center of mass to this one's.
  SpatialInertia inertia;       ///< Of the body alone, at its center of mass.
  FixedArray<Spatial, 6> axis;  ///< Motion subspace S: motion of the body at rate 1 of each axis.

  // input of solve()
  unsigned prescribed = 0;          ///< Bit i is set: axis i is prescribed.
  FixedArray<double, 6> damping{};  ///< Free axis: implicit damping, impulse per rate, >= 0.
  FixedArray<double, 6> input{};  ///< Prescribed axis: its change of rate. Free axis: its impulse at no change of rate.
  Spatial load;                   ///< External impulse on the body.

  // output of solve()
  Spatial velocity_change;          ///< Change of the body's velocity.
  FixedArray<double, 6> rate{};     ///< Change of each axis's rate.
  FixedArray<double, 6> impulse{};  ///< Impulse of the joint on the body, about each axis.

  // factor (in brackets: Featherstone's symbols)
  SpatialInertia articulated_inertia;   ///< Articulated-body inertia of the subtree, as the parent sees it [I^A].
  FixedArray<Spatial, 6> inertia_axis;  ///< Free axes: inertia · axis at the time of their elimination [U].
  FixedArray<double, 6> inverse_d{};    ///< Free axes: 1 / (axis · inertia_axis + damping) [1/D].
  int first_free = 0;                   ///< Index of its first free axis, among those of its tree.
  FixedArray<double, 6> free_rate{};
  Spatial prescribed_motion;
};

/// An external impulse on one body; node < 0: none.
struct TreeLoad {
  int node = -1;
  Spatial impulse;
};

/// All trees of an island, as one array of nodes. [sim]
class Forest {
 public:
  /// Removes all nodes and reserves memory for `capacity` nodes.
  void clear(int capacity);
  /// Appends a node; its parent must exist, and nodes of one tree must be contiguous. All fields have their defaults.
  /// Invalidates references to other nodes.
  TreeNode& add(int parent);
  int size() const { return nodes_.size(); }
  TreeNode& node(int i) { return nodes_[i]; }
  const TreeNode& node(int i) const { return nodes_[i]; }

  /// Factors the nodes first .. last - 1, which must be whole trees. Returns false if an axis moves (nearly) no mass;
  /// the factor must not be used then.
  bool factor(int first, int last);
  /// Computes the outputs for `input` and `load`, with the factor of the present `prescribed` and `damping`.
  void solve(int first, int last);
  /// Like solve(), but with prescribed axes at rest: computes only `velocity_change`, and `rate` of free axes.
  void respond(int first, int last);
  /// Computes half of a response: for loads on one or two bodies of one tree (and inputs of free axes on their way to
  /// the root), the impulse about each free axis on the way times sqrt(1/D), stored at the axis's index in `half`;
  /// other elements stay unchanged. The dot product of two half responses is the rate that a unit impulse of one load
  /// gives the other.
  void half_response(TreeLoad a, TreeLoad b, IndexedSpan<double> half) const;
  /// Free axes on the way from a node to its root have indices below this number.
  int free_axis_count(int node) const;

 private:
  IndexedArray<TreeNode> nodes_;
};

}  // namespace limber::sim::solver
