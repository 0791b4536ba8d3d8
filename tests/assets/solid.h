// Mass properties of solids, computed for the tests from triangles and formulas.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber {

/// Integrals over a solid of density 1: volume, first and second moments about the origin.
struct Moments {
  double volume = 0;
  Vec3 first{0};
  Mat3 second{0};

  void add(const Moments& other, double density) {
    volume += density * other.volume;
    first += density * other.first;
    second += density * other.second;
  }
};

/// Computes the integrals of a closed mesh: a triangle a b c and the origin form a tetrahedron with the second moment
/// det/120 (s sᵀ + a aᵀ + b bᵀ + c cᵀ), s = a + b + c.
inline Moments moments_of_mesh(const model::MeshModel& mesh, const Pose& origin) {
  Moments sum;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = origin * mesh.vertices[mesh.triangles[t + k]];
    const double det = glm::dot(p[0], glm::cross(p[1], p[2]));
    const Vec3 s = p[0] + p[1] + p[2];
    sum.volume += det / 6;
    sum.first += det / 24 * s;
    Mat3 outer = glm::outerProduct(s, s);
    for (const Vec3& corner : p) outer += glm::outerProduct(corner, corner);
    sum.second += det / 120 * outer;
  }
  return sum;
}

/// Computes the integrals of a ball; about its center, each diagonal second moment is V r²/5.
inline Moments moments_of_ball(double radius, const Vec3& center) {
  const double volume = 4.0 / 3 * kPi * radius * radius * radius;
  return {volume, volume * center, volume * (Mat3(radius * radius / 5) + glm::outerProduct(center, center))};
}

/// True if each directed edge occurs once and its reverse once, as in a closed, consistently oriented surface.
inline bool is_closed(const model::MeshModel& mesh) {
  std::set<std::pair<unsigned, unsigned>> edges;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.insert({mesh.triangles[t + k], mesh.triangles[t + (k + 1) % 3]}).second) return false;
    }
  }
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edges.count({edge.second, edge.first}) == 1;
  });
}

/// Returns the eigenvalues of a symmetric matrix in ascending order (Jacobi method).
inline Vec3 principal_moments(Mat3 m) {
  for (int round = 0; round < 60; ++round) {
    const int p = round % 3;
    const int q = (p + 1) % 3;
    if (m[q][p] == 0) continue;
    // The smaller of the two possible angles; the larger one swaps axes and may not converge.
    const double difference = m[q][q] - m[p][p];
    const double angle = 0.5 * std::atan2(std::copysign(2 * m[q][p], m[q][p] * difference), std::abs(difference));
    Mat3 turn(1);
    turn[p][p] = turn[q][q] = std::cos(angle);
    turn[q][p] = std::sin(angle);
    turn[p][q] = -turn[q][p];
    m = glm::transpose(turn) * m * turn;
  }
  std::array<double, 3> values = {m[0][0], m[1][1], m[2][2]};
  std::sort(values.begin(), values.end());
  return {values[0], values[1], values[2]};
}

}  // namespace limber
