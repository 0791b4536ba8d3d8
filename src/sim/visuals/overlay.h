// Overlay: data of the debug overlay: joints with limits, centers of mass, forces of the last tick, contacts, targets
// of behaviors. Forces are captured only while /visuals/look/overlay is on. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace limber::sim {

class Behavior;
class Body;
class Joint;
class Part;
class ForceAccumulators;
class World;

/// An element of the overlay, in world coordinates.
struct OverlayMark {
  enum class Kind : std::uint8_t {
    rotation_axis,     ///< rotation axis of a joint
    translation_axis,  ///< translation axis of a joint
    center,            ///< center of mass
    contact,           ///< contact point
    force,             ///< force on a part in the last tick
    target,            ///< target point of a behavior
  };
  Kind kind = Kind::center;
  std::uint8_t axis = 0;            ///< for the axes: 0, 1, 2 of the joint's frame
  bool limited = false;             ///< `lower` and `upper` are valid
  std::uint32_t slot = 0;           ///< of the joint, part or behavior
  double size = 0.1;                ///< about half the part's size, m
  Vec3 position{0};                 ///< m
  Quat rotation = quat_identity();  ///< the joint's frame on the parent, or a part's principal axes
  Vec3 vector{0};                   ///< for `contact` and `force`: multiple of the part's weight
  double lower = 0, upper = 0;      ///< limits of an axis, rad or m
  double value = 0;                 ///< position of an axis, rad or m
};

class Overlay {
 public:
  explicit Overlay(World& world) : world_(world) {}

  /// Value of the property /visuals/look/overlay.
  bool on() const;
  /// Stores the pending forces of the tick; call before they are applied to Bullet. Does nothing while off.
  void capture_forces(const ForceAccumulators& accumulators);
  /// Returns all marks for the last published state of the world, in a deterministic order. `out` is cleared first
  /// and allocates only while it grows.
  void collect(std::vector<OverlayMark>& out) const;

 private:
  void add_joint(const Joint& joint, std::vector<OverlayMark>& out) const;
  void add_contacts(std::vector<OverlayMark>& out) const;
  void add_targets(const Behavior& behavior, std::vector<OverlayMark>& out) const;

  World& world_;
  std::vector<OverlayMark> forces_;  // of the last tick
};

}  // namespace limber::sim
