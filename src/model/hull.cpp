// The whole hull by quickhull with outside sets; the reduced one by adding the farthest vertex again and again.
#include "model/hull.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "model/hull_surface.h"

namespace limber {

namespace {

struct Extent {
  double size = 0;      // largest edge of the bounding box
  double farthest = 0;  // largest coordinate
};

Extent extent_of(std::span<const Vec3> points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const Vec3 d = high - low;
  const Vec3 m = glm::max(glm::abs(low), glm::abs(high));
  return {std::max({d.x, d.y, d.z}), std::max({m.x, m.y, m.z})};
}

// meshes come in single precision: what is within its noise of a plane lies in the plane
double epsilon_of(const Extent& e) { return 1e-6 * e.size + 2e-7 * e.farthest + 1e-12; }

// thinner than a ten-thousandth of its size, a cloud's rim is all slivers, whose planes mean nothing: it counts as flat
double thinnest_of(const Extent& e) { return 100 * epsilon_of(e); }

/// The cloud and a copy of it shifted to each side, along the directions in which it has no thickness.
std::vector<Vec3> thickened(std::span<const Vec3> points, const Extent& extent) {
  const double least = 2 * thinnest_of(extent);
  const double t = std::max({1e-3 * extent.size, 1e-4, 0.75 * thinnest_of(extent)});
  const Vec3 base = points[0];
  const auto farthest = [&](const auto& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return measure(a) < measure(b); });
  };
  std::vector<Vec3> missing{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3 far = farthest([&](const Vec3& p) { return glm::length(p - base); });
  if (glm::length(far - base) > least) {
    const Vec3 along = normalized(far - base);
    const Vec3 helper = std::abs(along.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 side = farthest([&](const Vec3& p) { return glm::length(glm::cross(p - base, along)); });
    const Vec3 out = glm::cross(along, side - base);
    const Vec3 up = normalized(glm::cross(along, helper));
    if (glm::length(out) > least) {
      missing = {normalized(out)};
    } else {
      missing = {up, glm::cross(along, up)};
    }
  }
  std::vector<Vec3> thick(points.begin(), points.end());
  for (const Vec3& direction : missing) {
    const std::size_t count = thick.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = thick[i];
      thick[i] = p + t * direction;
      thick.push_back(p - t * direction);
    }
  }
  return thick;
}

/// Hands points to the faces that they see, the farthest of each face last.
class Quickhull {
 public:
  explicit Quickhull(HullSurface& surface) : surface_(surface) {}

  void run(int points) {
    std::vector<int> all(static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) all[static_cast<std::size_t>(i)] = i;
    hand_out(all, {0, 1, 2, 3});
    while (!pending_.empty()) {
      const int f = pending_.back();
      HullSurface::Face& face = surface_.faces()[static_cast<std::size_t>(f)];
      if (!face.alive || face.outside.empty()) {
        pending_.pop_back();
        continue;
      }
      const int point = face.outside.back();
      face.outside.pop_back();
      if (surface_.add(point, f)) {
        std::vector<int> free;
        for (const int dead : surface_.dead_faces()) {
          std::vector<int>& list = surface_.faces()[static_cast<std::size_t>(dead)].outside;
          free.insert(free.end(), list.begin(), list.end());
          std::vector<int>().swap(list);
        }
        hand_out(free, surface_.added_faces());
      } else {
        bring_farthest_last(face);
      }
    }
  }

 private:
  void hand_out(const std::vector<int>& points, const std::vector<int>& to) {
    for (const int p : points) {
      int best = -1;
      double most = surface_.epsilon();
      for (const int f : to) {
        const double d = surface_.above(surface_.faces()[static_cast<std::size_t>(f)], p);
        if (d > most) most = d, best = f;
      }
      if (best >= 0) surface_.faces()[static_cast<std::size_t>(best)].outside.push_back(p);
    }
    for (const int f : to) {
      HullSurface::Face& face = surface_.faces()[static_cast<std::size_t>(f)];
      if (face.outside.empty()) continue;
      bring_farthest_last(face);
      pending_.push_back(f);
    }
  }
  void bring_farthest_last(HullSurface::Face& face) {
    if (face.outside.empty()) return;
    const auto farthest = std::max_element(face.outside.begin(), face.outside.end(), [&](int a, int b) {
      return surface_.above(face, a) < surface_.above(face, b);
    });
    std::iter_swap(farthest, face.outside.end() - 1);
  }

  HullSurface& surface_;
  std::vector<int> pending_;
};

}  // namespace

double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Ericson, Real-Time Collision Detection, 5.1.5: which corner, edge or inside is nearest
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return glm::length(ap);
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return glm::length(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return glm::length(ap - d1 / (d1 - d3) * ab);
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return glm::length(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return glm::length(ap - d2 / (d2 - d6) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return glm::length(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  const double sum = va + vb + vc;
  return sum > 0 ? glm::length(ap - vb / sum * ab - vc / sum * ac) : glm::length(ap);
}

Hull convex_hull(std::span<const Vec3> points) {
  if (points.empty()) return {};
  const Extent extent = extent_of(points);
  HullSurface surface(points, epsilon_of(extent));
  if (surface.start(thinnest_of(extent))) {
    Quickhull(surface).run(static_cast<int>(points.size()));
    return surface.result();
  }
  const std::vector<Vec3> thick = thickened(points, extent);
  HullSurface solid(thick, epsilon_of(extent_of(thick)));
  if (!solid.start(thinnest_of(extent_of(thick)))) return {};
  Quickhull(solid).run(static_cast<int>(thick.size()));
  return solid.result();
}

Hull reduced_hull(const Hull& whole, const HullLimits& limits) {
  const int count = static_cast<int>(whole.vertices.size());
  if (count <= std::min(limits.min_vertices, limits.max_vertices)) return whole;
  const Extent extent = extent_of(whole.vertices);
  HullSurface surface(whole.vertices, epsilon_of(extent) * 0.1);
  if (!surface.start(10 * surface.epsilon())) return whole;
  // distances only shrink while the surface grows: an old one is an upper bound, so only the top is measured anew
  std::priority_queue<std::pair<double, int>> farthest;
  for (int i = 0; i < count; ++i) farthest.emplace(surface.distance(i), -i);
  int vertices = 4;
  double skipped = 0;
  while (!farthest.empty()) {
    const auto [old, index] = farthest.top();
    farthest.pop();
    const double now = surface.distance(-index);
    if (!farthest.empty() && now < farthest.top().first) {
      farthest.emplace(now, index);
      continue;
    }
    const bool fine = now <= limits.tolerance * extent.size && vertices >= limits.min_vertices;
    if (now <= surface.epsilon() || vertices >= limits.max_vertices || fine) {
      skipped = std::max(skipped, now);
      break;
    }
    const int seen = surface.face_below(-index);
    if (seen >= 0 && surface.add(-index, seen)) {
      ++vertices;
    } else {
      skipped = std::max(skipped, now);
    }
  }
  Hull out = surface.result();
  out.error = skipped;
  return out;
}

Hull reduced_hull(std::span<const Vec3> points, const HullLimits& limits) {
  return reduced_hull(convex_hull(points), limits);
}

}  // namespace limber
