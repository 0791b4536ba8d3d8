// Collision shapes of the whole body: links that overlap at the home pose, links without collision geometry, meshes
// whose convex hull fills a hollow.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/overlap.h"
#include "model/urdf_build.h"

namespace limber {

namespace {

constexpr std::size_t kShownLinks = 8;
// A hull this many times as large as its mesh fills a hollow.
constexpr double kHollowRatio = 1.2;

int line_of_link(const UrdfBuild& build, int link) {
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    if (build.body_link[node] == link) return build.link(node).line;
  }
  return 1;
}

void check_overlaps(UrdfBuild& build) {
  BodyModel& model = build.model;
  std::set<std::pair<int, int>> joined;
  for (const JointModel& joint : model.joints) joined.insert(std::minmax(joint.parent, joint.child));
  std::vector<OverlapPart> parts;
  for (const LinkModel& link : model.links) parts.push_back({link.collisions, link.home});
  OverlapResult result = find_overlaps(parts, [&](std::size_t a, std::size_t b) {
    return !joined.contains({static_cast<int>(a), static_cast<int>(b)});
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
    build.problems.warning(1, fmt::format("{} pairs of links were not checked for overlap", result.unchecked),
                           "Use fewer collision shapes.");
  }
}

void check_missing_collisions(UrdfBuild& build) {
  std::vector<std::string> names;
  std::size_t count = 0;
  bool visible = false;
  int line = 0;
  for (std::size_t i = 0; i < build.model.links.size(); ++i) {
    const LinkModel& link = build.model.links[i];
    const bool frame = link.inertial.mass <= 0 && link.visuals.empty();  // a fixed root that only places others
    if (!link.collisions.empty() || frame) continue;
    visible = visible || !link.visuals.empty();
    if (count++ == 0) line = line_of_link(build, static_cast<int>(i));
    if (names.size() < kShownLinks) names.push_back(printable(link.name));
  }
  if (count == 0) return;
  std::string text = fmt::format("{} {} no collision geometry: {}{}", count, count == 1 ? "link has" : "links have",
                                 fmt::join(names, ", "), count > names.size() ? " …" : "");
  const char* const cure = "Add <collision> elements, unless nothing should touch these links.";
  if (visible) {
    build.problems.warning(line, std::move(text), cure);
  } else {
    build.problems.note(line, std::move(text), cure);
  }
}

void check_hollow_meshes(UrdfBuild& build) {
  std::size_t count = 0;
  std::string text;
  int line = 0;
  for (std::size_t i = 0; i < build.model.links.size(); ++i) {
    for (const PlacedShape& placed : build.model.links[i].collisions) {
      const MeshModel* const mesh = placed.shape.mesh.get();
      if (mesh == nullptr || !mesh->closed) continue;
      if (mesh->hull_volume <= kHollowRatio * mesh->solid.mass || count++ > 0) continue;
      line = line_of_link(build, static_cast<int>(i));
      text = fmt::format("link '{}': the convex hull of collision mesh '{}' fills its hollows: {:.3g} times its volume",
                         printable(build.model.links[i].name), printable(mesh->name),
                         mesh->hull_volume / mesh->solid.mass);
    }
  }
  if (count == 0) return;
  if (count > 1) text += fmt::format(" … and {} more of this kind", count - 1);
  build.problems.warning(line, std::move(text),
                         "Split the mesh into convex pieces, one <collision> for each, if things must fit inside.");
}

}  // namespace

void build_collisions(UrdfBuild& build) {
  check_overlaps(build);
  check_missing_collisions(build);
  check_hollow_meshes(build);
}

}  // namespace limber
