// Pieces of meshes: from the objects of a file; lists of convex shapes for collision.
#include "model/pieces/pieces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "model/mesh/fit_primitive.h"
#include "model/mesh/mass_properties.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxObjects = 1000;  // limits the time to find hulls that are inside others

using Triangles = std::vector<unsigned>;

// The triangles of each object, in the order of the objects' first triangles.
std::vector<Triangles> triangles_by_object(const MeshModel& mesh, std::span<const std::uint32_t> objects) {
  std::vector<Triangles> out;
  std::vector<std::uint32_t> number;  // by object
  for (std::size_t t = 0; t < objects.size(); ++t) {
    if (objects[t] >= number.size()) number.resize(objects[t] + 1, std::numeric_limits<std::uint32_t>::max());
    std::uint32_t& of_object = number[objects[t]];
    if (of_object == std::numeric_limits<std::uint32_t>::max()) {
      of_object = static_cast<std::uint32_t>(out.size());
      out.emplace_back();
    }
    const auto corner = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
    out[of_object].insert(out[of_object].end(), corner, corner + 3);
  }
  return out;
}

/// Joins open objects that share vertices: exporters write one object for each material or face.
class PatchJoiner {
 public:
  explicit PatchJoiner(std::vector<Triangles> objects) : objects_(std::move(objects)), parent_(objects_.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::vector<Triangles> run(std::size_t vertices) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> user(vertices, kNone);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (is_watertight(objects_[i])) continue;
      for (const unsigned vertex : objects_[i]) {
        if (user[vertex] == kNone) user[vertex] = i;
        join(user[vertex], i);
      }
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const std::size_t to = root(i);
      if (to != i) objects_[to].insert(objects_[to].end(), objects_[i].begin(), objects_[i].end());
    }
    std::vector<Triangles> out;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (root(i) == i) out.push_back(std::move(objects_[i]));
    }
    return out;
  }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t x = root(a), y = root(b);
    parent_[std::max(x, y)] = std::min(x, y);
  }

  std::vector<Triangles> objects_;
  std::vector<std::size_t> parent_;
};

Hull hull_of(const MeshModel& mesh, const Triangles& triangles) {
  Triangles used = triangles;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Vec3> points;
  points.reserve(used.size());
  for (const unsigned vertex : used) points.push_back(mesh.vertices[vertex]);
  return convex_hull(points);
}

// True if no vertex of a hull is outside of one of the planes.
bool contains(const std::vector<FacePlane>& planes, const Hull& inner) {
  return std::all_of(planes.begin(), planes.end(), [&](const FacePlane& plane) {
    const double max = plane.offset + 1e-6 * (1 + std::abs(plane.offset));
    return std::all_of(inner.vertices.begin(), inner.vertices.end(),
                       [&](const Vec3& p) { return glm::dot(plane.normal, p) <= max; });
  });
}

// Removes hulls inside others, and keeps the order of the rest. Of two equal ones, the first remains.
void drop_contained(std::vector<Hull>& hulls) {
  std::vector<std::size_t> order(hulls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> volumes;
  for (const Hull& hull : hulls) volumes.push_back(volume_of(hull));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return volumes[a] > volumes[b]; });
  std::vector<std::size_t> kept;
  std::vector<std::vector<FacePlane>> planes;  // of the kept hulls
  for (const std::size_t i : order) {
    if (std::any_of(planes.begin(), planes.end(), [&](const auto& outer) { return contains(outer, hulls[i]); }))
      continue;
    kept.push_back(i);
    planes.push_back(planes_of(hulls[i]));
  }
  std::sort(kept.begin(), kept.end());
  std::vector<Hull> out;
  for (const std::size_t i : kept) out.push_back(std::move(hulls[i]));
  hulls = std::move(out);
}

Inertial solid_of(const MeshModel& mesh, const Triangles& triangles, const Hull& hull) {
  Inertial of_hull = unit_inertial_of(hull.vertices, hull.triangles);
  if (!is_watertight(triangles)) return of_hull;
  const Inertial own = unit_inertial_of(mesh.vertices, triangles);
  const double sign = own.mass < 0 ? -1 : 1;
  const bool plausible = sign * own.mass > 1e-6 * of_hull.mass && sign * own.mass <= 1.0001 * of_hull.mass &&
                         tensor_error(sign * own.tensor).empty();
  return plausible ? Inertial{sign * own.mass, own.center, sign * own.tensor} : of_hull;
}

void report_too_many(MeshModel& mesh, std::size_t count) {
  mesh.collision_problems.push_back(
      {0, Severity::warning, fmt::format("has {} objects, more than {}; it collides as one hull", count, kMaxPieces),
       "Join objects, or make a simpler file for collisions."});
}

}  // namespace

double volume_of(const Hull& hull) { return unit_inertial_of(hull.vertices, hull.triangles).mass; }

bool has_pieces(const ShapeModel& shape) {
  return shape.kind == ShapeKind::mesh && shape.surface == nullptr && shape.mesh != nullptr &&
         !shape.mesh->pieces.empty();
}

std::vector<PlacedShape> convex_shapes(const PlacedShape& placed) {
  if (!has_pieces(placed.shape)) return {placed};
  std::vector<PlacedShape> out = placed.shape.mesh->pieces;
  const Pose frame = placed.origin * placed.shape.mesh_pose;
  for (PlacedShape& piece : out) piece.origin = frame * piece.origin;
  return out;
}

PlacedShape piece_of(const Hull& complete, const HullLimits& limits) {
  if (std::optional<PlacedShape> primitive = recognize_primitive(complete)) return std::move(*primitive);
  const Hull contact = reduced_hull(complete, limits);
  auto mesh = std::make_shared<MeshModel>();
  mesh->vertices = complete.vertices;
  mesh->triangles = complete.triangles;
  mesh->hull = contact.vertices;
  mesh->hull_error = contact.error;
  mesh->closed = true;
  mesh->unit_inertial = unit_inertial_of(complete.vertices, complete.triangles);
  mesh->hull_volume = mesh->unit_inertial.mass;
  PlacedShape out;
  out.shape.kind = ShapeKind::mesh;
  out.shape.mesh = std::move(mesh);
  return out;
}

void set_pieces(MeshModel& mesh, std::span<const Hull> hulls, const HullLimits& limits) {
  mesh.primitive.reset();
  mesh.pieces.clear();
  mesh.hull_error = mesh.hull_volume = 0;
  for (const Hull& hull : hulls) {
    mesh.pieces.push_back(piece_of(hull, limits));
    const MeshModel* const reduced = mesh.pieces.back().shape.mesh.get();
    if (reduced != nullptr) mesh.hull_error = std::max(mesh.hull_error, reduced->hull_error);
    mesh.hull_volume += volume_of(hull);
  }
}

std::shared_ptr<const MeshModel> without_pieces(const MeshModel& mesh) {
  auto whole = std::make_shared<MeshModel>(mesh);
  const Hull complete = convex_hull(mesh.vertices);
  whole->pieces.clear();
  whole->collision_problems.clear();
  whole->primitive = recognize_primitive(complete);
  whole->hull_error = reduced_hull(complete).error;
  whole->hull_volume = volume_of(complete);
  return whole;
}

bool is_watertight(std::span<const unsigned> triangles) {
  // each edge by its ascending vertices, and whether it is used in this direction
  std::vector<std::pair<std::uint64_t, int>> edges;
  edges.reserve(triangles.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned from = triangles[i + k], to = triangles[i + (k + 1) % 3];
      const auto [low, high] = std::minmax(from, to);
      edges.emplace_back((static_cast<std::uint64_t>(low) << 32u) | high, from < to ? 1 : -1);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    int balance = 0;
    const std::uint64_t edge = edges[i].first;
    for (; i < edges.size() && edges[i].first == edge; ++i) balance += edges[i].second;
    if (balance != 0) return false;
  }
  return !edges.empty();
}

ObjectSolids split_objects(MeshModel& mesh, std::span<const std::uint32_t> objects) {
  if (objects.empty() || std::adjacent_find(objects.begin(), objects.end(), std::not_equal_to<>()) == objects.end())
    return {};
  const std::vector<Triangles> solids = PatchJoiner(triangles_by_object(mesh, objects)).run(mesh.vertices.size());
  if (solids.size() < 2) return {};
  if (solids.size() > kMaxObjects) {
    report_too_many(mesh, solids.size());
    return {};
  }
  std::vector<Hull> hulls;
  std::vector<Inertial> inertials;
  ObjectSolids out;
  out.watertight = true;
  for (const Triangles& solid : solids) {
    hulls.push_back(hull_of(mesh, solid));
    if (hulls.back().vertices.size() < 4) return {};
    inertials.push_back(solid_of(mesh, solid, hulls.back()));
    out.watertight = out.watertight && is_watertight(solid);
  }
  drop_contained(hulls);
  if (hulls.size() < 2) return {};
  if (hulls.size() > kMaxPieces) {
    report_too_many(mesh, hulls.size());
    return {};
  }
  set_pieces(mesh, hulls);
  out.inertial = combined(inertials);
  return out;
}

}  // namespace limber::model
