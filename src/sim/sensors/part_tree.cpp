// PartTree: building, refitting and traversing the hierarchy.
#include "sim/sensors/part_tree.h"

#include <algorithm>
#include <array>
#include <limits>

#include "model/pieces/pieces.h"
#include "sim/shapes/geometry.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr std::uint32_t kLeafSize = 2;
/// After this many refits the tree is built again, since parts have moved apart.
constexpr int kMaxRefits = 30;
/// Bounds are enlarged by it, relative to their size and position, so that rounding doesn't exclude a hit.
constexpr double kMargin = 1e-9;

// Returns the distance at which a ray enters a box, or infinity if it misses the box or enters it beyond `max`.
double enter_box(const Vec3& low, const Vec3& high, const Vec3& from, const Vec3& inverse, double max) {
  double enter = 0;
  double leave = max;
  for (int axis = 0; axis < 3; axis++) {
    const double a = (low[axis] - from[axis]) * inverse[axis];
    const double b = (high[axis] - from[axis]) * inverse[axis];
    // a NaN (the ray runs in a side of the box) doesn't limit
    const double near = a < b ? a : b;
    const double far = a < b ? b : a;
    if (near > enter) enter = near;
    if (far < leave) leave = far;
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

// Squared distance of a point from a box.
double distance2(const Vec3& low, const Vec3& high, const Vec3& point) {
  const Vec3 d = glm::max(glm::max(low - point, point - high), Vec3(0));
  return glm::dot(d, d);
}

}  // namespace

bool PartTree::is_ignored(const Part& part, const Ignored& ignored) {
  return &part == ignored.part || &part.body() == ignored.body;
}

const std::vector<Solid>& PartTree::solids_of(const Part& part) {
  const Geometry* const geometry = part.geometry().get();
  const auto [entry, is_new] = solids_.try_emplace(geometry);
  if (is_new) {
    entry->second.geometry = part.geometry();
    for (const model::PlacedShape& placed : geometry->placed) {
      for (const model::PlacedShape& convex : model::convex_shapes(placed)) entry->second.list.emplace_back(convex);
    }
  }
  return entry->second.list;
}

void PartTree::place(Item& item) const {
  item.pose = item.part->pose() * item.solid->origin();
  if (item.solid->infinite()) return;
  const Mat3 axes = glm::mat3_cast(item.pose.rotation);
  const Vec3& half = item.solid->half_size();
  const Vec3 extent = glm::abs(axes[0]) * half.x + glm::abs(axes[1]) * half.y + glm::abs(axes[2]) * half.z;
  const Vec3 center = item.pose * item.solid->center();
  const Vec3 margin = kMargin * (extent + glm::abs(center) + Vec3(1));
  item.low = center - extent - margin;
  item.high = center + extent + margin;
}

void PartTree::collect() {
  items_.clear();
  infinite_.clear();
  order_.clear();
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      for (const Solid& solid : solids_of(*part)) {
        const auto index = static_cast<std::uint32_t>(items_.size());
        (solid.infinite() ? infinite_ : order_).push_back(index);
        Item& item = items_.emplace_back();
        item.part = part.get();
        item.solid = &solid;
      }
    }
  }
}

std::uint32_t PartTree::build_node(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (count <= kLeafSize) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  Vec3 low(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  const auto center = [&](std::uint32_t item) { return items_[item].low + items_[item].high; };
  for (std::uint32_t i = first; i < first + count; i++) {
    low = glm::min(low, center(order_[i]));
    high = glm::max(high, center(order_[i]));
  }
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return center(a)[axis] != center(b)[axis] ? center(a)[axis] < center(b)[axis] : a < b;
  });
  build_node(first, half);
  const std::uint32_t right = build_node(first + half, count - half);
  nodes_[index].right = right;
  return index;
}

// Computes the bounds of all nodes; children come after their parents.
void PartTree::refit() {
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    if (node->count > 0) {
      node->low = items_[order_[node->first]].low;
      node->high = items_[order_[node->first]].high;
      for (std::uint32_t i = node->first + 1; i < node->first + node->count; i++) {
        node->low = glm::min(node->low, items_[order_[i]].low);
        node->high = glm::max(node->high, items_[order_[i]].high);
      }
    } else {
      const Node& left = *(node - 1);
      const Node& right = nodes_[node->right];
      node->low = glm::min(left.low, right.low);
      node->high = glm::max(left.high, right.high);
    }
  }
}

void PartTree::build() {
  nodes_.clear();
  if (!order_.empty()) build_node(0, static_cast<std::uint32_t>(order_.size()));
  refits_ = 0;
}

void PartTree::update() {
  const std::uint64_t version = world_.store().structure_version();
  if (valid_ && structure_version_ == version) return;
  const bool same_parts = same_bodies_ && structure_version_ == version;
  if (!same_parts) {
    collect();
    std::erase_if(solids_, [](const auto& entry) { return entry.second.geometry.use_count() == 1; });
  }
  for (Item& item : items_) place(item);
  if (!same_parts || ++refits_ > kMaxRefits) build();
  refit();
  same_bodies_ = true;
  structure_version_ = version;
  valid_ = true;
}

// Tests a solid; of equally distant ones the first in stream order counts.
void PartTree::test(std::uint32_t index, const Vec3& from, const Vec3& direction, const Ignored& ignored,
                    Nearest& nearest) const {
  const Item& item = items_[index];
  if (is_ignored(*item.part, ignored)) return;
  const Quat to_solid = glm::conjugate(item.pose.rotation);
  const std::optional<SolidHit> hit =
      item.solid->intersect(to_solid * (from - item.pose.position), to_solid * direction, nearest.distance);
  if (!hit || (hit->distance == nearest.distance && index > nearest.item)) return;
  nearest = {hit->distance, index, item.pose.rotation * hit->normal};
}

std::optional<RayHit> PartTree::ray(const Vec3& from, const Vec3& direction, double max, const Ignored& ignored) {
  update();
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  Nearest nearest{max, kNone, Vec3(0)};
  for (const std::uint32_t item : infinite_) test(item, from, direction, ignored, nearest);
  const Vec3 inverse = 1.0 / direction;
  pending_.clear();
  if (!nodes_.empty()) pending_.push_back(0);
  while (!pending_.empty()) {
    const std::uint32_t index = pending_.back();
    pending_.pop_back();
    const Node& node = nodes_[index];
    if (!(enter_box(node.low, node.high, from, inverse, nearest.distance) <= nearest.distance)) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; i++)
      test(order_[i], from, direction, ignored, nearest);
    if (node.count > 0) continue;
    // the nearer child is visited first
    const double left = enter_box(nodes_[index + 1].low, nodes_[index + 1].high, from, inverse, nearest.distance);
    const double right = enter_box(nodes_[node.right].low, nodes_[node.right].high, from, inverse, nearest.distance);
    const std::array<std::uint32_t, 2> children =
        left <= right ? std::array{node.right, index + 1} : std::array{index + 1, node.right};
    pending_.insert(pending_.end(), children.begin(), children.end());
  }
  if (nearest.item == kNone) return {};
  return RayHit{items_[nearest.item].part, from + nearest.distance * direction, nearest.normal, nearest.distance};
}

void PartTree::find_near(const Vec3& center, double radius, const Ignored& ignored, std::vector<NearPart>& found) {
  update();
  found.clear();
  near_items_ = infinite_;
  pending_.clear();
  if (!nodes_.empty()) pending_.push_back(0);
  while (!pending_.empty()) {
    const std::uint32_t index = pending_.back();
    pending_.pop_back();
    const Node& node = nodes_[index];
    if (distance2(node.low, node.high, center) > radius * radius) continue;
    near_items_.insert(near_items_.end(), order_.begin() + node.first, order_.begin() + node.first + node.count);
    if (node.count == 0) pending_.insert(pending_.end(), {index + 1, node.right});
  }
  std::sort(near_items_.begin(), near_items_.end());
  for (const std::uint32_t index : near_items_) {
    const Item& item = items_[index];
    if (is_ignored(*item.part, ignored)) continue;
    const double distance =
        item.solid->signed_distance(glm::conjugate(item.pose.rotation) * (center - item.pose.position));
    if (!(distance <= radius)) continue;
    if (!found.empty() && found.back().part == item.part) {
      found.back().distance = std::min(found.back().distance, distance);
    } else {
      found.push_back({item.part, distance});
    }
  }
}

}  // namespace limber::sim
