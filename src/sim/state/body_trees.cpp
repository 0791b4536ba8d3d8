// Trees of joints: their roots, and moving them.
#include "sim/state/body_trees.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "base/text.h"
#include "model/body_model.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"

namespace limber::sim {

std::vector<std::size_t> tree_roots(const Body& body) {
  const auto parts = body.parts();
  const std::size_t count = parts.size();
  std::unordered_map<const Part*, std::size_t> index;
  std::vector<std::size_t> parent(count);
  for (std::size_t i = 0; i < count; i++) index[parts[i].get()] = parent[i] = i;
  for (const auto& joint : body.joints()) {
    const std::size_t child = index[&joint->child()];
    if (parent[child] == child) parent[child] = index[&joint->parent()];
  }
  std::vector<std::size_t> roots(count);
  for (std::size_t i = 0; i < count; i++) {
    std::size_t ancestor = i;
    for (std::size_t steps = 0; steps < count && parent[ancestor] != ancestor; steps++) ancestor = parent[ancestor];
    // a loop of joints has no root: use the lowest index in it
    roots[i] = ancestor;
    for (std::size_t next = parent[ancestor]; next != ancestor; next = parent[next])
      roots[i] = std::min(roots[i], next);
  }
  return roots;
}

void move_tree(const Body& body, std::size_t root, const Pose& pose) {
  const auto parts = body.parts();
  const std::vector<std::size_t> roots = tree_roots(body);
  const Pose displacement = pose * parts[root]->pose().inverse();
  for (std::size_t i = 0; i < parts.size(); i++) {
    if (roots[i] == root) parts[i]->set_pose(i == root ? pose : displacement * parts[i]->pose());
  }
}

Result<Pose> link_pose(const Body& body, std::string_view name) {
  if (const Part* part = body.find_part(name)) return part->pose();
  std::vector<std::string_view> names;
  for (const auto& part : body.parts()) names.push_back(part->name());
  if (body.model() != nullptr) {
    for (const model::MergedLink& merged : body.model()->merged) {
      if (merged.name == name) return body.parts()[static_cast<std::size_t>(merged.link)]->pose() * merged.offset;
      names.push_back(merged.name);
    }
  }
  return Error{fmt::format("body '{}' has no link '{}'{}", body.name(), name, name_hint(name, names))};
}

}  // namespace limber::sim
