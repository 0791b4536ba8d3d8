// The growing convex surface: what a new point sees is cut away, and the rim of the hole is joined to the point.
#include "model/hull_surface.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace limber {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double HullSurface::above(const Face& face, int point) const {
  return glm::dot(face.normal, points_[at(point)]) - face.offset;
}

bool HullSurface::set_plane(Face& face) const {
  const Vec3& a = points_[at(face.vertex[0])];
  const Vec3& b = points_[at(face.vertex[1])];
  const Vec3& c = points_[at(face.vertex[2])];
  const Vec3 normal = glm::cross(b - a, c - a);
  const double area = glm::length(normal);
  const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  // a triangle thinner than the tolerance has no direction to speak of
  if (!(area > longest * epsilon_ * 1e-3) || area == 0) return false;
  face.normal = normal / area;
  face.offset = glm::dot(face.normal, (a + b + c) / 3.0);
  return true;
}

bool HullSurface::start(double thinnest) {
  const int count = static_cast<int>(points_.size());
  const auto farthest = [&](const auto& measure) {
    int best = 0;
    double most = -1;
    for (int i = 0; i < count; ++i) {
      const double d = measure(points_[at(i)]);
      if (d > most) most = d, best = i;
    }
    return std::pair(best, most);
  };
  const Vec3 any = points_[0];
  const int a = farthest([&](const Vec3& p) { return glm::length(p - any); }).first;
  const Vec3 pa = points_[at(a)];
  const auto [b, length] = farthest([&](const Vec3& p) { return glm::length(p - pa); });
  if (length <= thinnest) return false;
  const Vec3 along = (points_[at(b)] - pa) / length;
  const auto [c, width] = farthest([&](const Vec3& p) { return glm::length(glm::cross(p - pa, along)); });
  if (width <= thinnest) return false;
  const Vec3 up = normalized(glm::cross(along, points_[at(c)] - pa));
  const auto [d, height] = farthest([&](const Vec3& p) { return std::abs(glm::dot(p - pa, up)); });
  if (height <= thinnest) return false;

  corners_ = {a, b, c, d};
  if (glm::dot(points_[at(d)] - pa, up) > 0) std::swap(corners_[1], corners_[2]);
  const auto [w, x, y, z] = corners_;
  // seen from outside each is counter-clockwise; edge k of a face borders the face named in `across`
  faces_.resize(4);
  faces_[0].vertex = {w, x, y}, faces_[0].across = {1, 2, 3};
  faces_[1].vertex = {x, w, z}, faces_[1].across = {0, 3, 2};
  faces_[2].vertex = {y, x, z}, faces_[2].across = {0, 1, 3};
  faces_[3].vertex = {w, y, z}, faces_[3].across = {0, 2, 1};
  live_ = {0, 1, 2, 3};
  marked_.assign(4, 0);
  return std::all_of(faces_.begin(), faces_.end(), [&](Face& f) { return set_plane(f); });
}

bool HullSurface::find_horizon(int point, int seen) {
  dead_.assign(1, seen);
  horizon_.clear();
  marked_[at(seen)] = 1;
  for (std::size_t i = 0; i < dead_.size(); ++i) {
    const Face& face = faces_[at(dead_[i])];
    for (std::size_t k = 0; k < 3; ++k) {
      const int next = face.across[k];
      if (marked_[at(next)] == 1) continue;
      if (above(faces_[at(next)], point) > epsilon_ * 0.5) {
        marked_[at(next)] = 1;
        dead_.push_back(next);
        continue;
      }
      const int from = face.vertex[k];
      const int to = face.vertex[(k + 1) % 3];
      const auto& back = faces_[at(next)].vertex;
      const int side = back[0] == to ? 0 : (back[1] == to ? 1 : 2);
      horizon_.push_back({from, to, next, side});
    }
  }
  for (const int f : dead_) marked_[at(f)] = 0;
  return horizon_.size() >= 3;
}

bool HullSurface::close(int point) {
  std::unordered_map<int, int> starting;  // rim vertex -> the new face whose edge starts there
  const int first = static_cast<int>(faces_.size());
  std::vector<Face> made;
  made.reserve(horizon_.size());
  for (const Edge& e : horizon_) {
    Face face;
    face.vertex = {e.from, e.to, point};
    face.across = {e.face, -1, -1};
    if (!set_plane(face)) return false;
    if (!starting.emplace(e.from, first + static_cast<int>(made.size())).second) return false;
    made.push_back(std::move(face));
  }
  for (std::size_t i = 0; i < made.size(); ++i) {
    const auto next = starting.find(made[i].vertex[1]);
    if (next == starting.end()) return false;
    made[i].across[1] = next->second;
    made[at(next->second - first)].across[2] = first + static_cast<int>(i);
  }
  for (const Face& f : made) {
    if (f.across[1] < 0 || f.across[2] < 0) return false;
  }
  added_.clear();
  for (std::size_t i = 0; i < made.size(); ++i) {
    const int index = first + static_cast<int>(i);
    faces_[at(horizon_[i].face)].across[at(horizon_[i].side)] = index;
    faces_.push_back(std::move(made[i]));
    live_.push_back(index);
    marked_.push_back(0);
    added_.push_back(index);
  }
  return true;
}

bool HullSurface::add(int point, int seen) {
  added_.clear();
  if (!find_horizon(point, seen) || !close(point)) {
    dead_.clear();
    return false;
  }
  drop_dead();
  return true;
}

void HullSurface::drop_dead() {
  for (const int f : dead_) faces_[at(f)].alive = false;
  // the list of living faces is tidied when half of it is dead, not each time
  dead_in_list_ += dead_.size();
  if (2 * dead_in_list_ < live_.size()) return;
  dead_in_list_ = 0;
  std::erase_if(live_, [&](int f) { return !faces_[at(f)].alive; });
}

int HullSurface::face_below(int point) const {
  int best = -1;
  double most = epsilon_;
  for (const int f : live_) {
    if (!faces_[at(f)].alive) continue;
    const double d = above(faces_[at(f)], point);
    if (d > most) most = d, best = f;
  }
  return best;
}

double HullSurface::distance(int point) const {
  double nearest = -1;
  const Vec3& p = points_[at(point)];
  for (const int f : live_) {
    const Face& face = faces_[at(f)];
    if (!face.alive) continue;
    const double height = above(face, point);
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
  for (const int f : live_) {
    if (!faces_[at(f)].alive) continue;
    for (const int v : faces_[at(f)].vertex) {
      const auto [found, is_new] = number.emplace(v, static_cast<unsigned>(out.vertices.size()));
      if (is_new) out.vertices.push_back(points_[at(v)]);
      out.triangles.push_back(found->second);
    }
  }
  return out;
}

}  // namespace limber
