// Mass properties. Sources: Tonon 2004 (tetrahedra), the parallel axis theorem, and standard formulas for solids.
#include "model/mesh/mass_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace limber::model {

namespace {

Mat3 outer_product(const Vec3& a, const Vec3& b) { return glm::outerProduct(a, b); }
Mat3 diagonal(double x, double y, double z) { return Mat3(x, 0, 0, 0, y, 0, 0, 0, z); }
double trace(const Mat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

/// The inertia tensor that corresponds to the second moments ∫ r rᵀ dm.
Mat3 tensor_of_moments(const Mat3& moments) { return Mat3(trace(moments)) - moments; }

}  // namespace

PrincipalAxes principal_axes(const Mat3& tensor) {
  Mat3 a = tensor;
  Mat3 axes(1);
  for (int sweep = 0; sweep < 60; ++sweep) {
    // rotate the largest off-diagonal element to zero
    int p = 0, q = 1;
    for (const auto& [i, j] : {std::array{0, 2}, std::array{1, 2}}) {
      if (std::abs(a[i][j]) > std::abs(a[p][q])) p = i, q = j;
    }
    const double off = a[p][q];
    if (off == 0 || std::abs(off) < 1e-17 * (std::abs(a[p][p]) + std::abs(a[q][q]))) break;
    const double theta = (a[q][q] - a[p][p]) / (2 * off);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + fixed::hypot(theta, 1.0));
    const double c = 1 / fixed::hypot(t, 1.0);
    Mat3 rotation(1);
    rotation[p][p] = rotation[q][q] = c;
    rotation[q][p] = t * c;
    rotation[p][q] = -t * c;
    a = glm::transpose(rotation) * a * rotation;
    axes = axes * rotation;
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
  PrincipalAxes out;
  for (int i = 0; i < 3; ++i) {
    const int from = order[static_cast<std::size_t>(i)];
    out.moments[i] = a[from][from];
    out.axes[i] = axes[from];
  }
  if (glm::determinant(out.axes) < 0) out.axes[2] = -out.axes[2];
  return out;
}

Inertial unit_inertial_of(std::span<const Vec3> vertices, std::span<const unsigned> triangles) {
  Inertial out;
  if (triangles.size() < 3) return out;
  // relative to a vertex of the mesh, so that meshes far from the origin lose no precision
  const Vec3 base = vertices[triangles[0]];
  double volume = 0;
  Vec3 first(0);
  Mat3 second(0);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vec3 a = vertices[triangles[i]] - base;
    const Vec3 b = vertices[triangles[i + 1]] - base;
    const Vec3 c = vertices[triangles[i + 2]] - base;
    const double v = glm::dot(a, glm::cross(b, c)) / 6;
    const Vec3 s = a + b + c;
    volume += v;
    first += v / 4 * s;
    second += v / 20 * (outer_product(a, a) + outer_product(b, b) + outer_product(c, c) + outer_product(s, s));
  }
  if (volume == 0) return out;
  const Vec3 center = first / volume;
  out.mass = volume;
  out.center = base + center;
  out.tensor = tensor_of_moments(second - volume * outer_product(center, center));
  return out;
}

bool is_closed(std::span<const unsigned> triangles) {
  if (triangles.empty()) return false;
  std::vector<std::uint64_t> edges;
  edges.reserve(triangles.size());
  const auto key = [](unsigned a, unsigned b) { return (static_cast<std::uint64_t>(a) << 32u) | b; };
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(key(triangles[i + k], triangles[i + (k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](std::uint64_t e) {
    return std::binary_search(edges.begin(), edges.end(), (e << 32u) | (e >> 32u));
  });
}

Inertial unit_inertial_of(const ShapeModel& shape) {
  const double r = shape.radius;
  const double h = shape.height;
  Inertial out;
  switch (shape.kind) {
    case ShapeKind::box: {
      const Vec3 s = shape.size * shape.size;
      out.mass = shape.size.x * shape.size.y * shape.size.z;
      out.tensor = diagonal(s.y + s.z, s.x + s.z, s.x + s.y) * (out.mass / 12);
      break;
    }
    case ShapeKind::sphere:
      out.mass = 4.0 / 3 * kPi * r * r * r;
      out.tensor = Mat3(0.4 * out.mass * r * r);
      break;
    case ShapeKind::ellipsoid: {
      const Vec3 s = shape.size * shape.size;
      out.mass = kPi / 6 * shape.size.x * shape.size.y * shape.size.z;
      out.tensor = diagonal(s.y + s.z, s.x + s.z, s.x + s.y) * (out.mass / 20);
      break;
    }
    case ShapeKind::cylinder:
      out.mass = kPi * r * r * h;
      out.tensor = diagonal(3 * r * r + h * h, 3 * r * r + h * h, 6 * r * r) * (out.mass / 12);
      break;
    case ShapeKind::capsule: {
      const double tube = kPi * r * r * h;
      const double caps = 4.0 / 3 * kPi * r * r * r;
      const double across = tube * (r * r / 4 + h * h / 12) + caps * (0.4 * r * r + h * h / 4 + 0.375 * r * h);
      out.mass = tube + caps;
      out.tensor = diagonal(across, across, tube * r * r / 2 + caps * 0.4 * r * r);
      break;
    }
    case ShapeKind::cone: {
      // the base is at z = -h/2, so the center of mass is at z = -h/4, a quarter of the height above the base
      out.mass = kPi * r * r * h / 3;
      out.center = {0, 0, -h / 4};
      const double across = out.mass * (0.15 * r * r + 0.0375 * h * h);
      out.tensor = diagonal(across, across, out.mass * 0.3 * r * r);
      break;
    }
    case ShapeKind::mesh:
      if (shape.mesh) out = shape.mesh->unit_inertial;
      break;
    case ShapeKind::plane:
    case ShapeKind::compound:
      break;
  }
  return out;
}

Inertial transformed(const Inertial& body, const Pose& pose) {
  const Mat3 rotation = glm::mat3_cast(pose.rotation);
  return {body.mass, pose * body.center, rotation * body.tensor * glm::transpose(rotation)};
}

Inertial scaled(const Inertial& body, double factor) { return {body.mass * factor, body.center, body.tensor * factor}; }

Inertial combined(std::span<const Inertial> bodies) {
  Inertial out;
  for (const Inertial& b : bodies) {
    out.mass += b.mass;
    out.center += b.mass * b.center;
  }
  if (out.mass <= 0) return {};
  out.center /= out.mass;
  for (const Inertial& b : bodies) {
    const Vec3 d = b.center - out.center;
    out.tensor += b.tensor + b.mass * tensor_of_moments(outer_product(d, d));
  }
  return out;
}

std::string tensor_error(const Mat3& tensor) {
  const Vec3 m = principal_axes(tensor).moments;
  if (!is_finite(m)) return "it is not finite";
  if (m.z <= 0) return "all of it is zero or less";
  // files round to a few digits: thin plates, where the two small moments add up to the large one, must be accepted
  constexpr double kRounding = 0.01;
  if (m.x < -kRounding * m.z) return "it has a negative principal moment";
  if (m.x + m.y < (1 - kRounding) * m.z) return "one principal moment is larger than the other two together";
  return {};
}

Mat3 regularized_tensor(const Mat3& tensor, bool& raised) {
  constexpr double kMinMoment = 1e-6;
  constexpr double kMinRelativeMoment = 1e-3;
  const PrincipalAxes p = principal_axes(tensor);
  const double min_moment = std::max(kMinMoment, kMinRelativeMoment * p.moments.z);
  raised = p.moments.x < min_moment;
  if (!raised) return tensor;
  const Vec3 m = glm::max(p.moments, Vec3(min_moment));
  return p.axes * diagonal(m.x, m.y, m.z) * glm::transpose(p.axes);
}

}  // namespace limber::model
