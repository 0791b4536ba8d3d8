// Sutherland and Hodgman's algorithm for polygons, segments and points.
#include "sim/collision/contact_clipping.h"

#include <utility>

namespace limber::sim::collision {
namespace {

/// Sine of the largest angle between edges that count as parallel.
constexpr btScalar kParallelSine = 0.02F;

// Clips a polygon, segment or point to the inner side of the plane through `from` with the normal `outward`.
void clip_by_plane(const ContactFeature& whole, const btVector3& from, const btVector3& outward, ContactFeature& part) {
  part.count = 0;
  const int sides = whole.count > 2 ? whole.count : whole.count - 1;
  btScalar p_out = outward.dot(whole[0] - from) - kClipSlack;
  if (sides == 0 && p_out <= 0) part.add(whole[0]);
  for (int i = 0; i < sides; ++i) {
    const btVector3& p = whole[i];
    const btVector3& q = whole[i + 1 < whole.count ? i + 1 : 0];
    const btScalar q_out = outward.dot(q - from) - kClipSlack;
    if (p_out <= 0) part.add(p);
    if ((p_out <= 0) != (q_out <= 0)) part.add(p + (q - p) * (p_out / (p_out - q_out)));
    if (whole.count == 2 && q_out <= 0) part.add(q);
    p_out = q_out;
  }
}

// Clips a polygon, segment or point against the sides of the reference face. `incident` is overwritten; the result is
// `incident` or `spare`.
const ContactFeature& clip(const ContactFeature& reference, ContactFeature& incident, ContactFeature& spare) {
  spare.normal = incident.normal;
  spare.margin = incident.margin;
  ContactFeature* whole = &incident;
  ContactFeature* part = &spare;
  for (int side = 0; side < reference.count && whole->count > 0; ++side) {
    const btVector3& from = reference[side];
    const btVector3 edge = reference[side + 1 < reference.count ? side + 1 : 0] - from;
    const btScalar length = edge.length();
    if (!(length > SIMD_EPSILON)) continue;
    clip_by_plane(*whole, from, edge.cross(reference.normal) / length, *part);
    std::swap(whole, part);
  }
  return *whole;
}

}  // namespace

bool add_parallel_edges(const ContactFeature& a, const ContactFeature& b, const btVector3& normal,
                        ManifoldBuilder& points) {
  const btVector3 edge_a = a[1] - a[0];
  const btVector3 edge_b = b[1] - b[0];
  const btScalar length = edge_b.length();
  if (!(length > SIMD_EPSILON) || edge_a.cross(edge_b).length() > kParallelSine * edge_a.length() * length)
    return false;
  const btVector3 along = edge_b / length;
  ContactFeature from_start;
  ContactFeature within;
  clip_by_plane(a, b[0], -along, from_start);
  clip_by_plane(from_start, b[1], along, within);
  for (int i = 0; i < within.count; ++i) {
    const btVector3 on_a = within[i] - normal * a.margin;
    const btVector3 on_b = b[0] + along * along.dot(within[i] - b[0]) + normal * b.margin;
    points.add(on_b, normal, normal.dot(on_a - on_b));
  }
  return !points.empty();
}

void add_face_points(const ContactFeature& reference, ContactFeature& incident, bool flipped, ManifoldBuilder& points) {
  ContactFeature spare;
  const ContactFeature& clipped = clip(reference, incident, spare);
  const btVector3& normal = reference.normal;
  for (int i = 0; i < clipped.count; ++i) {
    const btVector3 point = clipped[i] - normal * clipped.margin;
    const btScalar distance = normal.dot(point - reference[0]) - reference.margin;
    if (flipped) {
      points.add(point, -normal, distance);
    } else {
      points.add(point - normal * distance, normal, distance);
    }
  }
}

void find_world_feature(const btConvexShape& shape, const btTransform& pose, const btVector3& direction,
                        ContactFeature& feature) {
  find_feature(shape, direction * pose.getBasis(), feature);
  feature.transform(pose);
}

}  // namespace limber::sim::collision
