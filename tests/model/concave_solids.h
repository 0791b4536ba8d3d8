// Closed meshes of solids that aren't convex.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "solids.h"

namespace limber::model::test {

/// A torus about z.
inline Solid torus(double radius, double tube, unsigned around = 48, unsigned across = 24) {
  Solid s;
  for (unsigned i = 0; i < around; ++i) {
    for (unsigned j = 0; j < across; ++j) {
      const double a = 2 * kPi * i / around, b = 2 * kPi * j / across;
      const double out = radius + tube * std::cos(b);
      s.vertices.emplace_back(out * std::cos(a), out * std::sin(a), tube * std::sin(b));
    }
  }
  for (unsigned i = 0; i < around; ++i) {
    for (unsigned j = 0; j < across; ++j) {
      const unsigned next = (i + 1) % around * across, up = (j + 1) % across;
      s.quad(i * across + j, next + j, next + up, i * across + up);
    }
  }
  return s;
}

/// An outline in x and y, extruded from z = 0 to 1. `triangles`: those of the outline.
inline Solid extruded(const std::vector<std::pair<double, double>>& outline,
                      const std::vector<std::array<unsigned, 3>>& triangles) {
  Solid s;
  const auto count = static_cast<unsigned>(outline.size());
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : outline) s.vertices.emplace_back(x, y, z);
  }
  for (unsigned i = 0; i < count; ++i) {
    const unsigned next = (i + 1) % count;
    s.quad(i, next, count + next, count + i);
  }
  for (const auto& [a, b, c] : triangles)
    s.triangles.insert(s.triangles.end(), {a, c, b, count + a, count + b, count + c});
  return s;
}

/// A U with a base of 3 × 1 and two prongs of 1 × 2.
inline Solid u_profile() {
  return extruded({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},
                  {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}});
}

/// A plate from (0, 0, 0) to (1, 1, height) with a rectangular hole through it.
inline Solid plate_with_hole(const std::pair<double, double>& low, const std::pair<double, double>& high,
                             double height) {
  Solid s;
  for (const double z : {0.0, height}) {
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      s.vertices.emplace_back(x, y, z);
    for (const auto& [x, y] :
         std::vector<std::pair<double, double>>{low, {high.first, low.second}, high, {low.first, high.second}})
      s.vertices.emplace_back(x, y, z);
  }
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned next = (i + 1) % 4;
    s.quad(i, next, 8 + next, 8 + i);
    s.quad(4 + next, 4 + i, 12 + i, 12 + next);
    s.quad(8 + i, 8 + next, 12 + next, 12 + i);
    s.quad(next, i, 4 + i, 4 + next);
  }
  return s;
}

}  // namespace limber::model::test
