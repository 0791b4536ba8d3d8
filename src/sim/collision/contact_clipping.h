// Clipping of contact features against each other, and the contacts that result.
#pragma once

#include "sim/collision/contact_features.h"
#include "sim/collision/manifold_builder.h"

namespace limber::sim::collision {

/// A face is the reference face if its normal is within 1.1 degrees of the contact normal.
inline constexpr btScalar kMinAlignment = 0.9998F;
/// Tolerance outside of the reference face's sides, m.
inline constexpr btScalar kClipSlack = 1e-5F;

/// Adds the ends of the stretch along which two parallel segments touch; returns false if they aren't parallel.
/// `normal`: from B to A. All features are in world axes. [sim]
bool add_parallel_edges(const ContactFeature& a, const ContactFeature& b, const btVector3& normal,
                        ManifoldBuilder& points);

/// Adds the points of the incident feature near the reference face. `flipped`: the reference face is body A's.
/// `incident` is overwritten. [sim]
void add_face_points(const ContactFeature& reference, ContactFeature& incident, bool flipped, ManifoldBuilder& points);

/// The feature of a placed shape in a direction (world), in world axes. [sim]
void find_world_feature(const btConvexShape& shape, const btTransform& pose, const btVector3& direction,
                        ContactFeature& feature);

}  // namespace limber::sim::collision
