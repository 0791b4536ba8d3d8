// Overlay: what the debug picture shows of a world: joints with limits, centres of mass, forces of the last tick,
// contacts, targets of behaviours. Nothing is gathered while /visuals/look/overlay is off. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace limber {

class Behavior;
class Body;
class Joint;
class Part;
class PartLoads;
class World;

/// One thing that is shown, in world terms.
struct OverlayMark {
  enum class Kind : std::uint8_t {
    turn,     ///< An axis that a joint turns about.
    shift,    ///< An axis that a joint moves along.
    center,   ///< A centre of mass.
    contact,  ///< A point where parts touch.
    force,    ///< What pushed a part in the last tick.
    target,   ///< Where a behaviour wants something.
  };
  Kind kind = Kind::center;
  std::uint8_t axis = 0;        ///< Of `turn` and `shift`: 0, 1, 2 of the joint's frame.
  bool limited = false;         ///< `low` and `high` count.
  std::uint32_t slot = 0;       ///< Of the joint, part or behaviour.
  double reach = 0.1;           ///< About half the part's size, m.
  Vec3 at{0};                   ///< m
  Quat turn = quat_identity();  ///< The joint's frame on the parent; a part's principal axes.
  Vec3 vector{0};               ///< Of `contact` and `force`, in weights of the part.
  double low = 0, high = 0;     ///< rad or m
  double value = 0;
};

class Overlay {
 public:
  explicit Overlay(World& world) : world_(world) {}

  /// Whether the row says so.
  bool on() const;
  /// The loads are about to be handed to Bullet: what they push with is kept.
  void take_loads(const PartLoads& loads);
  /// All marks of the world as it was told last, in a fixed order; `out` is emptied first and allocates only while it
  /// grows.
  void gather(std::vector<OverlayMark>& out) const;

 private:
  void add_joint(const Joint& joint, std::vector<OverlayMark>& out) const;
  void add_contacts(std::vector<OverlayMark>& out) const;
  void add_targets(const Behavior& behavior, std::vector<OverlayMark>& out) const;

  World& world_;
  std::vector<OverlayMark> forces_;  // of the last tick
};

}  // namespace limber
