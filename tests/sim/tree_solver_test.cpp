// The tree solver against dense elimination of the whole system, on random trees.
#include "sim/tree_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace limber {
namespace {

using Matrix = std::vector<std::vector<double>>;

// x of a·x = b, by elimination with row exchange
std::vector<double> dense_solve(Matrix a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t best = c;
    for (std::size_t r = c; r < n; ++r) {
      if (std::fabs(a[r][c]) > std::fabs(a[best][c])) best = r;
    }
    std::swap(a[c], a[best]);
    std::swap(b[c], b[best]);
    for (std::size_t r = c + 1; r < n; ++r) {
      const double f = a[r][c] / a[c][c];
      if (f == 0) continue;
      for (std::size_t k = c; k < n; ++k) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  for (std::size_t r = n; r-- > 0;) {
    for (std::size_t k = r + 1; k < n; ++k) b[r] -= a[r][k] * b[k];
    b[r] /= a[r][r];
  }
  return b;
}

struct Draw {
  explicit Draw(unsigned seed) : generator(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
  Vec3 vec(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(generator); }
  std::mt19937 generator;
};

// R·diag·R', a real body's tensor
Sym3 tensor(const Vec3& d, const Mat3& r) {
  const Mat3 m = r * Mat3(d.x, 0, 0, 0, d.y, 0, 0, 0, d.z) * glm::transpose(r);
  return {m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]};
}

// Which axes a joint kind leaves free: revolute, prismatic, planar, fixed, ball, floating.
constexpr unsigned kFree[] = {1u << 5, 1u << 2, 1u << 0 | 1u << 1 | 1u << 5, 0, 7u << 3, 63};

struct Forest {
  // `decades`: masses lie so far apart
  Forest(unsigned seed, int bodies, double decades) : draw(seed) {
    std::vector<Vec3> places;
    for (int i = 0; i < bodies; ++i) {
      // a third begins a new tree or branches off; roots stand on the world or float
      int parent = i - 1;
      if (draw.below(3) == 0) parent = draw.below(i + 1) - 1;
      if (draw.below(12) == 0) parent = -1;
      if (parent >= 0 && parent < tree_start) parent = i - 1;
      if (parent < 0) tree_start = i;
      add(parent, parent < 0 && draw.below(2) == 0 ? 5 : draw.below(5), decades, places);
    }
  }
  void add(int parent, int kind, double decades, std::vector<Vec3>& places) {
    const Vec3 from = parent < 0 ? Vec3(0, 0, 1) : places[static_cast<std::size_t>(parent)];
    const Vec3 place = from + draw.vec(0.3);
    const Vec3 pivot = from + draw.vec(0.2);
    places.push_back(place);
    TreeNode& n = solver.add(parent);
    const double mass = std::pow(10, draw(-decades / 2, decades / 2));
    const Mat3 turned = glm::mat3_cast(quat_axis(normalized(draw.vec(1)), draw(0, 3)));
    n.shift = place - from;
    n.inertia = SpatialInertia(mass, tensor(mass * 0.01 * Vec3(draw(0.5, 1), draw(0.5, 1), draw(0.5, 1)), turned));
    const Vec3 arm = pivot - place;  // a motion turns about the pivot
    for (std::size_t k = 0; k < 3; ++k) {
      const auto column = static_cast<int>(k);
      n.axis[k] = {turned[column], Vec3(0)};
      const Vec3 e = normalized(turned[column] + draw.vec(0.2));
      n.axis[3 + k] = {glm::cross(arm, e), e};
    }
    n.held = 63 & ~kFree[kind];
    for (std::size_t k = 0; k < 6; ++k) {
      n.ask[k] = draw(-1, 1);
      if ((n.held >> k & 1) == 0 && draw.below(3) == 0) n.conductance[k] = std::pow(10, draw(-4, 4));
    }
    n.load = {draw.vec(1), draw.vec(1)};
  }

  // Unknown: all body velocities, rates and joint impulses. The joint's motion is one equation, the body's momentum
  // another, the axis's law a third.
  std::vector<double> dense() const {
    const auto n = static_cast<std::size_t>(solver.size());
    Matrix a(18 * n, std::vector<double>(18 * n, 0));
    std::vector<double> b(18 * n, 0);
    const auto unit = [](std::size_t d) {
      Spatial s;
      (d < 3 ? s.linear : s.angular)[static_cast<int>(d % 3)] = 1;
      return s;
    };
    for (std::size_t i = 0; i < n; ++i) {
      const TreeNode& node = solver.node(static_cast<int>(i));
      const auto p = static_cast<std::size_t>(std::max(node.parent, 0));
      for (std::size_t d = 0; d < 6; ++d) {
        // v - carried(v parent) - axis·rate = 0;  inertia·v - force + children's forces = load;  axis·force: the law
        a[18 * i + d][18 * i + d] = 1;
        b[18 * i + 6 + d] = dot(unit(d), node.load);
        a[18 * i + 6 + d][18 * i + 12 + d] = -1;
        for (std::size_t k = 0; k < 6; ++k) {
          a[18 * i + d][18 * i + 6 + k] = -dot(unit(d), node.axis[k]);
          a[18 * i + 6 + d][18 * i + k] = dot(unit(d), node.inertia * unit(k));
          if (node.parent < 0) continue;
          a[18 * i + d][18 * p + k] = -dot(unit(d), carried(unit(k), node.shift));
          a[18 * p + 6 + d][18 * i + 12 + k] = dot(unit(d), brought_back(unit(k), node.shift));
        }
        const bool held = (node.held >> d & 1) != 0;
        a[18 * i + 12 + d][18 * i + 6 + d] = held ? 1 : node.conductance[d];
        b[18 * i + 12 + d] = node.ask[d];
        for (std::size_t k = 0; k < 6 && !held; ++k) a[18 * i + 12 + d][18 * i + 12 + k] = dot(node.axis[d], unit(k));
      }
    }
    return dense_solve(std::move(a), std::move(b));
  }

  Draw draw;
  TreeSolver solver;
  int tree_start = 0;
};

double worst_difference(const Forest& f, const std::vector<double>& x) {
  double worst = 0;
  for (int i = 0; i < f.solver.size(); ++i) {
    const TreeNode& n = f.solver.node(i);
    const double* row = &x[18 * static_cast<std::size_t>(i)];
    const double v[6] = {n.change.linear.x,  n.change.linear.y,  n.change.linear.z,
                         n.change.angular.x, n.change.angular.y, n.change.angular.z};
    Spatial force{{row[12], row[13], row[14]}, {row[15], row[16], row[17]}};
    for (std::size_t d = 0; d < 6; ++d) {
      worst = std::max(worst, std::fabs(v[d] - row[d]) / (1 + std::fabs(row[d])));
      worst = std::max(worst, std::fabs(n.rate[d] - row[6 + d]) / (1 + std::fabs(row[6 + d])));
      const double impulse = dot(n.axis[d], force);
      worst = std::max(worst, std::fabs(n.impulse[d] - impulse) / (1 + std::fabs(impulse)));
    }
  }
  return worst;
}

TEST(TreeSolver, IsTheDenseSolutionOnRandomTrees) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Forest f(seed, 1 + static_cast<int>(seed % 14), 4);
    ASSERT_TRUE(f.solver.factor(0, f.solver.size())) << seed;
    f.solver.solve(0, f.solver.size());
    EXPECT_LT(worst_difference(f, f.dense()), 1e-6) << seed;
  }
}

TEST(TreeSolver, LoadsAloneGiveTheSameAsTheWhole) {
  for (unsigned seed = 101; seed <= 130; ++seed) {
    Forest f(seed, 12, 2);
    TreeSolver& s = f.solver;
    for (int i = 0; i < s.size(); ++i) {
      s.node(i).ask.fill(0);
      if (i % 4 != 0) s.node(i).load = {};
    }
    ASSERT_TRUE(s.factor(0, s.size()));
    s.solve(0, s.size());
    std::vector<Spatial> whole;
    whole.reserve(static_cast<std::size_t>(s.size()));
    for (int i = 0; i < s.size(); ++i) whole.push_back(s.node(i).change);
    s.respond(0, s.size());
    for (int i = 0; i < s.size(); ++i) {
      const Spatial d = s.node(i).change - whole[static_cast<std::size_t>(i)];
      EXPECT_LT(glm::length(d.linear) + glm::length(d.angular), 1e-9) << seed << " " << i;
    }
  }
}

// What one row of contacts does: it pushes two bodies, or asks something of a free axis.
struct Touch {
  TreeLoad a, b;
  int node = -1, axis = 0;  // asked of; -1: none
};

Touch touch(Forest& f) {
  Touch t;
  t.a = {f.draw.below(f.solver.size()), {f.draw.vec(1), f.draw.vec(1)}};
  if (f.draw.below(2) == 0) t.b = {f.draw.below(f.solver.size()), {f.draw.vec(1), f.draw.vec(1)}};
  const int axis = f.draw.below(6);
  if (f.draw.below(3) == 0 && (f.solver.node(t.a.node).held >> axis & 1) == 0) {
    t.node = t.a.node;
    t.axis = axis;
    t.a.impulse = {};
  }
  return t;
}

// Free axes that are not on the way are left alone, and those that are lie where free_axes() says.
std::vector<double> felt_by(TreeSolver& s, const Touch& t) {
  const auto count =
      static_cast<std::size_t>(std::max(s.free_axes(t.a.node), t.b.node < 0 ? 0 : s.free_axes(t.b.node)));
  std::vector<double> felt(static_cast<std::size_t>(6 * s.size()), 0);
  if (t.node >= 0) s.node(t.node).ask[static_cast<std::size_t>(t.axis)] = 1;
  s.feel(t.a, t.b, std::span(felt).first(count));
  if (t.node >= 0) s.node(t.node).ask[static_cast<std::size_t>(t.axis)] = 0;
  return felt;
}

TEST(TreeSolver, HalvesOfTwoResponsesMakeTheResponse) {
  int asked = 0;
  for (unsigned seed = 201; seed <= 300; ++seed) {
    Forest f(seed, 1 + static_cast<int>(seed % 14), 2);
    TreeSolver& s = f.solver;
    ASSERT_TRUE(s.factor(0, s.size()));
    for (int i = 0; i < s.size(); ++i) s.node(i).ask.fill(0);
    const Touch first = touch(f);
    const Touch second = touch(f);
    const std::vector<double> one = felt_by(s, first);
    const std::vector<double> other = felt_by(s, second);
    double product = 0;
    for (std::size_t k = 0; k < one.size(); ++k) product += one[k] * other[k];

    for (int i = 0; i < s.size(); ++i) s.node(i).load = {};
    for (const TreeLoad& load : {first.a, first.b}) {
      if (load.node >= 0) s.node(load.node).load += load.impulse;
    }
    if (first.node >= 0) s.node(first.node).ask[static_cast<std::size_t>(first.axis)] = 1;
    s.respond(0, s.size());
    double rate = second.node < 0 ? 0 : s.node(second.node).rate[static_cast<std::size_t>(second.axis)];
    for (const TreeLoad& load : {second.a, second.b}) {
      if (load.node >= 0) rate += dot(load.impulse, s.node(load.node).change);
    }
    EXPECT_NEAR(product, rate, 1e-9 * (1 + std::fabs(rate))) << seed;
    if (first.node >= 0 || second.node >= 0) asked++;
  }
  EXPECT_GT(asked, 20);
}

// A long chain of heavy and light bodies in turn: what is asked of 340 locked rows comes out, whatever the masses.
TEST(TreeSolver, HoldsALongChainOfUnequalMasses) {
  TreeSolver s;
  for (int i = 0; i < 170; ++i) {
    TreeNode& n = s.add(i - 1);
    const double mass = i % 2 == 0 ? 100 : 0.01;
    n.inertia = SpatialInertia(mass, {mass * 1e-3, mass * 1e-3, mass * 1e-3, 0, 0, 0});
    n.shift = {0, 0, 0.2};
    for (int k = 0; k < 3; ++k) {
      Vec3 e(0);
      e[k] = 1;
      n.axis[static_cast<std::size_t>(k)] = {e, Vec3(0)};
      n.axis[3 + static_cast<std::size_t>(k)] = {glm::cross(Vec3(0, 0, -0.1), e), e};
    }
    n.held = 63 & ~(1u << (3 + i % 2));
    n.load = {{0.3, 0, -mass}, Vec3(0)};
  }
  ASSERT_TRUE(s.factor(0, s.size()));
  s.solve(0, s.size());
  for (int i = 1; i < s.size(); ++i) {
    const TreeNode& n = s.node(i);
    const Spatial torn = n.change - carried(s.node(i - 1).change, n.shift) -
                         n.axis[static_cast<std::size_t>(3 + i % 2)] * n.rate[static_cast<std::size_t>(3 + i % 2)];
    EXPECT_LT(glm::length(torn.linear) + glm::length(torn.angular), 1e-12 * (1 + glm::length(n.change.linear))) << i;
  }
}

TEST(TreeSolver, RefusesAnAxisThatMovesNoMass) {
  for (const bool nan : {false, true}) {
    TreeSolver s;
    TreeNode& n = s.add(-1);
    n.inertia = SpatialInertia(nan ? std::nan("") : 1, {1, 1, 1, 0, 0, 0});
    n.axis[0] = {{1, 0, 0}, Vec3(0)};
    n.axis[1] = {{1, 0, 0}, Vec3(0)};  // the same motion once more
    n.held = 60;
    EXPECT_FALSE(s.factor(0, 1));
  }
}

}  // namespace
}  // namespace limber
