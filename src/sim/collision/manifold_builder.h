// ManifoldBuilder: replaces all contact points of two objects by those of the present step.
#pragma once

#include <array>

#include "sim/bullet/bullet.h"

namespace limber::sim::collision {

/// Flag of a contact point, in addition to Bullet's: the surfaces have met and the impact is over; see contacts.h.
inline constexpr int kContactClosed = 1 << 16;

/// Collects the points of one step, reduces them to at most four (the deepest, and those that span the largest area),
/// and writes them to Bullet's manifold. Points that existed before retain their impulses for warm starting. Bullet
/// collects the points of a manifold over several steps; here each step finds all of them, also while a body slides.
/// [sim]
class ManifoldBuilder {
 public:
  /// `h`: length of the step, s. Body A is the first one of the manifold.
  ManifoldBuilder(btPersistentManifold& manifold, btScalar h);

  /// Upper bound of the distance of points that can touch within the step, m.
  btScalar max_distance() const { return max_distance_; }
  /// The same without the bodies' linear motion, m.
  btScalar max_rotation_distance() const { return max_rotation_distance_; }
  /// Linear motion of B relative to A in the step, m; 0 if contacts begin only where surfaces touch.
  const btVector3& relative_motion() const { return relative_motion_; }
  /// Adds a contact: a point on the surface of B, with the opposite point of A at `distance` along the outward normal
  /// of B (negative: penetration). Ignored if the surfaces can't touch there within the step, or after kMaxCandidates.
  void add(const btVector3& point_on_b, const btVector3& normal, btScalar distance);
  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  /// Writes the points to the manifold.
  void write();

 private:
  struct Point {
    btVector3 on_b;
    btVector3 normal;
    btScalar distance;
  };
  static constexpr int kMaxCandidates = 128;

  const Point& at(int i) const { return points_[static_cast<std::size_t>(i)]; }
  btScalar approach(const btVector3& point, const btVector3& normal) const;
  void reduce();
  int find_deepest() const;
  int find_farthest(int from) const;
  int find_widest(int a, int b, btScalar side) const;

  btPersistentManifold& manifold_;
  const btRigidBody* a_;
  const btRigidBody* b_;
  btScalar h_;
  btScalar contact_distance_;  // distance up to which points are contacts even without an approach
  btVector3 relative_motion_{0, 0, 0};
  btScalar max_rotation_distance_;
  btScalar max_distance_;
  int count_ = 0;
  std::array<Point, kMaxCandidates> points_;
};

/// Result of Bullet's own algorithms, one point at a time; a point that replaces an older one retains its warm-start
/// data. [sim]
class ContactResult : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b, btScalar depth) override;
};

}  // namespace limber::sim::collision
