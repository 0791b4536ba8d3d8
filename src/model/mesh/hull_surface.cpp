// Incremental convex surface: removes the faces visible from a new point and connects the horizon with the point.
#include "model/mesh/hull_surface.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace limber::model {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double HullSurface::signed_distance(const Face& face, int point) const {
  return glm::dot(face.normal, points_[at(point)]) - face.offset;
}

bool HullSurface::set_plane(Face& face) const {
  const Vec3& a = points_[at(face.vertex[0])];
  const Vec3& b = points_[at(face.vertex[1])];
  const Vec3& c = points_[at(face.vertex[2])];
  const Vec3 normal = glm::cross(b - a, c - a);
  const double area = glm::length(normal);
  const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  // the normal of a triangle much thinner than the tolerance is unreliable
  if (!(area > longest * epsilon_ * 1e-3) || area == 0) return false;
  face.normal = normal / area;
  face.offset = glm::dot(face.normal, (a + b + c) / 3.0);
  return true;
}

bool HullSurface::build_tetrahedron(double min_thickness) {
  const int count = static_cast<int>(points_.size());
  const auto farthest = [&](const auto& measure) {
    int best = 0;
    double max_measure = -1;
    for (int i = 0; i < count; ++i) {
      const double d = measure(points_[at(i)]);
      if (d > max_measure) max_measure = d, best = i;
    }
    return std::pair(best, max_measure);
  };
  const Vec3 any = points_[0];
  const int a = farthest([&](const Vec3& p) { return glm::length(p - any); }).first;
  const Vec3 pa = points_[at(a)];
  const auto [b, length] = farthest([&](const Vec3& p) { return glm::length(p - pa); });
  if (length <= min_thickness) return false;
  const Vec3 along = (points_[at(b)] - pa) / length;
  const auto [c, width] = farthest([&](const Vec3& p) { return glm::length(glm::cross(p - pa, along)); });
  if (width <= min_thickness) return false;
  const Vec3 up = normalized(glm::cross(along, points_[at(c)] - pa));
  const auto [d, height] = farthest([&](const Vec3& p) { return std::abs(glm::dot(p - pa, up)); });
  if (height <= min_thickness) return false;

  corners_ = {a, b, c, d};
  if (glm::dot(points_[at(d)] - pa, up) > 0) std::swap(corners_[1], corners_[2]);
  const auto [w, x, y, z] = corners_;
  // all are counter-clockwise seen from outside
  faces_.resize(4);
  faces_[0].vertex = {w, x, y}, faces_[0].neighbors = {1, 2, 3};
  faces_[1].vertex = {x, w, z}, faces_[1].neighbors = {0, 3, 2};
  faces_[2].vertex = {y, x, z}, faces_[2].neighbors = {0, 1, 3};
  faces_[3].vertex = {w, y, z}, faces_[3].neighbors = {0, 2, 1};
  live_faces_ = {0, 1, 2, 3};
  visited_.assign(4, 0);
  return std::all_of(faces_.begin(), faces_.end(), [&](Face& f) { return set_plane(f); });
}

bool HullSurface::find_horizon(int point, int visible_face) {
  dead_faces_.assign(1, visible_face);
  horizon_.clear();
  visited_[at(visible_face)] = 1;
  for (std::size_t i = 0; i < dead_faces_.size(); ++i) {
    const Face& face = faces_[at(dead_faces_[i])];
    for (std::size_t k = 0; k < 3; ++k) {
      const int next = face.neighbors[k];
      if (visited_[at(next)] == 1) continue;
      if (signed_distance(faces_[at(next)], point) > epsilon_ * 0.5) {
        visited_[at(next)] = 1;
        dead_faces_.push_back(next);
        continue;
      }
      const int from = face.vertex[k];
      const int to = face.vertex[(k + 1) % 3];
      const auto& back = faces_[at(next)].vertex;
      const int side = back[0] == to ? 0 : (back[1] == to ? 1 : 2);
      horizon_.push_back({from, to, next, side});
    }
  }
  for (const int f : dead_faces_) visited_[at(f)] = 0;
  return horizon_.size() >= 3;
}

bool HullSurface::connect_horizon(int point) {
  std::unordered_map<int, int> face_by_start;  // horizon vertex -> the new face with an edge that starts there
  const int first = static_cast<int>(faces_.size());
  std::vector<Face> new_faces;
  new_faces.reserve(horizon_.size());
  for (const Edge& e : horizon_) {
    Face face;
    face.vertex = {e.from, e.to, point};
    face.neighbors = {e.neighbor, -1, -1};
    if (!set_plane(face)) return false;
    if (!face_by_start.emplace(e.from, first + static_cast<int>(new_faces.size())).second) return false;
    new_faces.push_back(std::move(face));
  }
  for (std::size_t i = 0; i < new_faces.size(); ++i) {
    const auto next = face_by_start.find(new_faces[i].vertex[1]);
    if (next == face_by_start.end()) return false;
    new_faces[i].neighbors[1] = next->second;
    new_faces[at(next->second - first)].neighbors[2] = first + static_cast<int>(i);
  }
  for (const Face& f : new_faces) {
    if (f.neighbors[1] < 0 || f.neighbors[2] < 0) return false;
  }
  added_faces_.clear();
  for (std::size_t i = 0; i < new_faces.size(); ++i) {
    const int index = first + static_cast<int>(i);
    faces_[at(horizon_[i].neighbor)].neighbors[at(horizon_[i].neighbor_edge)] = index;
    faces_.push_back(std::move(new_faces[i]));
    live_faces_.push_back(index);
    visited_.push_back(0);
    added_faces_.push_back(index);
  }
  return true;
}

bool HullSurface::add(int point, int visible_face) {
  added_faces_.clear();
  if (!find_horizon(point, visible_face) || !connect_horizon(point)) {
    dead_faces_.clear();
    return false;
  }
  remove_dead_faces();
  return true;
}

void HullSurface::remove_dead_faces() {
  for (const int f : dead_faces_) faces_[at(f)].alive = false;
  // the list is cleaned up only when half of its faces are dead, for amortized constant time
  dead_in_live_ += dead_faces_.size();
  if (2 * dead_in_live_ < live_faces_.size()) return;
  dead_in_live_ = 0;
  std::erase_if(live_faces_, [&](int f) { return !faces_[at(f)].alive; });
}

int HullSurface::highest_visible_face(int point) const {
  int best = -1;
  double max_distance = epsilon_;
  for (const int f : live_faces_) {
    if (!faces_[at(f)].alive) continue;
    const double d = signed_distance(faces_[at(f)], point);
    if (d > max_distance) max_distance = d, best = f;
  }
  return best;
}

double HullSurface::distance(int point) const {
  double nearest = -1;
  const Vec3& p = points_[at(point)];
  for (const int f : live_faces_) {
    const Face& face = faces_[at(f)];
    if (!face.alive) continue;
    const double height = signed_distance(face, point);
    if (height <= 0 || (nearest >= 0 && height >= nearest)) continue;
    const double d =
        triangle_distance(p, points_[at(face.vertex[0])], points_[at(face.vertex[1])], points_[at(face.vertex[2])]);
    if (nearest < 0 || d < nearest) nearest = d;
  }
  return std::max(nearest, 0.0);
}

Hull HullSurface::result() const {
  Hull out;
  std::unordered_map<int, unsigned> number;
  for (const int f : live_faces_) {
    if (!faces_[at(f)].alive) continue;
    for (const int v : faces_[at(f)].vertex) {
      const auto [found, is_new] = number.emplace(v, static_cast<unsigned>(out.vertices.size()));
      if (is_new) out.vertices.push_back(points_[at(v)]);
      out.triangles.push_back(found->second);
    }
  }
  return out;
}

}  // namespace limber::model
