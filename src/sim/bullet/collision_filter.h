// CollisionFilter: collision group, mask and body of an object, stored in two of Bullet's user indices.
#pragma once

#include <cstdint>

#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

/// Two objects may collide if each one's group has a bit in the other's mask, unless they belong to one body and one of
/// them doesn't collide with its own body. By default, objects may collide with everything.
struct CollisionFilter {
  std::uint16_t group = 0xffff;
  std::uint16_t mask = 0xffff;
  std::int32_t body = -1;      ///< Below 2^30; -1: none.
  bool self_collision = true;  ///< It collides with other objects of its body.

  static CollisionFilter of(const btCollisionObject& object) {
    const auto bits = static_cast<std::uint32_t>(object.getUserIndex());
    const int own = object.getUserIndex2();
    return {static_cast<std::uint16_t>(bits & 0xffffu), static_cast<std::uint16_t>(bits >> 16), own < 0 ? -1 : own >> 1,
            own < 0 || (own & 1) == 0};
  }
  /// Stores the filter in the object. Returns true if that changed it.
  bool store(btCollisionObject& object) const {
    const auto bits = static_cast<std::int32_t>(std::uint32_t{group} | std::uint32_t{mask} << 16);
    const int own = body < 0 ? -1 : body * 2 + (self_collision ? 0 : 1);
    if (object.getUserIndex() == bits && object.getUserIndex2() == own) return false;
    object.setUserIndex(bits);
    object.setUserIndex2(own);
    return true;
  }
  bool accepts(const CollisionFilter& other) const {
    if ((group & other.mask) == 0 || (other.group & mask) == 0) return false;
    return body < 0 || body != other.body || (self_collision && other.self_collision);
  }
};

}  // namespace limber::sim::bullet
