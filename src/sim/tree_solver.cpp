// Leaves first, each free axis is eliminated as if it were a joint of its own (a rank-one step); held axes cost
// nothing. Then impulses run up to the roots and velocities down to the leaves.
#include "sim/tree_solver.h"

#include <bit>
#include <cmath>
#include <utility>

#include "base/room.h"

namespace limber {
namespace {

/// An axis must move at least this part of what it would with the body alone.
constexpr double kLeastEase = 1e-9;

}  // namespace

void TreeSolver::clear(int room) { take_room(nodes_, static_cast<std::size_t>(room)); }

TreeNode& TreeSolver::add(int parent) {
  TreeNode& n = nodes_.emplace_back();
  n.parent = parent;
  return n;
}

bool TreeSolver::factor(int first, int last) {
  for (int i = first; i < last; ++i) {
    node(i).rigid = node(i).inertia;
    node(i).first_free = i > first ? free_axes(i - 1) : 0;
  }
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    for (std::size_t k = 0; k < 6; ++k) {
      if ((n.held >> k & 1) != 0) continue;
      n.lean[k] = n.rigid * n.axis[k];
      const double resists = dot(n.axis[k], n.lean[k]) + n.conductance[k];
      // written so that no number passes as one
      if (!(resists > kLeastEase * dot(n.axis[k], n.inertia * n.axis[k]))) return false;
      n.ease[k] = 1 / resists;
      n.rigid.subtract_square(n.lean[k], n.ease[k]);
    }
    if (n.parent >= 0) node(n.parent).rigid.add_carried(n.rigid, n.shift);
  }
  return true;
}

void TreeSolver::solve(int first, int last) {
  // `change` holds the impulse gathered so far on the way up, the velocity on the way down
  for (int i = first; i < last; ++i) node(i).change = node(i).load;
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    Spatial& push = n.change;
    n.carried_motion = {};
    bool moves = false;
    for (std::size_t k = 0; k < 6; ++k) {
      if ((n.held >> k & 1) != 0) {
        if (n.ask[k] == 0) continue;
        n.carried_motion += n.axis[k] * n.ask[k];
        moves = true;
        continue;
      }
      n.left[k] = (n.ask[k] + dot(n.axis[k], push)) * n.ease[k];
      push = push - n.lean[k] * n.left[k];
    }
    if (n.parent < 0) continue;
    node(n.parent).change += brought_back(moves ? push - n.rigid * n.carried_motion : push, n.shift);
  }
  for (int i = first; i < last; ++i) {
    TreeNode& n = node(i);
    Spatial v = n.carried_motion;
    if (n.parent >= 0) v += carried(node(n.parent).change, n.shift);
    const Spatial through = n.held != 0 ? n.rigid * v - n.change : Spatial{};
    for (std::size_t j = 6; j-- > 0;) {
      if ((n.held >> j & 1) != 0) {
        n.rate[j] = n.ask[j];
        n.impulse[j] = dot(n.axis[j], through);
        continue;
      }
      n.rate[j] = n.left[j] - dot(n.lean[j], v) * n.ease[j];
      n.impulse[j] = n.ask[j] - n.conductance[j] * n.rate[j];
      v += n.axis[j] * n.rate[j];
    }
    n.change = v;
  }
}

void TreeSolver::respond(int first, int last) {
  for (int i = first; i < last; ++i) node(i).change = node(i).load;
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    Spatial& push = n.change;
    for (std::size_t k = 0; k < 6; ++k) {
      if ((n.held >> k & 1) != 0) continue;
      n.left[k] = (n.ask[k] + dot(n.axis[k], push)) * n.ease[k];
      push = push - n.lean[k] * n.left[k];
    }
    if (n.parent >= 0) node(n.parent).change += brought_back(push, n.shift);
  }
  for (int i = first; i < last; ++i) {
    TreeNode& n = node(i);
    Spatial v;
    if (n.parent >= 0) v = carried(node(n.parent).change, n.shift);
    for (std::size_t j = 6; j-- > 0;) {
      if ((n.held >> j & 1) != 0) continue;
      n.rate[j] = n.left[j] - dot(n.lean[j], v) * n.ease[j];
      v += n.axis[j] * n.rate[j];
    }
    n.change = v;
  }
}

void TreeSolver::feel(TreeLoad a, TreeLoad b, std::span<double> felt) const {
  while (a.node >= 0 || b.node >= 0) {
    if (a.node < b.node) std::swap(a, b);
    if (a.node == b.node) {
      a.impulse += b.impulse;
      b.node = -1;
    }
    const TreeNode& n = node(a.node);
    auto number = static_cast<std::size_t>(n.first_free);
    for (std::size_t k = 0; k < 6; ++k) {
      if ((n.held >> k & 1) != 0) continue;
      const double feels = n.ask[k] + dot(n.axis[k], a.impulse);
      a.impulse = a.impulse - n.lean[k] * (feels * n.ease[k]);
      felt[number++] = feels * std::sqrt(n.ease[k]);
    }
    a = {n.parent, brought_back(a.impulse, n.shift)};
  }
}

int TreeSolver::free_axes(int i) const { return node(i).first_free + 6 - std::popcount(node(i).held & 63U); }

}  // namespace limber
