// Articulated-body factorization: from the leaves to the roots, each free axis is eliminated like a joint of its own (a
// rank-one update); prescribed axes cost nothing. A solve carries impulses up to the roots and velocities down to the
// leaves.
#include "sim/solver/forest/forest.h"

#include <bit>
#include <cmath>
#include <utility>

#include "base/capacity.h"

namespace limber::sim::solver {
namespace {

/// Smallest inertia about an axis, relative to that of the body alone.
constexpr double kMinRelativeInertia = 1e-9;

}  // namespace

void Forest::clear(int capacity) { nodes_.clear_and_reserve(capacity); }

TreeNode& Forest::add(int parent) {
  TreeNode& n = nodes_.emplace_back();
  n.parent = parent;
  return n;
}

bool Forest::factor(int first, int last) {
  for (int i = first; i < last; ++i) {
    node(i).articulated_inertia = node(i).inertia;
    node(i).first_free = i > first ? free_axis_count(i - 1) : 0;
  }
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    for (int k = 0; k < 6; ++k) {
      if ((n.prescribed >> k & 1) != 0) continue;
      n.inertia_axis[k] = n.articulated_inertia * n.axis[k];
      const double d = dot(n.axis[k], n.inertia_axis[k]) + n.damping[k];
      // written so that NaN fails the test
      if (!(d > kMinRelativeInertia * dot(n.axis[k], n.inertia * n.axis[k]))) return false;
      n.inverse_d[k] = 1 / d;
      n.articulated_inertia.subtract_outer_product(n.inertia_axis[k], n.inverse_d[k]);
    }
    if (n.parent >= 0) node(n.parent).articulated_inertia.add_translated(n.articulated_inertia, n.offset);
  }
  return true;
}

void Forest::solve(int first, int last) {
  // velocity_change holds the accumulated impulse on the way up, and the velocity on the way down
  for (int i = first; i < last; ++i) node(i).velocity_change = node(i).load;
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    Spatial& bias_impulse = n.velocity_change;
    n.prescribed_motion = {};
    bool has_motion = false;
    for (int k = 0; k < 6; ++k) {
      if ((n.prescribed >> k & 1) != 0) {
        if (n.input[k] == 0) continue;
        n.prescribed_motion += n.axis[k] * n.input[k];
        has_motion = true;
        continue;
      }
      n.free_rate[k] = (n.input[k] + dot(n.axis[k], bias_impulse)) * n.inverse_d[k];
      bias_impulse = bias_impulse - n.inertia_axis[k] * n.free_rate[k];
    }
    if (n.parent < 0) continue;
    node(n.parent).velocity_change += translated_back(
        has_motion ? bias_impulse - n.articulated_inertia * n.prescribed_motion : bias_impulse, n.offset);
  }
  for (int i = first; i < last; ++i) {
    TreeNode& n = node(i);
    Spatial v = n.prescribed_motion;
    if (n.parent >= 0) v += translated(node(n.parent).velocity_change, n.offset);
    const Spatial transmitted = n.prescribed != 0 ? n.articulated_inertia * v - n.velocity_change : Spatial{};
    for (int j = 6; j-- > 0;) {
      if ((n.prescribed >> j & 1) != 0) {
        n.rate[j] = n.input[j];
        n.impulse[j] = dot(n.axis[j], transmitted);
        continue;
      }
      n.rate[j] = n.free_rate[j] - dot(n.inertia_axis[j], v) * n.inverse_d[j];
      n.impulse[j] = n.input[j] - n.damping[j] * n.rate[j];
      v += n.axis[j] * n.rate[j];
    }
    n.velocity_change = v;
  }
}

void Forest::respond(int first, int last) {
  for (int i = first; i < last; ++i) node(i).velocity_change = node(i).load;
  for (int i = last - 1; i >= first; --i) {
    TreeNode& n = node(i);
    Spatial& bias_impulse = n.velocity_change;
    for (int k = 0; k < 6; ++k) {
      if ((n.prescribed >> k & 1) != 0) continue;
      n.free_rate[k] = (n.input[k] + dot(n.axis[k], bias_impulse)) * n.inverse_d[k];
      bias_impulse = bias_impulse - n.inertia_axis[k] * n.free_rate[k];
    }
    if (n.parent >= 0) node(n.parent).velocity_change += translated_back(bias_impulse, n.offset);
  }
  for (int i = first; i < last; ++i) {
    TreeNode& n = node(i);
    Spatial v;
    if (n.parent >= 0) v = translated(node(n.parent).velocity_change, n.offset);
    for (int j = 6; j-- > 0;) {
      if ((n.prescribed >> j & 1) != 0) continue;
      n.rate[j] = n.free_rate[j] - dot(n.inertia_axis[j], v) * n.inverse_d[j];
      v += n.axis[j] * n.rate[j];
    }
    n.velocity_change = v;
  }
}

void Forest::half_response(TreeLoad a, TreeLoad b, IndexedSpan<double> half) const {
  while (a.node >= 0 || b.node >= 0) {
    if (a.node < b.node) std::swap(a, b);
    if (a.node == b.node) {
      a.impulse += b.impulse;
      b.node = -1;
    }
    const TreeNode& n = node(a.node);
    auto index = n.first_free;
    for (int k = 0; k < 6; ++k) {
      if ((n.prescribed >> k & 1) != 0) continue;
      const double axis_impulse = n.input[k] + dot(n.axis[k], a.impulse);
      a.impulse = a.impulse - n.inertia_axis[k] * (axis_impulse * n.inverse_d[k]);
      half[index++] = axis_impulse * std::sqrt(n.inverse_d[k]);
    }
    a = {n.parent, translated_back(a.impulse, n.offset)};
  }
}

int Forest::free_axis_count(int i) const { return node(i).first_free + 6 - std::popcount(node(i).prescribed & 63U); }

}  // namespace limber::sim::solver
