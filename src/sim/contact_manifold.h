// ContactManifold: replaces all contact points of two objects by those of this step, at once.
#pragma once

#include <array>

#include "sim/bullet.h"

namespace limber {

/// Flag of a contact point beside Bullet's own: it has touched and has taken the impulse of that; see contacts.h.
inline constexpr int kContactClosed = 1 << 16;

/// Collects the points of one step, keeps at most four of them (the deepest, and those that span the largest area),
/// and writes them into Bullet's manifold. Points that were there keep their impulses, which solvers start from.
/// Nothing stale stays: a body that slides has its full set of points in every step. [sim]
class ContactManifold {
 public:
  /// `h`: length of the step, s. Body A is the first of the manifold's.
  ContactManifold(btPersistentManifold& manifold, btScalar h);

  /// Upper bound of how far apart points can be that touch within the step, m.
  btScalar reach() const { return reach_; }
  /// The same, without the bodies' linear motion.
  btScalar turn_reach() const { return turn_reach_; }
  /// How far B moves in the step, seen from A, without turning, m; 0 if contacts begin only where surfaces touch.
  const btVector3& way() const { return way_; }
  /// A point on the surface of B, `distance` (negative: depth) below that of A along the normal of B. Ignored if the
  /// two cannot meet within the step.
  void add(const btVector3& point_on_b, const btVector3& normal, btScalar distance);
  bool empty() const { return count_ == 0; }
  /// Writes the points into the manifold.
  void finish();

 private:
  struct Point {
    btVector3 on_b;
    btVector3 normal;
    btScalar distance;
  };
  static constexpr int kMaxPoints = 128;

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
  btScalar near_;  // points at most this far apart are contacts even where nothing approaches
  btVector3 way_{0, 0, 0};
  btScalar turn_reach_;
  btScalar reach_;
  bool ahead_;  // whether contacts may begin before the surfaces touch; see Part::effect_surface
  int count_ = 0;
  std::array<Point, kMaxPoints> points_;
};

/// What Bullet's own algorithms report, a point at a time; a point that replaces an older one keeps everything that the
/// solvers remember of it. [sim]
class ContactResult : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b, btScalar depth) override;
};

}  // namespace limber
