// Scene graph of a Collada document: reads node transforms and instances, rejects cycles and bounds the number of
// instances.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "model/mesh/collada.h"

namespace limber::model::collada {

namespace {

constexpr std::uint64_t kMaxInstances = 100'000;
constexpr int kMaxControllers = 8;

AffineTransform rotation(const Vec3& axis, double degrees) {
  const Vec3 unit = normalized(axis);
  return {unit == Vec3(0) ? Mat3(1) : glm::mat3_cast(quat_axis(unit, degrees * kPi / 180)), Vec3(0)};
}

/// A <lookat> transform: origin at the eye, -z towards the point of interest, y as close to `up` as possible.
AffineTransform look_at(const Vec3& eye, const Vec3& interest, const Vec3& up) {
  const Vec3 back = normalized(eye - interest);
  const Vec3 right = normalized(glm::cross(up, back));
  return {Mat3(right, glm::cross(back, right), back), eye};
}

AffineTransform matrix(const std::vector<double>& rows) {
  AffineTransform out;
  std::size_t at = 0;
  for (int row = 0; row < 3; ++row, at += 4) {
    for (int column = 0; column < 3; ++column) out.linear[column][row] = rows[at + static_cast<std::size_t>(column)];
    out.translation[row] = rows[at + 3];
  }
  return out;
}

/// Multiplies the node's transform by one of its transform elements; ignores other elements.
Result<void> apply_transform(const Element* e, AffineTransform& transform) {
  struct Kind {
    std::string_view name;
    std::size_t numbers;
  };
  constexpr std::array<Kind, 6> kKinds{
      {{"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}, {"lookat", 9}, {"skew", 0}}};
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return is_named(e, k.name); });
  if (kind == kKinds.end()) return {};
  if (kind->numbers == 0) return error_at(e, "<skew> is not supported");
  const Result<std::vector<double>> numbers = numbers_of(e, kind->numbers);
  if (!numbers) return Error{numbers.error()};
  const auto vector = [&](std::size_t i) { return Vec3((*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2]); };
  if (kind->name == "matrix") {
    transform = transform * matrix(*numbers);
  } else if (kind->name == "translate") {
    transform = transform * AffineTransform{Mat3(1), vector(0)};
  } else if (kind->name == "rotate") {
    transform = transform * rotation(vector(0), (*numbers)[3]);
  } else if (kind->name == "lookat") {
    transform = transform * look_at(vector(0), vector(3), vector(6));
  } else {
    const Vec3 s = vector(0);
    transform = transform * AffineTransform{Mat3(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z), Vec3(0)};
  }
  return {};
}

/// Reads nodes and visual scenes into a graph. The graph must be acyclic, with a bounded number of node instances.
class SceneReader {
 public:
  SceneReader(const Element* root, const IdIndex& ids) : root_(root), ids_(ids) {}

  Result<Scene> read() {
    for (const Element* e = root_; e; e = next_element(e, root_)) {
      if (is_named(e, "node") || is_named(e, "visual_scene"))
        node_index_.emplace(e, static_cast<int>(node_index_.size()));
    }
    scene_.nodes.resize(node_index_.size());
    for (const Element* e = root_; e; e = next_element(e, root_)) {
      if (node_index_.count(e) == 0) continue;
      if (const Result<void> read = read_node(e); !read) return Error{read.error()};
    }
    const Element* active = active_scene();
    if (!active) return error_at(root_, "no visual scene found");
    scene_.root = node_index_.at(active);
    if (const Result<void> bounded = check_bounds(); !bounded) return Error{bounded.error()};
    return std::move(scene_);
  }

 private:
  /// The geometry that an <instance_geometry> or <instance_controller> refers to. Skins and morphs use their undeformed
  /// source geometry.
  const Element* geometry_of(const Element* instance) {
    const char* url = instance->Attribute("url");
    if (is_named(instance, "instance_geometry")) return ids_.find("geometry", url);
    for (int i = 0; i < kMaxControllers; ++i) {
      const Element* controller = ids_.find("controller", url);
      if (!controller) return i > 0 ? ids_.find("geometry", url) : nullptr;
      const auto [entry, is_new] = skins_.try_emplace(controller, nullptr);
      const Element*& skin = entry->second;
      if (is_new) skin = controller->FirstChildElement("skin");
      if (is_new && !skin) skin = controller->FirstChildElement("morph");
      url = skin ? skin->Attribute("source") : nullptr;
    }
    return nullptr;
  }
  Result<void> read_node(const Element* element) {
    Node& node = scene_.nodes[static_cast<std::size_t>(node_index_.at(element))];
    for (const Element* e = element->FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is_named(e, "node")) {
        node.children.push_back(node_index_.at(e));
      } else if (is_named(e, "instance_node")) {
        const Element* found = ids_.find("node", e->Attribute("url"));
        if (!found) return not_found(e, "node");
        node.children.push_back(node_index_.at(found));
      } else if (is_named(e, "instance_geometry") || is_named(e, "instance_controller")) {
        node.geometries.push_back({geometry_of(e), e});
        if (node.geometries.back().geometry == nullptr) return not_found(e, "geometry");
      } else if (Result<void> applied = apply_transform(e, node.transform); !applied) {
        return applied;
      }
    }
    return {};
  }
  static Error not_found(const Element* e, std::string_view kind) {
    const char* url = e->Attribute("url");
    return error_at(e, fmt::format("{} {} not found", kind, quoted_word(url ? url : "")));
  }
  const Element* active_scene() const {
    const Element* scene = root_->FirstChildElement("scene");
    const Element* instance = scene ? scene->FirstChildElement("instance_visual_scene") : nullptr;
    if (instance) return ids_.find("visual_scene", instance->Attribute("url"));
    const Element* library = root_->FirstChildElement("library_visual_scenes");
    return library ? library->FirstChildElement("visual_scene") : nullptr;
  }

  Result<void> check_bounds() {
    instance_counts_.assign(scene_.nodes.size(), 0);
    on_stack_.assign(scene_.nodes.size(), false);
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      if (!count_instances(static_cast<int>(i))) return error_at(root_, "its nodes form a cycle");
      if (instance_counts_[i] > kMaxInstances) {
        return error_at(root_, fmt::format("its nodes expand to more than {} instances", kMaxInstances));
      }
    }
    return {};
  }
  /// Counts the nodes and geometries that one node expands to; false for a cycle. Iterative, because files may nest
  /// nodes deeply.
  bool count_instances(int start) {
    std::vector<std::pair<int, std::size_t>> stack{{start, 0}};
    while (!stack.empty()) {
      auto& [index, next] = stack.back();
      const auto at = static_cast<std::size_t>(index);
      const std::vector<int>& children = scene_.nodes[at].children;
      if (instance_counts_[at] > 0) {
        stack.pop_back();
        continue;
      }
      on_stack_[at] = true;
      if (next < children.size()) {
        const int child = children[next++];
        if (on_stack_[static_cast<std::size_t>(child)]) return false;
        stack.emplace_back(child, 0);
        continue;
      }
      std::uint64_t sum = 1 + scene_.nodes[at].geometries.size();
      for (const int child : children)
        sum = std::min(sum + instance_counts_[static_cast<std::size_t>(child)], 2 * kMaxInstances);
      instance_counts_[at] = sum;
      on_stack_[at] = false;
      stack.pop_back();
    }
    return true;
  }

  const Element* root_;
  const IdIndex& ids_;
  Scene scene_;
  std::map<const Element*, int> node_index_;
  std::map<const Element*, const Element*> skins_;  // by controller
  std::vector<std::uint64_t> instance_counts_;
  std::vector<bool> on_stack_;
};

}  // namespace

Result<Scene> read_scene(const Element* root, const IdIndex& ids) { return SceneReader(root, ids).read(); }

}  // namespace limber::model::collada
