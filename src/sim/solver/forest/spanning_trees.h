// SpanningTrees: the trees that the joints of an island form, as nodes and rows of the axes. Joints that close loops
// are left over (Featherstone, Rigid Body Dynamics Algorithms, 2008, sections 4.1 and 8.1).
#pragma once

#include "sim/solver/forest/axis_active_set.h"
#include "sim/solver/island.h"

namespace limber::sim::solver {

/// A tree: the nodes first .. last - 1.
struct Tree {
  int first;
  int last;
};

/// Valid from build() on, for the bodies' poses and velocities at that time. [sim]
class SpanningTrees {
 public:
  SpanningTrees(const Island& island, WorkBudget& budget) : axes(budget), island_(island) {}

  /// Builds the trees of the island. Returns false at a joint's singular pose or at an unsupported body; the trees are
  /// unusable then.
  bool build();

  AxisActiveSet axes;  ///< The nodes, and the rows of their joints.

  const Tree* begin() const { return trees_.data(); }
  const Tree* end() const { return trees_.data() + trees_.size(); }
  const Tree& operator[](int tree) const { return trees_[tree]; }
  int count() const { return trees_.size(); }
  /// True for a tree of one body that has no joint in a tree.
  bool is_single_body(const Tree& tree) const { return tree.last - tree.first == 1 && joint_of(tree.first) < 0; }

  int node_count() const { return body_of_.size(); }
  int body_of(int node) const { return body_of_[node]; }
  /// Solver body and rigid body of a node.
  btSolverBody& body(int node) const { return island_.body(body_of(node)); }
  btRigidBody& rigid(int node) const { return island_.rigid(body_of(node)); }
  /// Joint between a node and its parent; -1: the node is a floating root.
  int joint_of(int node) const { return joint_of_[node]; }
  /// Node of a body; -1: the body is static.
  int node_of(int body) const { return node_of_[body]; }
  int tree_of(int node) const { return node < 0 ? -1 : tree_of_[node]; }
  /// Child node of a joint; -1: the joint closes a loop.
  int node_of_joint(int index) const { return node_of_joint_[index]; }
  /// True if a joint closes a loop.
  bool has_loops() const { return has_loops_; }

  /// Velocity of a body after the solve.
  Spatial velocity(int body) const {
    const int node = node_of(body);
    return node < 0 ? island_.velocity(body) : island_.velocity(body) + axes.change(node);
  }

 private:
  int root_of(int body);
  void find_acted_on();
  void unite_joints();
  bool add_tree(int body, int index);
  bool add_node(int body, int parent, int index);
  void add_rows(const Island::Joint& joint);
  IndexedSpan<const int> joints_at(int body) const {
    return {body_joints_.data() + joint_start_[body], joint_start_[body + 1] - joint_start_[body]};
  }

  const Island& island_;
  IndexedArray<Tree> trees_;
  IndexedArray<int> tree_of_;        // by node
  IndexedArray<int> body_of_;        // by node
  IndexedArray<int> joint_of_;       // by node
  IndexedArray<int> node_of_;        // by body
  IndexedArray<int> node_of_joint_;  // by joint
  bool has_loops_ = false;
  // scratch of build()
  IndexedArray<int> group_;        // by body: union-find
  IndexedArray<int> joint_start_;  // by body: the joints of its trees are body_joints_[joint_start_[body]] ...
  IndexedArray<int> body_joints_;
  IndexedArray<int> stack_;
  IndexedArray<unsigned char> acted_on_;  // by body: it has contacts, drives, gears or tendons
};

/// Inertia of a body at its present pose.
SpatialInertia inertia_of(const btRigidBody& body);
/// Gives the node six free axes.
void make_floating(TreeNode& node);
/// Attaches the node to the joint at the present poses. `forward`: the node is the joint's child. Returns false at a
/// singular pose.
bool attach(TreeNode& node, const bullet::JointConstraint& joint, bool forward);

}  // namespace limber::sim::solver
