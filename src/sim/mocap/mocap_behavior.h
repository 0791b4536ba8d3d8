// Access to motion capture for behaviors: sources and joints by number, and angles of joints. [sim]
#pragma once

#include <cstddef>
#include <string>

#include "sim/mocap/mocap_source.h"

namespace limber::sim {

class World;

/// The source of a number from 1, or null.
const MocapSource* mocap_source(const World& world, double number);
/// A joint that has a place on stage, by the numbers of its source and itself, or null.
const MocapJoint* mocap_joint(const World& world, double source, double joint);

/// The turn of a joint relative to its parent about an axis of the parent (0 .. 2), rad, -π .. π: the twist of its
/// rotation.
double mocap_turn(const MocapJoint& joint, int axis);
/// The angle between the bone that ends in a joint and the bone that begins in it, rad, 0 .. π; 0 without both bones.
double mocap_bend(const MocapJoint& joint);

// Parameters that these behaviors share.
Property mocap_source_number();
Property mocap_joint_number(std::string name, double initial, std::string doc);

}  // namespace limber::sim
