// Tendon: a massless cable that slides through points on parts of any bodies, with the same tension along its length.
// [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/memory/archive.h"
#include "base/vec.h"
#include "model/body_model.h"
#include "properties/store.h"

namespace limber::sim::bullet {
class TendonConstraint;
}  // namespace limber::sim::bullet

namespace limber::sim {

class Body;
class Part;
class World;

class Tendon {
 public:
  static const PropertyTable& table();

  struct Point {
    Part* part = nullptr;
    Vec3 position{0};  ///< In the part's link frame, m.
  };
  static constexpr std::size_t kMaxPoints = model::TendonModel::kMaxPoints;

  /// `body`: its owner, whose members its node is among. The points must be valid (TendonList::add()).
  Tendon(Body& body, NodeId group, std::string name, std::vector<Point> points);
  ~Tendon();
  Tendon(const Tendon&) = delete;
  Tendon& operator=(const Tendon&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  Body& body() const { return body_; }
  std::span<const Point> points() const { return points_; }
  /// True if the body is its owner, or one of its points is on the body.
  bool uses(const Body& body) const;
  /// Length of the line through the points in the parts' present poses, m.
  double length() const;

  /// Replaces the points after a body was rebuilt. Its constraint must have been removed (remove_constraint()) before
  /// the previous parts were destroyed.
  void replace_points(std::vector<Point> points);
  /// Adds the constraint to Bullet's world if the tendon is enabled and its parts are in the world; else removes it.
  void update_constraint();
  void remove_constraint();
  /// Publishes its readouts after a tick.
  void publish();

  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }

  // Callbacks of the properties.
  void apply_settings();
  Result<void> act_remove(std::span<const double> args);

 private:
  Store& store() const;
  void make_constraint();
  void wake();

  Body& body_;
  NodeId id_;
  std::vector<Point> points_;
  std::unique_ptr<bullet::TendonConstraint> constraint_;
  // what persists from tick to tick, besides its properties
  struct State {
    bool in_world = false;
  } state_;
};

}  // namespace limber::sim
