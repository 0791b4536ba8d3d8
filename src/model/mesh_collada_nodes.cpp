// The nodes of a Collada document: where they are, what they instance, and that this has an end.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "model/mesh_collada.h"

namespace limber::collada {

namespace {

constexpr std::uint64_t kMostUnfolded = 100'000;
constexpr int kMostControllers = 8;

Placement turned(const Vec3& axis, double degrees) {
  const Vec3 unit = normalized(axis);
  return {unit == Vec3(0) ? Mat3(1) : glm::mat3_cast(quat_axis(unit, degrees * kPi / 180)), Vec3(0)};
}

/// At the eye, its -z towards the point of interest, y as near to `up` as can be.
Placement looking(const Vec3& eye, const Vec3& interest, const Vec3& up) {
  const Vec3 back = normalized(eye - interest);
  const Vec3 right = normalized(glm::cross(up, back));
  return {Mat3(right, glm::cross(back, right), back), eye};
}

Placement matrix(const std::vector<double>& rows) {
  Placement out;
  std::size_t at = 0;
  for (int row = 0; row < 3; ++row, at += 4) {
    for (int column = 0; column < 3; ++column) out.turn[column][row] = rows[at + static_cast<std::size_t>(column)];
    out.shift[row] = rows[at + 3];
  }
  return out;
}

/// Multiplies the node's place by one of its transforms; what is no transform changes nothing.
Result<void> apply(const Element* e, Placement& place) {
  struct Kind {
    std::string_view name;
    std::size_t numbers;
  };
  constexpr std::array<Kind, 6> kKinds{
      {{"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}, {"lookat", 9}, {"skew", 0}}};
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return is_named(e, k.name); });
  if (kind == kKinds.end()) return {};
  if (kind->numbers == 0) return fault_at(e, "a <skew> is not read");
  const Result<std::vector<double>> numbers = numbers_of(e, kind->numbers);
  if (!numbers) return Error{numbers.error()};
  const auto vector = [&](std::size_t i) { return Vec3((*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2]); };
  if (kind->name == "matrix") {
    place = place * matrix(*numbers);
  } else if (kind->name == "translate") {
    place = place * Placement{Mat3(1), vector(0)};
  } else if (kind->name == "rotate") {
    place = place * turned(vector(0), (*numbers)[3]);
  } else if (kind->name == "lookat") {
    place = place * looking(vector(0), vector(3), vector(6));
  } else {
    const Vec3 s = vector(0);
    place = place * Placement{Mat3(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z), Vec3(0)};
  }
  return {};
}

/// Reads nodes and visual scenes into a graph, which must have no circle and unfold to a bounded number of nodes.
class SceneReader {
 public:
  SceneReader(const Element* root, const Ids& ids) : root_(root), ids_(ids) {}

  Result<Scene> read() {
    for (const Element* e = root_; e; e = next_in(e, root_)) {
      if (is_named(e, "node") || is_named(e, "visual_scene")) number_.emplace(e, static_cast<int>(number_.size()));
    }
    scene_.nodes.resize(number_.size());
    for (const Element* e = root_; e; e = next_in(e, root_)) {
      if (number_.count(e) == 0) continue;
      if (const Result<void> read = read_node(e); !read) return Error{read.error()};
    }
    const Element* shown = shown_scene();
    if (!shown) return fault_at(root_, "there is no visual scene to show");
    scene_.start = number_.at(shown);
    if (const Result<void> bounded = check_bounds(); !bounded) return Error{bounded.error()};
    return std::move(scene_);
  }

 private:
  /// The geometry that an <instance_geometry> or <instance_controller> means: a skin is taken as it was modelled.
  const Element* shape_of(const Element* instance) {
    const char* url = instance->Attribute("url");
    if (is_named(instance, "instance_geometry")) return ids_.find("geometry", url);
    for (int i = 0; i < kMostControllers; ++i) {
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
    Node& node = scene_.nodes[static_cast<std::size_t>(number_.at(element))];
    for (const Element* e = element->FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is_named(e, "node")) {
        node.below.push_back(number_.at(e));
      } else if (is_named(e, "instance_node")) {
        const Element* found = ids_.find("node", e->Attribute("url"));
        if (!found) return missing(e, "node");
        node.below.push_back(number_.at(found));
      } else if (is_named(e, "instance_geometry") || is_named(e, "instance_controller")) {
        node.shapes.push_back(shape_of(e));
        if (!node.shapes.back()) return missing(e, "geometry");
      } else if (Result<void> applied = apply(e, node.place); !applied) {
        return applied;
      }
    }
    return {};
  }
  static Error missing(const Element* e, std::string_view what) {
    const char* url = e->Attribute("url");
    return fault_at(e, fmt::format("there is no {} {}", what, quoted_word(url ? url : "")));
  }
  const Element* shown_scene() const {
    const Element* scene = root_->FirstChildElement("scene");
    const Element* instance = scene ? scene->FirstChildElement("instance_visual_scene") : nullptr;
    if (instance) return ids_.find("visual_scene", instance->Attribute("url"));
    const Element* library = root_->FirstChildElement("library_visual_scenes");
    return library ? library->FirstChildElement("visual_scene") : nullptr;
  }

  Result<void> check_bounds() {
    count_.assign(scene_.nodes.size(), 0);
    open_.assign(scene_.nodes.size(), false);
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      if (!unfold(static_cast<int>(i))) return fault_at(root_, "its nodes instance each other in a circle");
      if (count_[i] > kMostUnfolded) {
        return fault_at(root_, fmt::format("its nodes unfold to more than {}", kMostUnfolded));
      }
    }
    return {};
  }
  /// Counts the nodes and geometries that one node stands for; false for a circle. Without recursion.
  bool unfold(int start) {
    std::vector<std::pair<int, std::size_t>> stack{{start, 0}};
    while (!stack.empty()) {
      auto& [index, next] = stack.back();
      const auto at = static_cast<std::size_t>(index);
      const std::vector<int>& below = scene_.nodes[at].below;
      if (count_[at] > 0) {
        stack.pop_back();
        continue;
      }
      open_[at] = true;
      if (next < below.size()) {
        const int child = below[next++];
        if (open_[static_cast<std::size_t>(child)]) return false;
        stack.emplace_back(child, 0);
        continue;
      }
      std::uint64_t sum = 1 + scene_.nodes[at].shapes.size();
      for (const int child : below) sum = std::min(sum + count_[static_cast<std::size_t>(child)], 2 * kMostUnfolded);
      count_[at] = sum;
      open_[at] = false;
      stack.pop_back();
    }
    return true;
  }

  const Element* root_;
  const Ids& ids_;
  Scene scene_;
  std::map<const Element*, int> number_;
  std::map<const Element*, const Element*> skins_;  // by controller
  std::vector<std::uint64_t> count_;
  std::vector<bool> open_;
};

}  // namespace

Result<Scene> read_scene(const Element* root, const Ids& ids) { return SceneReader(root, ids).read(); }

}  // namespace limber::collada
