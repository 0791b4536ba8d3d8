// Solid: closed forms of rays and distances for each kind of shape.
#include "sim/sensors/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/mesh/hull.h"
#include "model/mesh/surface.h"

namespace limber::sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The nearest point at which a ray enters, out of candidates.
class FirstEntry {
 public:
  FirstEntry(const Vec3& from, const Vec3& direction, double max)
      : from_(from), direction_(direction), best_{max, {}} {}

  Vec3 at(double t) const { return from_ + t * direction_; }
  /// Adds a candidate; one that leaves the solid or lies behind the start doesn't count.
  void add(double t, const Vec3& normal) {
    if (!(t >= 0) || !(t <= best_.distance) || !(glm::dot(normal, direction_) < 0)) return;
    best_ = {t, normal};
    found_ = true;
  }
  std::optional<SolidHit> result() const { return found_ ? std::optional(best_) : std::nullopt; }

  /// Calls f(t) for the real roots of a·t² + 2·b·t + c.
  template <class F>
  static void roots(double a, double b, double c, F&& f) {
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q != 0) f(c / q);
    if (a != 0) f(q / a);
  }
  void add_sphere(const Vec3& center, double radius, double low, double high) {
    const Vec3 d = from_ - center;
    roots(1, glm::dot(d, direction_), glm::dot(d, d) - radius * radius, [&](double t) {
      const Vec3 p = at(t) - center;
      if (p.z >= low && p.z <= high) add(t, p / radius);
    });
  }
  void add_ellipsoid(const Vec3& radii) {
    const Vec3 o = from_ / radii;
    const Vec3 d = direction_ / radii;
    roots(glm::dot(d, d), glm::dot(o, d), glm::dot(o, o) - 1,
          [&](double t) { add(t, normalized(at(t) / (radii * radii))); });
  }
  // The lateral surface of a cylinder about z.
  void add_tube(double radius, double half_height) {
    const Vec3 o(from_.x, from_.y, 0);
    const Vec3 d(direction_.x, direction_.y, 0);
    roots(glm::dot(d, d), glm::dot(o, d), glm::dot(o, o) - radius * radius, [&](double t) {
      const Vec3 p = at(t);
      if (std::fabs(p.z) <= half_height) add(t, Vec3(p.x, p.y, 0) / radius);
    });
  }
  // The lateral surface of a cone about z with its apex at +half_height.
  void add_cone(double radius, double half_height) {
    const double slope = radius / (2 * half_height);
    const double k = slope * slope;
    const double z = half_height - from_.z;
    const double dz = -direction_.z;
    const double a = direction_.x * direction_.x + direction_.y * direction_.y - k * dz * dz;
    const double b = from_.x * direction_.x + from_.y * direction_.y - k * z * dz;
    const double c = from_.x * from_.x + from_.y * from_.y - k * z * z;
    roots(a, b, c, [&](double t) {
      const Vec3 p = at(t);
      if (std::fabs(p.z) <= half_height) add(t, normalized(Vec3(p.x, p.y, k * (half_height - p.z))));
    });
  }
  void add_disc(double z, double radius) {
    if (direction_.z == 0) return;
    const double t = (z - from_.z) / direction_.z;
    const Vec3 p = at(t);
    if (p.x * p.x + p.y * p.y <= radius * radius) add(t, {0, 0, z > 0 ? 1.0 : -1.0});
  }
  void add_box(const Vec3& half) {
    for (int axis = 0; axis < 3; axis++) {
      if (direction_[axis] == 0) continue;
      const double side = direction_[axis] < 0 ? 1 : -1;
      const double t = (side * half[axis] - from_[axis]) / direction_[axis];
      const Vec3 p = at(t);
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      Vec3 normal(0);
      normal[axis] = side;
      if (std::fabs(p[u]) <= half[u] && std::fabs(p[v]) <= half[v]) add(t, normal);
    }
  }

 private:
  Vec3 from_;
  Vec3 direction_;
  SolidHit best_;
  bool found_ = false;
};

double square(double v) { return v * v; }

// Distance of the point (x, y) from a segment.
double segment_distance(double x, double y, double ax, double ay, double bx, double by) {
  const double length2 = square(bx - ax) + square(by - ay);
  const double t = length2 > 0 ? ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length2 : 0;
  const double s = std::clamp(t, 0.0, 1.0);
  return std::sqrt(square(x - ax - s * (bx - ax)) + square(y - ay - s * (by - ay)));
}

// Distance from a box about the origin, of any dimension.
double box_distance(const Vec3& excess) {
  const Vec3 outside = glm::max(excess, Vec3(0));
  return glm::length(outside) + std::min(std::max({excess.x, excess.y, excess.z}), 0.0);
}

double cone_distance(double rho, double z, double radius, double half_height) {
  const double side = segment_distance(rho, z, radius, -half_height, 0, half_height);
  const double base = segment_distance(rho, z, 0, -half_height, radius, -half_height);
  const bool inside = z >= -half_height && rho * 2 * half_height <= radius * (half_height - z);
  return inside ? -std::min(side, base) : std::min(side, base);
}

// Distance from an ellipsoid about the origin. Its point nearest to p is q = r²·p/(r² + t) per axis, with the only t
// above -min(r)² for which q is on the surface, found by bisection (Eberly, Distance from a Point to an Ellipsoid,
// 2013).
double ellipsoid_distance(const Vec3& point, const Vec3& radii) {
  constexpr int kHalvings = 80;
  const double smallest = std::min({radii.x, radii.y, radii.z});
  // in a plane of symmetry the nearest point would be undetermined
  const Vec3 p = glm::max(glm::abs(point), 1e-9 * radii);
  const Vec3 squares = radii * radii;
  double low = -smallest * smallest;
  double high = glm::length(p * radii);
  for (int i = 0; i < kHalvings; i++) {
    const double t = (low + high) / 2;
    const Vec3 scaled = radii * p / (squares + t);
    (glm::dot(scaled, scaled) > 1 ? low : high) = t;
  }
  const Vec3 nearest = squares * p / (squares + high);
  const double distance = glm::length(p - nearest);
  return glm::dot(p / radii, p / radii) < 1 ? -distance : distance;
}

}  // namespace

Solid::Solid(const model::PlacedShape& placed)
    : kind_(placed.shape.kind),
      origin_(placed.origin),
      normal_(normalized(placed.shape.normal)),
      radius_(placed.shape.radius),
      half_height_(placed.shape.height / 2) {
  switch (kind_) {
    case model::ShapeKind::sphere:
      half_ = Vec3(radius_);
      break;
    case model::ShapeKind::box:
    case model::ShapeKind::ellipsoid:
      half_ = placed.shape.size / 2.0;
      break;
    case model::ShapeKind::capsule:
      half_ = {radius_, radius_, half_height_ + radius_};
      break;
    case model::ShapeKind::mesh:
      if (placed.shape.surface != nullptr) {
        surface_ = placed.shape.surface;
        half_ = (surface_->high() - surface_->low()) / 2.0;
        center_ = (surface_->high() + surface_->low()) / 2.0;
      } else if (placed.shape.mesh != nullptr) {
        add_hull(*placed.shape.mesh);
      }
      break;
    default:
      half_ = {radius_, radius_, half_height_};
  }
}

void Solid::add_hull(const model::MeshModel& mesh) {
  const int count = static_cast<int>(mesh.hull.size());
  const model::Hull hull = model::reduced_hull(mesh.hull, {count, count, 0});
  auto faces = std::make_shared<std::vector<Face>>();
  Vec3 low(kInfinity);
  Vec3 high(-kInfinity);
  for (std::size_t i = 0; i + 2 < hull.triangles.size(); i += 3) {
    Face face{hull.vertices[hull.triangles[i]], hull.vertices[hull.triangles[i + 1]],
              hull.vertices[hull.triangles[i + 2]], Vec3(0), 0};
    face.normal = normalized(glm::cross(face.b - face.a, face.c - face.a));
    face.offset = glm::dot(face.normal, face.a);
    for (const Vec3& corner : {face.a, face.b, face.c}) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    if (face.normal != Vec3(0)) faces->push_back(face);
  }
  if (!faces->empty()) {
    half_ = (high - low) / 2.0;
    center_ = (high + low) / 2.0;
  }
  faces_ = std::move(faces);
}

std::optional<SolidHit> Solid::intersect(const Vec3& from, const Vec3& direction, double max) const {
  if (surface_ != nullptr) {
    const std::optional<model::SurfaceHit> hit = surface_->ray(from, direction, max);
    return hit ? std::optional(SolidHit{hit->distance, hit->normal}) : std::nullopt;
  }
  if (kind_ == model::ShapeKind::mesh) return intersect_hull(from, direction, max);
  FirstEntry entry(from, direction, max);
  switch (kind_) {
    case model::ShapeKind::plane:
      if (const double speed = glm::dot(normal_, direction); speed != 0)
        entry.add(-glm::dot(normal_, from) / speed, normal_);
      break;
    case model::ShapeKind::sphere:
      entry.add_sphere(Vec3(0), radius_, -kInfinity, kInfinity);
      break;
    case model::ShapeKind::box:
      entry.add_box(half_);
      break;
    case model::ShapeKind::ellipsoid:
      entry.add_ellipsoid(half_);
      break;
    case model::ShapeKind::cylinder:
      entry.add_tube(radius_, half_height_);
      for (const double z : {-half_height_, half_height_}) entry.add_disc(z, radius_);
      break;
    case model::ShapeKind::capsule:
      entry.add_tube(radius_, half_height_);
      entry.add_sphere({0, 0, half_height_}, radius_, 0, kInfinity);
      entry.add_sphere({0, 0, -half_height_}, radius_, -kInfinity, 0);
      break;
    case model::ShapeKind::cone:
      entry.add_cone(radius_, half_height_);
      entry.add_disc(-half_height_, radius_);
      break;
    default:
      break;
  }
  return entry.result();
}

// The ray is inside between the last face that it enters and the first that it leaves.
std::optional<SolidHit> Solid::intersect_hull(const Vec3& from, const Vec3& direction, double max) const {
  double enter = -kInfinity;
  double leave = kInfinity;
  Vec3 normal(0);
  if (faces_ == nullptr) return {};
  for (const Face& face : *faces_) {
    const double speed = glm::dot(face.normal, direction);
    const double height = glm::dot(face.normal, from) - face.offset;
    if (speed == 0) {
      if (height > 0) return {};
      continue;
    }
    const double t = -height / speed;
    if (speed > 0) {
      leave = std::min(leave, t);
    } else if (t > enter) {
      enter = t;
      normal = face.normal;
    }
  }
  if (!(enter >= 0) || !(enter <= max) || !(enter <= leave)) return {};
  return SolidHit{enter, normal};
}

double Solid::hull_distance(const Vec3& point) const {
  double height = -kInfinity;
  double distance = kInfinity;
  if (faces_ == nullptr) return kInfinity;
  for (const Face& face : *faces_) height = std::max(height, glm::dot(face.normal, point) - face.offset);
  if (height <= 0) return height;
  for (const Face& face : *faces_)
    distance = std::min(distance, model::triangle_distance(point, face.a, face.b, face.c));
  return distance;
}

double Solid::signed_distance(const Vec3& point) const {
  const double rho = std::sqrt(square(point.x) + square(point.y));
  switch (kind_) {
    case model::ShapeKind::plane:
      return glm::dot(normal_, point);
    case model::ShapeKind::sphere:
      return glm::length(point) - radius_;
    case model::ShapeKind::box:
      return box_distance(glm::abs(point) - half_);
    case model::ShapeKind::ellipsoid:
      return ellipsoid_distance(point, half_);
    case model::ShapeKind::cylinder:
      return box_distance({rho - radius_, std::fabs(point.z) - half_height_, -kInfinity});
    case model::ShapeKind::capsule:
      return segment_distance(rho, point.z, 0, -half_height_, 0, half_height_) - radius_;
    case model::ShapeKind::cone:
      return cone_distance(rho, point.z, radius_, half_height_);
    case model::ShapeKind::mesh:
      return surface_ != nullptr ? surface_->distance(point) : hull_distance(point);
    default:
      return kInfinity;
  }
}

}  // namespace limber::sim
