// The tree has the objects, the render scene their shapes.
#include "app/view/frame_parts.h"

#include <algorithm>

namespace limber::app {

namespace {

constexpr std::size_t kMaxMatches = 100000;

// Returns the closest node of the class at or above this one; 0: none.
std::uint32_t enclosing(const TreeSnapshot& tree, std::uint32_t node, std::string_view table) {
  while (node != 0 && tree.nodes()[node].table->name() != table) node = tree.nodes()[node].parent;
  return node;
}

void add_parts(const TreeSnapshot& tree, std::uint32_t node, std::vector<std::uint32_t>& out) {
  std::uint32_t root = enclosing(tree, node, "part");
  if (root == 0) root = enclosing(tree, node, "body");
  if (root == 0) return;
  for (std::uint32_t i = root; i < tree.nodes()[root].subtree_end; i++) {
    if (tree.nodes()[i].table->name() == "part") out.push_back(tree.nodes()[i].transient);
  }
}

template <class Selects>
std::vector<sim::FramedSphere> spheres_if(const engine::Snapshot& snapshot, const Selects& selects) {
  std::vector<sim::FramedSphere> spheres;
  for (const engine::RenderInstance& instance : snapshot.render_scene->instances) {
    if (snapshot.transient[instance.enabled_offset] == 0 || !selects(instance.part_offset)) continue;
    const Pose pose = engine::part_pose(snapshot, instance.part_offset);
    if (!is_finite(pose.position) || !is_finite(pose.rotation)) continue;
    sim::add_framed_shape(snapshot.render_scene->shapes[instance.shape].geometry, pose * instance.origin, spheres);
  }
  return spheres;
}

}  // namespace

std::vector<std::uint32_t> parts_of(const TreeSnapshot& tree, const std::string& address) {
  std::vector<std::uint32_t> parts;
  if (address.find('*') == std::string::npos) {
    const Result<TreePropertyRef> ref = tree.find(address);
    if (ref) add_parts(tree, ref->node, parts);
  } else {
    PatternBudget budget;
    const Result<std::vector<TreePropertyRef>> matches = tree.match(address + "/active", budget, kMaxMatches);
    if (!matches) return parts;
    for (const TreePropertyRef& ref : *matches) add_parts(tree, ref.node, parts);
  }
  std::ranges::sort(parts);
  return parts;
}

std::vector<sim::FramedSphere> spheres_of_all(const engine::Snapshot& snapshot) {
  return spheres_if(snapshot, [](std::uint32_t) { return true; });
}

std::vector<sim::FramedSphere> spheres_of(const engine::Snapshot& snapshot, const std::vector<std::uint32_t>& parts) {
  return spheres_if(snapshot, [&](std::uint32_t part) { return std::ranges::binary_search(parts, part); });
}

}  // namespace limber::app
