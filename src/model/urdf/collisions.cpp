// Checks the collision shapes of a body: finds links that overlap at the home pose, and reports links without collision
// geometry and meshes with a hollow that their convex hull fills.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/mesh/mass_properties.h"
#include "model/overlap.h"
#include "model/urdf/build.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxListedLinks = 8;
// Ratio of hull volume to mesh volume above which the hull is reported to fill a hollow.
constexpr double kHollowRatio = 1.2;

constexpr std::size_t kMaxHollowIndices = 60'000;  // larger meshes are not checked, to bound the time

// The volume that the triangles enclose, m³; also for a mesh of several touching solids. Each edge must be used equally
// often in both directions. 0 if the mesh is open or too large to check.
double enclosed_volume(const MeshModel& mesh) {
  if (mesh.closed) return mesh.unit_inertial.mass;
  const std::vector<unsigned>& corners = mesh.triangles;
  if (corners.size() > kMaxHollowIndices) return 0;
  std::map<std::pair<unsigned, unsigned>, int> balance;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned from = corners[i + k];
      const unsigned to = corners[i + (k + 1) % 3];
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  const bool open = std::any_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; });
  return open ? 0 : std::abs(unit_inertial_of(mesh.vertices, corners).mass);
}

int line_of_link(const UrdfBuildContext& build, int link) {
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    if (build.body_link[node] == link) return build.link(node).line;
  }
  return 1;
}

bool is_connector(const UrdfBuildContext& build, int link) {
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    if (build.body_link[node] == link) return build.link(node).connector;
  }
  return false;
}

void check_overlaps(UrdfBuildContext& build) {
  BodyModel& model = build.model;
  std::set<std::pair<int, int>> connected;
  for (const JointModel& joint : model.joints) connected.insert(std::minmax(joint.parent, joint.child));
  for (const JointModel& loop : model.loops) connected.insert(std::minmax(loop.parent, loop.child));
  connected.insert(model.exclusions.begin(), model.exclusions.end());
  std::vector<OverlapPart> parts;
  for (const LinkModel& link : model.links) parts.push_back({link.collisions, link.home});
  OverlapResult result = find_overlaps(parts, [&](std::size_t a, std::size_t b) {
    return !connected.contains({static_cast<int>(a), static_cast<int>(b)});
  });
  model.overlaps = std::move(result.found);
  if (!model.overlaps.empty()) {
    const Overlap& first = model.overlaps.front();
    const auto name = [&](int link) { return printable(model.links[static_cast<std::size_t>(link)].name); };
    const std::size_t more = model.overlaps.size() - 1;
    build.problems.warning(line_of_link(build, first.a),
                           fmt::format("'{}' and '{}' overlap at the home pose ({:.3g} mm); excluded from collision{}",
                                       name(first.a), name(first.b), first.depth * 1000,
                                       more > 0 ? fmt::format(" … and {} more of this kind", more) : ""),
                           "Shrink the collision shapes, or let the pair collide with body:include_pair(a, b).");
  }
  if (result.unchecked > 0) {
    build.problems.warning(
        1, counted(result.unchecked, "pair of links was", "pairs of links were") + " not checked for overlap",
        "Use fewer collision shapes.");
  }
}

void check_missing_collisions(UrdfBuildContext& build) {
  std::vector<std::string> names;
  std::size_t count = 0;
  bool visible = false;
  int line = 0;
  for (std::size_t i = 0; i < build.model.links.size(); ++i) {
    const LinkModel& link = build.model.links[i];
    // a link between the joints of one body, or a fixed root that is only a frame for others
    const bool frame = link.visuals.empty() && (link.inertial.mass <= 0 || is_connector(build, static_cast<int>(i)));
    if (!link.collisions.empty() || frame) continue;
    visible = visible || !link.visuals.empty();
    if (count++ == 0) line = line_of_link(build, static_cast<int>(i));
    if (names.size() < kMaxListedLinks) names.push_back(printable(link.name));
  }
  if (count == 0) return;
  std::string text = fmt::format("{} no collision geometry: {}{}", counted(count, "link has", "links have"),
                                 fmt::join(names, ", "), count > names.size() ? " …" : "");
  const char* const fix = "Add <collision> elements, unless nothing should touch these links.";
  if (visible) {
    build.problems.warning(line, std::move(text), fix);
  } else {
    build.problems.note(line, std::move(text), fix);
  }
}

void check_hollow_meshes(UrdfBuildContext& build) {
  std::size_t count = 0;
  std::string text, fix;
  int line = 0;
  for (std::size_t i = 0; i < build.model.links.size(); ++i) {
    for (const PlacedShape& placed : build.model.links[i].collisions) {
      const MeshModel* const mesh = placed.shape.mesh.get();
      if (mesh == nullptr || placed.shape.surface != nullptr) continue;
      const double volume = enclosed_volume(*mesh);
      if (volume <= 0 || mesh->hull_volume <= kHollowRatio * volume || count++ > 0) continue;
      line = line_of_link(build, static_cast<int>(i));
      const std::string hulls =
          mesh->pieces.empty() ? "convex hull" : fmt::format("{} convex pieces", mesh->pieces.size());
      text = fmt::format("link '{}': the {} of collision mesh '{}' {} its hollows: {:.3g} times its volume",
                         printable(build.model.links[i].name), hulls, printable(mesh->name),
                         mesh->pieces.empty() ? "fills" : "fill", mesh->hull_volume / volume);
      fix = mesh->pieces.empty()
                ? "Write concave=\"yes\" in its <mesh>, or split it into convex objects, if things must fit inside."
                : "Split it into convex objects, if things must fit inside.";
    }
  }
  if (count == 0) return;
  if (count > 1) text += fmt::format(" … and {} more of this kind", count - 1);
  build.problems.warning(line, std::move(text), fix);
}

}  // namespace

void build_collisions(UrdfBuildContext& build) {
  check_overlaps(build);
  check_missing_collisions(build);
  check_hollow_meshes(build);
}

}  // namespace limber::model
