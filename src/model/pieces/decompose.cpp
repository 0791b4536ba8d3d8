// The bounding box of the mesh is cut into cells. The hull of a cell contains the surface in it, and the cell's corners
// that are inside of the mesh. The depth of the hollows that a hull fills is measured at samples of the surface, along
// their normals.
#include "model/pieces/decompose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "model/mesh/mass_properties.h"
#include "model/pieces/decompose_surface.h"
#include "model/pieces/pieces.h"

namespace limber::model {

namespace {

constexpr std::size_t kSamples = 1200;
constexpr int kEvenPlanes = 7;                   // candidates per axis, besides those at hollows
constexpr int kMaxOutline = 100;                 // vertices of a cell's hull that are used to compare candidates
constexpr std::size_t kComparedPolygons = 1000;  // of a cell, to compare candidates
constexpr std::size_t kMaxGrowth = 8;            // of the number of polygons by cuts
constexpr std::size_t kMinPolygons = 20'000;
constexpr double kImbalance = 0.1;         // cost of a plane at the end of a cell, where 1 is the hollow before the cut
constexpr double kMinHollow = 1e-3;        // smaller hollows are not cut; relative to the volume of the whole hull
constexpr double kMaxJoinedGrowth = 1.02;  // volume of joined hulls, relative to the sum

using CornerFlags = std::array<bool, 8>;  // bits 0, 1, 2 of the index: high x, y, z

// Returns the depth to which a hull fills the hollow in front of a sample.
double filled(const SurfaceSample& sample, const std::vector<FacePlane>& planes) {
  double length = sample.free;
  for (const FacePlane& plane : planes) {
    const double along = glm::dot(plane.normal, sample.normal);
    if (along <= 1e-9) continue;
    length = std::min(length, (plane.offset - glm::dot(plane.normal, sample.point)) / along);
  }
  return std::max(0.0, length);
}

// Filled depths at samples.
struct Fill {
  double sum = 0;
  double depth = 0;  // the largest

  void add(double length) {
    sum += length;
    depth = std::max(depth, length);
  }
};

/// A box of space, with the part of the mesh in it.
struct Cell {
  Vec3 low{0}, high{0};
  CornerFlags inside{};  // corners in the mesh
  std::vector<Polygon> polygons;
  std::vector<Polygon> caps;  // close the surface where it was cut; they may overlap, with opposite signs
  std::vector<std::size_t> samples;
  std::vector<double> lengths;  // filled depth at each sample
  Hull hull;
  double hull_volume = 0;
  double hollow = 0;  // volume of the hull outside of the mesh
  Fill fill;
  bool indivisible = false;  // no plane has surface on both sides

  Vec3 corner(std::size_t index) const {
    return {(index & 1u) != 0 ? high.x : low.x, (index & 2u) != 0 ? high.y : low.y, (index & 4u) != 0 ? high.z : low.z};
  }
  std::vector<Vec3> corners_inside() const {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < 8; ++i) {
      if (inside[i]) out.push_back(corner(i));
    }
    return out;
  }
};

bool touch(const Cell& a, const Cell& b, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    if (a.low[i] > b.high[i] + tolerance || b.low[i] > a.high[i] + tolerance) return false;
  }
  return true;
}

double area_of_hull(const Hull& hull) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < hull.triangles.size(); i += 3) {
    const Vec3& a = hull.vertices[hull.triangles[i]];
    sum += glm::length(glm::cross(hull.vertices[hull.triangles[i + 1]] - a, hull.vertices[hull.triangles[i + 2]] - a));
  }
  return sum / 2;
}

class Decomposer {
 public:
  Decomposer(std::span<const Vec3> vertices, std::span<const unsigned> triangles, const DecompositionLimits& limits)
      : limits_(limits),
        triangles_(ordered_triangles(vertices, triangles)),
        frame_(align_to_axes(triangles_)),
        samples_(sample_surface(triangles_, kSamples)),
        inside_(triangles_, largest_extent()) {}

  Decomposition run() {
    Decomposition out;
    if (samples_.empty()) return out;
    cells_.push_back(whole());
    while (cells_.size() < limits_.max_pieces && polygons() < kMaxGrowth * triangles_.size() + kMinPolygons &&
           split_worst()) {
    }
    join_cells();
    for (Cell& cell : cells_) {
      out.filled_depth = std::max(out.filled_depth, cell.fill.depth);
      for (Vec3& v : cell.hull.vertices) v = frame_ * v;
      out.hulls.push_back(std::move(cell.hull));
    }
    return out;
  }

 private:
  double largest_extent() {
    if (triangles_.empty()) return 0;
    low_ = high_ = triangles_[0][0];
    for (const Triangle& t : triangles_) {
      for (const Vec3& corner : t) low_ = glm::min(low_, corner), high_ = glm::max(high_, corner);
    }
    const Vec3 extent = high_ - low_;
    return size_ = std::max({extent.x, extent.y, extent.z});
  }
  double depth_tolerance() const { return limits_.tolerance * size_; }
  double epsilon() const { return 1e-7 * size_; }

  // The number of polygons of all cells. It is limited, because each cut through a polygon makes two of it.
  std::size_t polygons() const {
    std::size_t sum = 0;
    for (const Cell& cell : cells_) sum += cell.polygons.size() + cell.caps.size();
    return sum;
  }

  Cell whole() {
    Cell cell;
    cell.low = low_;
    cell.high = high_;
    for (const Triangle& t : triangles_)
      cell.polygons.push_back({{t.begin(), t.end()}, glm::cross(t[1] - t[0], t[2] - t[0])});
    for (std::size_t i = 0; i < samples_.size(); ++i) cell.samples.push_back(i);
    measure(cell);
    volume_ = cell.hull_volume;
    return cell;
  }

  // Computes the hull of a cell, its hollow and its filled depths.
  void measure(Cell& cell) {
    std::vector<Vec3> points = cell.corners_inside();
    for (const Polygon& polygon : cell.polygons)
      points.insert(points.end(), polygon.corners.begin(), polygon.corners.end());
    cell.hull = checked_convex_hull(points);
    cell.hull_volume = volume_of(cell.hull);
    const double solid = enclosed_volume(cell.polygons, cell.low) + enclosed_volume(cell.caps, cell.low);
    cell.hollow = std::max(0.0, cell.hull_volume - solid);
    measure_fill(cell);
  }
  void measure_fill(Cell& cell) const {
    const std::vector<FacePlane> planes = planes_of(cell.hull);
    cell.fill = {};
    cell.lengths.clear();
    for (const std::size_t i : cell.samples) {
      cell.lengths.push_back(filled(samples_[i], planes));
      cell.fill.add(cell.lengths.back());
    }
  }

  bool is_hollow(const Cell& cell) const {
    return cell.fill.depth > depth_tolerance() ||
           cell.hollow > std::max(limits_.hollow * cell.hull_volume, kMinHollow * volume_);
  }

  // Splits the cell with the largest hollow; false if no cell needs a cut.
  bool split_worst() {
    Cell* worst = nullptr;
    for (Cell& cell : cells_) {
      if (cell.indivisible || !is_hollow(cell)) continue;
      if (worst == nullptr || cell.hollow > worst->hollow) worst = &cell;
    }
    if (worst == nullptr) return false;
    const std::optional<AxisPlane> plane = best_plane(*worst);
    if (!plane) {
      worst->indivisible = true;
      return true;
    }
    auto [below, above] = split(*worst, *plane);
    *worst = std::move(below);
    cells_.push_back(std::move(above));
    std::erase_if(cells_, [&](const Cell& cell) { return cell.hull_volume <= 1e-9 * volume_; });
    return true;
  }

  bool is_below(const SurfaceSample& sample, const AxisPlane& plane) const {
    const double height = sample.point[plane.axis] - plane.position;
    return std::abs(height) > epsilon() ? height < 0 : sample.normal[plane.axis] >= 0;
  }
  // Returns which corners of the cut through a cell are inside of the mesh, by their index with the axis's bit cleared.
  CornerFlags corners_of_cut(const Cell& cell, const AxisPlane& plane) {
    CornerFlags out{};
    for (std::size_t i = 0; i < 8; ++i) {
      if ((i & (1u << static_cast<unsigned>(plane.axis))) != 0) continue;
      Vec3 corner = cell.corner(i);
      corner[plane.axis] = plane.position;
      out[i] = inside_.contains(corner, plane.axis);
    }
    return out;
  }

  // Returns the cells below and above a cut, with their corners and samples only.
  std::array<Cell, 2> halves(const Cell& cell, const AxisPlane& plane) {
    std::array<Cell, 2> out;
    for (Cell& half : out) half.low = cell.low, half.high = cell.high, half.inside = cell.inside;
    out[0].high[plane.axis] = out[1].low[plane.axis] = plane.position;
    const CornerFlags cut = corners_of_cut(cell, plane);
    const auto bit = std::size_t{1} << static_cast<unsigned>(plane.axis);
    for (std::size_t i = 0; i < 8; ++i) out[(i & bit) != 0 ? 0 : 1].inside[i] = cut[i & ~bit];
    for (const std::size_t i : cell.samples) out[is_below(samples_[i], plane) ? 0 : 1].samples.push_back(i);
    return out;
  }

  std::array<Cell, 2> split(const Cell& cell, const AxisPlane& plane) {
    std::array<Cell, 2> out = halves(cell, plane);
    for (const Polygon& polygon : cell.polygons)
      split_polygon(polygon, plane, epsilon(), out[0].polygons, out[1].polygons);
    for (const Polygon& cap : cell.caps) split_polygon(cap, plane, epsilon(), out[0].caps, out[1].caps);
    Vec3 apex = 0.5 * (cell.low + cell.high);
    apex[plane.axis] = plane.position;
    for (Cell& half : out) {
      std::vector<Polygon> caps = caps_of_cut(half.polygons, plane, epsilon(), apex);
      for (Polygon& cap : caps_of_cut(half.caps, plane, epsilon(), apex)) caps.push_back(std::move(cap));
      half.caps.insert(half.caps.end(), std::make_move_iterator(caps.begin()), std::make_move_iterator(caps.end()));
      measure(half);
    }
    return out;
  }

  // Returns planes at even distances, and at the walls of the deepest filled hollows.
  std::vector<AxisPlane> candidates(const Cell& cell) const {
    std::vector<AxisPlane> out;
    for (int axis = 0; axis < 3; ++axis) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vec3& v : cell.hull.vertices) low = std::min(low, v[axis]), high = std::max(high, v[axis]);
      for (int i = 1; i <= kEvenPlanes; ++i) out.push_back({axis, low + i * (high - low) / (kEvenPlanes + 1)});
      for (const double sign : {-1.0, 1.0}) {
        double longest = 0, position = 0;
        for (std::size_t i = 0; i < cell.samples.size(); ++i) {
          const SurfaceSample& sample = samples_[cell.samples[i]];
          if (sign * sample.normal[axis] < 0.7 || cell.lengths[i] <= longest) continue;
          longest = cell.lengths[i];
          position = sample.point[axis];
        }
        if (longest > 0 && position > low + epsilon() && position < high - epsilon()) out.push_back({axis, position});
      }
    }
    return out;
  }

  // Returns points of the surface on both sides of a cut; of many polygons, only every n-th is used.
  std::array<std::vector<Vec3>, 2> side_points(const Cell& cell, std::span<const Vec3> outline,
                                               const AxisPlane& plane) const {
    std::array<std::vector<Polygon>, 2> parts;
    const std::size_t step = 1 + cell.polygons.size() / kComparedPolygons;
    for (std::size_t i = 0; i < cell.polygons.size(); i += step)
      split_polygon(cell.polygons[i], plane, epsilon(), parts[0], parts[1]);
    std::array<std::vector<Vec3>, 2> out;
    for (std::size_t side = 0; side < 2; ++side) {
      for (const Polygon& part : parts[side])
        out[side].insert(out[side].end(), part.corners.begin(), part.corners.end());
    }
    for (const Vec3& v : outline) {
      const double height = v[plane.axis] - plane.position;
      if (std::abs(height) > epsilon()) out[height < 0 ? 0 : 1].push_back(v);
    }
    return out;
  }

  // Estimates the cost of a cut: volume and depth of the hollows that the hulls of both sides fill, relative to the
  // cell, and their area. Empty if one side has no surface.
  std::optional<double> cost_of_cut(const Cell& cell, std::span<const Vec3> outline, const AxisPlane& plane) {
    std::array<std::vector<Vec3>, 2> points = side_points(cell, outline, plane);
    const std::array<Cell, 2> sides = halves(cell, plane);
    double sum = 0, volume = 0, area = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      if (points[side].size() < 3) return {};
      for (const Vec3& corner : sides[side].corners_inside()) points[side].push_back(corner);
      const Hull hull = convex_hull(points[side]);
      const std::vector<FacePlane> planes = planes_of(hull);
      for (const std::size_t i : sides[side].samples) sum += filled(samples_[i], planes);
      volume += volume_of(hull);
      area += area_of_hull(hull);
    }
    const double hollow = cell.hollow > 0 ? (volume - cell.hull_volume) / cell.hollow + 1 : 0;
    const double filled = cell.fill.sum > 0 ? sum / cell.fill.sum : 0;
    // if no cut reduces the hollow, the area prefers compact sides to slices: a ring is cut across, not along
    return hollow + filled + area / area_of_hull(cell.hull);
  }

  std::optional<AxisPlane> best_plane(const Cell& cell) {
    std::optional<AxisPlane> best;
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Vec3> outline = reduced_hull(cell.hull, {16, kMaxOutline, 0}).vertices;
    for (const AxisPlane& plane : candidates(cell)) {
      const std::optional<double> estimate = cost_of_cut(cell, outline, plane);
      if (!estimate) continue;
      const double low = cell.low[plane.axis], high = cell.high[plane.axis];
      const double imbalance = std::abs(low + high - 2 * plane.position) / (high - low);
      const double cost = *estimate + kImbalance * imbalance;
      if (cost >= least) continue;
      least = cost;
      best = plane;
    }
    return best;
  }

  // Joins cells whose common hull is hardly larger than their hulls, and fills no deeper hollow.
  void join_cells() {
    for (bool joined = true; joined;) {
      joined = false;
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        for (std::size_t j = i + 1; j < cells_.size(); ++j) {
          std::optional<Cell> both = join(cells_[i], cells_[j]);
          if (!both) continue;
          cells_[i] = std::move(*both);
          cells_.erase(cells_.begin() + static_cast<std::ptrdiff_t>(j));
          joined = true;
          --j;
        }
      }
    }
  }
  std::optional<Cell> join(const Cell& a, const Cell& b) const {
    if (!touch(a, b, epsilon())) return {};
    Cell both;
    both.low = glm::min(a.low, b.low);
    both.high = glm::max(a.high, b.high);
    std::vector<Vec3> points = a.hull.vertices;
    points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
    both.hull = checked_convex_hull(points);
    both.hull_volume = volume_of(both.hull);
    if (both.hull_volume > kMaxJoinedGrowth * (a.hull_volume + b.hull_volume)) return {};
    both.hollow = std::max(0.0, both.hull_volume - a.hull_volume - b.hull_volume + a.hollow + b.hollow);
    both.samples = a.samples;
    both.samples.insert(both.samples.end(), b.samples.begin(), b.samples.end());
    measure_fill(both);
    if (both.fill.depth > std::max({depth_tolerance(), a.fill.depth, b.fill.depth})) return {};
    return both;
  }

  const DecompositionLimits limits_;
  std::vector<Triangle> triangles_;
  Quat frame_;  // from the axes of the cuts to those of the mesh
  std::vector<SurfaceSample> samples_;
  Vec3 low_{0}, high_{0};
  double size_ = 0;    // largest extent
  double volume_ = 0;  // of the whole hull
  InsideTest inside_;
  std::vector<Cell> cells_;
};

std::shared_ptr<MeshModel> with_problem(const MeshModel& mesh, std::string text, std::string fix) {
  auto out = std::make_shared<MeshModel>(mesh);
  out->collision_problems.push_back({0, Severity::warning, std::move(text), std::move(fix)});
  return out;
}

}  // namespace

Decomposition decompose(std::span<const Vec3> vertices, std::span<const unsigned> triangles,
                        const DecompositionLimits& limits) {
  if (unit_inertial_of(vertices, triangles).mass >= 0) return Decomposer(vertices, triangles, limits).run();
  std::vector<unsigned> outwards(triangles.rbegin(), triangles.rend());
  return Decomposer(vertices, outwards, limits).run();
}

std::shared_ptr<const MeshModel> decomposed(const std::shared_ptr<const MeshModel>& mesh) {
  // objects that are convex, as programs for convex decomposition write them
  if (!mesh->pieces.empty() && mesh->closed && mesh->hull_volume <= kMaxJoinedGrowth * mesh->unit_inertial.mass)
    return mesh;
  const char* const result = mesh->pieces.empty() ? "its hull" : "the hulls of its objects";
  if (!is_watertight(mesh->triangles)) {
    return with_problem(*mesh, fmt::format("is open, so that its hollows are unknown; it collides as {}", result),
                        "Close its holes, or split it into convex objects.");
  }
  const std::size_t count = mesh->triangles.size() / 3;
  if (count > kMaxDecomposedTriangles) {
    return with_problem(*mesh,
                        fmt::format("has {} triangles, too many to decompose (at most {}); it collides as {}", count,
                                    kMaxDecomposedTriangles, result),
                        "Use a simpler mesh for collisions.");
  }
  const Decomposition found = decompose(mesh->vertices, mesh->triangles);
  auto out = std::make_shared<MeshModel>(*mesh);
  if (found.hulls.size() > 1) set_pieces(*out, found.hulls);
  return out;
}

}  // namespace limber::model
