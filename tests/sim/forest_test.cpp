// Forest: compares random trees with dense elimination of the whole system.
#include "sim/solver/forest/forest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace limber::sim {
namespace {

using Matrix = solver::IndexedArray<solver::IndexedArray<double>>;

// solves a·x = b by Gaussian elimination with row exchange
solver::IndexedArray<double> dense_solve(Matrix a, solver::IndexedArray<double> b) {
  const int n = b.size();
  for (int c = 0; c < n; ++c) {
    int best = c;
    for (int r = c; r < n; ++r) {
      if (std::fabs(a[r][c]) > std::fabs(a[best][c])) best = r;
    }
    std::swap(a[c], a[best]);
    std::swap(b[c], b[best]);
    for (int r = c + 1; r < n; ++r) {
      const double f = a[r][c] / a[c][c];
      if (f == 0) continue;
      for (int k = c; k < n; ++k) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  for (int r = n; r-- > 0;) {
    for (int k = r + 1; k < n; ++k) b[r] -= a[r][k] * b[k];
    b[r] /= a[r][r];
  }
  return b;
}

struct RandomNumbers {
  explicit RandomNumbers(unsigned seed) : generator(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
  Vec3 vec(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(generator); }
  std::mt19937 generator;
};

// R·diag·R', the inertia tensor of a real body
solver::Sym3 tensor(const Vec3& d, const Mat3& r) {
  const Mat3 m = r * Mat3(d.x, 0, 0, 0, d.y, 0, 0, 0, d.z) * glm::transpose(r);
  return {m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]};
}

// Free axes of each kind of joint: revolute, prismatic, planar, fixed, ball, floating.
constexpr unsigned kFree[] = {1u << 5, 1u << 2, 1u << 0 | 1u << 1 | 1u << 5, 0, 7u << 3, 63};

struct ForestRig {
  // `decades`: range of the masses
  ForestRig(unsigned seed, int bodies, double decades) : draw(seed) {
    solver::IndexedArray<Vec3> places;
    for (int i = 0; i < bodies; ++i) {
      // a third of the nodes start a new tree or branch off; roots are attached to the world or float
      int parent = i - 1;
      if (draw.below(3) == 0) parent = draw.below(i + 1) - 1;
      if (draw.below(12) == 0) parent = -1;
      if (parent >= 0 && parent < tree_start) parent = i - 1;
      if (parent < 0) tree_start = i;
      add(parent, parent < 0 && draw.below(2) == 0 ? 5 : draw.below(5), decades, places);
    }
  }
  void add(int parent, int kind, double decades, solver::IndexedArray<Vec3>& places) {
    const Vec3 from = parent < 0 ? Vec3(0, 0, 1) : places[parent];
    const Vec3 place = from + draw.vec(0.3);
    const Vec3 pivot = from + draw.vec(0.2);
    places.push_back(place);
    solver::TreeNode& n = solver.add(parent);
    const double mass = std::pow(10, draw(-decades / 2, decades / 2));
    const Mat3 turned = glm::mat3_cast(quat_axis(normalized(draw.vec(1)), draw(0, 3)));
    n.offset = place - from;
    n.inertia =
        solver::SpatialInertia(mass, tensor(mass * 0.01 * Vec3(draw(0.5, 1), draw(0.5, 1), draw(0.5, 1)), turned));
    const Vec3 arm = pivot - place;  // rotations are about the pivot
    for (int k = 0; k < 3; ++k) {
      const auto column = static_cast<int>(k);
      n.axis[k] = {turned[column], Vec3(0)};
      const Vec3 e = normalized(turned[column] + draw.vec(0.2));
      n.axis[3 + k] = {glm::cross(arm, e), e};
    }
    n.prescribed = 63 & ~kFree[kind];
    for (int k = 0; k < 6; ++k) {
      n.input[k] = draw(-1, 1);
      if ((n.prescribed >> k & 1) == 0 && draw.below(3) == 0) n.damping[k] = std::pow(10, draw(-4, 4));
    }
    n.load = {draw.vec(1), draw.vec(1)};
  }

  // Unknowns: all body velocities, rates and joint impulses. Equations: the joint's motion, the body's momentum, and
  // the axis's law.
  solver::IndexedArray<double> dense() const {
    const auto n = solver.size();
    Matrix a(18 * n, solver::IndexedArray<double>(18 * n, 0));
    solver::IndexedArray<double> b(18 * n, 0);
    const auto unit = [](int d) {
      solver::Spatial s;
      (d < 3 ? s.linear : s.angular)[static_cast<int>(d % 3)] = 1;
      return s;
    };
    for (int i = 0; i < n; ++i) {
      const solver::TreeNode& node = solver.node(static_cast<int>(i));
      const auto p = std::max(node.parent, 0);
      for (int d = 0; d < 6; ++d) {
        // v - translated(v parent) - axis·rate = 0;  inertia·v - force + children's forces = load;  axis·force: the law
        a[18 * i + d][18 * i + d] = 1;
        b[18 * i + 6 + d] = solver::dot(unit(d), node.load);
        a[18 * i + 6 + d][18 * i + 12 + d] = -1;
        for (int k = 0; k < 6; ++k) {
          a[18 * i + d][18 * i + 6 + k] = -solver::dot(unit(d), node.axis[k]);
          a[18 * i + 6 + d][18 * i + k] = solver::dot(unit(d), node.inertia * unit(k));
          if (node.parent < 0) continue;
          a[18 * i + d][18 * p + k] = -solver::dot(unit(d), solver::translated(unit(k), node.offset));
          a[18 * p + 6 + d][18 * i + 12 + k] = solver::dot(unit(d), solver::translated_back(unit(k), node.offset));
        }
        const bool prescribed = (node.prescribed >> d & 1) != 0;
        a[18 * i + 12 + d][18 * i + 6 + d] = prescribed ? 1 : node.damping[d];
        b[18 * i + 12 + d] = node.input[d];
        for (int k = 0; k < 6 && !prescribed; ++k)
          a[18 * i + 12 + d][18 * i + 12 + k] = solver::dot(node.axis[d], unit(k));
      }
    }
    return dense_solve(std::move(a), std::move(b));
  }

  RandomNumbers draw;
  solver::Forest solver;
  int tree_start = 0;
};

double max_error(const ForestRig& f, const solver::IndexedArray<double>& x) {
  double worst = 0;
  for (int i = 0; i < f.solver.size(); ++i) {
    const solver::TreeNode& n = f.solver.node(i);
    const double* row = &x[18 * i];
    const double v[6] = {n.velocity_change.linear.x,  n.velocity_change.linear.y,  n.velocity_change.linear.z,
                         n.velocity_change.angular.x, n.velocity_change.angular.y, n.velocity_change.angular.z};
    solver::Spatial force{{row[12], row[13], row[14]}, {row[15], row[16], row[17]}};
    for (int d = 0; d < 6; ++d) {
      worst = std::max(worst, std::fabs(v[d] - row[d]) / (1 + std::fabs(row[d])));
      worst = std::max(worst, std::fabs(n.rate[d] - row[6 + d]) / (1 + std::fabs(row[6 + d])));
      const double impulse = solver::dot(n.axis[d], force);
      worst = std::max(worst, std::fabs(n.impulse[d] - impulse) / (1 + std::fabs(impulse)));
    }
  }
  return worst;
}

TEST(Forest, MatchesTheDenseSolutionOnRandomTrees) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    ForestRig f(seed, 1 + static_cast<int>(seed % 14), 4);
    ASSERT_TRUE(f.solver.factor(0, f.solver.size())) << seed;
    f.solver.solve(0, f.solver.size());
    EXPECT_LT(max_error(f, f.dense()), 1e-6) << seed;
  }
}

TEST(Forest, RespondMatchesSolve) {
  for (unsigned seed = 101; seed <= 130; ++seed) {
    ForestRig f(seed, 12, 2);
    solver::Forest& s = f.solver;
    for (int i = 0; i < s.size(); ++i) {
      s.node(i).input.fill(0);
      if (i % 4 != 0) s.node(i).load = {};
    }
    ASSERT_TRUE(s.factor(0, s.size()));
    s.solve(0, s.size());
    solver::IndexedArray<solver::Spatial> whole;
    for (int i = 0; i < s.size(); ++i) whole.push_back(s.node(i).velocity_change);
    s.respond(0, s.size());
    for (int i = 0; i < s.size(); ++i) {
      const solver::Spatial d = s.node(i).velocity_change - whole[i];
      EXPECT_LT(glm::length(d.linear) + glm::length(d.angular), 1e-9) << seed << " " << i;
    }
  }
}

// A contact row: it acts on two bodies, or on a free axis.
struct ContactRow {
  solver::TreeLoad a, b;
  int node = -1, axis = 0;  // the axis it acts on; -1: none
};

ContactRow random_contact_row(ForestRig& f) {
  ContactRow t;
  t.a = {f.draw.below(f.solver.size()), {f.draw.vec(1), f.draw.vec(1)}};
  if (f.draw.below(2) == 0) t.b = {f.draw.below(f.solver.size()), {f.draw.vec(1), f.draw.vec(1)}};
  const int axis = f.draw.below(6);
  if (f.draw.below(3) == 0 && (f.solver.node(t.a.node).prescribed >> axis & 1) == 0) {
    t.node = t.a.node;
    t.axis = axis;
    t.a.impulse = {};
  }
  return t;
}

// Half response of a row. Axes that are not on the way to the root stay zero; the others are below free_axis_count().
solver::IndexedArray<double> half_response_of(solver::Forest& s, const ContactRow& t) {
  const auto count = std::max(s.free_axis_count(t.a.node), t.b.node < 0 ? 0 : s.free_axis_count(t.b.node));
  solver::IndexedArray<double> half_response(6 * s.size(), 0);
  if (t.node >= 0) s.node(t.node).input[t.axis] = 1;
  s.half_response(t.a, t.b, std::span(half_response).first(count));
  if (t.node >= 0) s.node(t.node).input[t.axis] = 0;
  return half_response;
}

TEST(Forest, ProductOfHalfResponsesIsTheResponse) {
  int axis_rows = 0;
  for (unsigned seed = 201; seed <= 300; ++seed) {
    ForestRig f(seed, 1 + static_cast<int>(seed % 14), 2);
    solver::Forest& s = f.solver;
    ASSERT_TRUE(s.factor(0, s.size()));
    for (int i = 0; i < s.size(); ++i) s.node(i).input.fill(0);
    const ContactRow first = random_contact_row(f);
    const ContactRow second = random_contact_row(f);
    const solver::IndexedArray<double> one = half_response_of(s, first);
    const solver::IndexedArray<double> other = half_response_of(s, second);
    double product = 0;
    for (int k = 0; k < one.size(); ++k) product += one[k] * other[k];

    for (int i = 0; i < s.size(); ++i) s.node(i).load = {};
    for (const solver::TreeLoad& load : {first.a, first.b}) {
      if (load.node >= 0) s.node(load.node).load += load.impulse;
    }
    if (first.node >= 0) s.node(first.node).input[first.axis] = 1;
    s.respond(0, s.size());
    double rate = second.node < 0 ? 0 : s.node(second.node).rate[second.axis];
    for (const solver::TreeLoad& load : {second.a, second.b}) {
      if (load.node >= 0) rate += solver::dot(load.impulse, s.node(load.node).velocity_change);
    }
    EXPECT_NEAR(product, rate, 1e-9 * (1 + std::fabs(rate))) << seed;
    if (first.node >= 0 || second.node >= 0) axis_rows++;
  }
  EXPECT_GT(axis_rows, 20);
}

// A long chain with alternating heavy and light bodies: 340 prescribed axes have the prescribed rates, whatever the
// masses.
TEST(Forest, SolvesALongChainOfUnequalMasses) {
  solver::Forest s;
  for (int i = 0; i < 170; ++i) {
    solver::TreeNode& n = s.add(i - 1);
    const double mass = i % 2 == 0 ? 100 : 0.01;
    n.inertia = solver::SpatialInertia(mass, {mass * 1e-3, mass * 1e-3, mass * 1e-3, 0, 0, 0});
    n.offset = {0, 0, 0.2};
    for (int k = 0; k < 3; ++k) {
      Vec3 e(0);
      e[k] = 1;
      n.axis[k] = {e, Vec3(0)};
      n.axis[3 + k] = {glm::cross(Vec3(0, 0, -0.1), e), e};
    }
    n.prescribed = 63 & ~(1u << (3 + i % 2));
    n.load = {{0.3, 0, -mass}, Vec3(0)};
  }
  ASSERT_TRUE(s.factor(0, s.size()));
  s.solve(0, s.size());
  for (int i = 1; i < s.size(); ++i) {
    const solver::TreeNode& n = s.node(i);
    const solver::Spatial error = n.velocity_change - solver::translated(s.node(i - 1).velocity_change, n.offset) -
                                  n.axis[3 + i % 2] * n.rate[3 + i % 2];
    EXPECT_LT(glm::length(error.linear) + glm::length(error.angular),
              1e-12 * (1 + glm::length(n.velocity_change.linear)))
        << i;
  }
}

TEST(Forest, RejectsAnAxisWithoutMass) {
  for (const bool nan : {false, true}) {
    solver::Forest s;
    solver::TreeNode& n = s.add(-1);
    n.inertia = solver::SpatialInertia(nan ? std::nan("") : 1, {1, 1, 1, 0, 0, 0});
    n.axis[0] = {{1, 0, 0}, Vec3(0)};
    n.axis[1] = {{1, 0, 0}, Vec3(0)};  // the same motion again
    n.prescribed = 60;
    EXPECT_FALSE(s.factor(0, 1));
  }
}

}  // namespace
}  // namespace limber::sim
