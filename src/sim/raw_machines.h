// Machines as plain numbers, on which solvers are measured and tested. [any]
#pragma once

#include "sim/raw_scene.h"

namespace limber {

/// So many parts on a base on a floor; masses in turn 1/sqrt(ratio) and sqrt(ratio) kg.
RawScene raw_arm(int parts, double ratio, double force, double amplitude, bool square);
/// The predecessor's robot of 17 joints, upright: a link that twists, a part that bends by ±pi/2, eight times; a tip.
/// Masses and joint places are its URDF's; a part is a box of its mesh's size about its centre of mass.
RawScene raw_robot(double force, double amplitude);
/// 17 parts in the air, their weight across them, joints limited to ±reach.
RawScene raw_lying_arm(double reach);
/// Arms of 1 kg parts side by side.
RawScene raw_arms(int count);
/// Joints limited to ±reach, in the air; without servos unless driven.
RawScene raw_limited(RawScene scene, double reach, bool driven);
RawScene raw_at_step(RawScene scene, double step);
/// 5 branches of 5 joints on a hub that stands or floats.
RawScene raw_tree(bool floating);
/// A trunk on four legs of hip, knee and ankle; standing, or stepping.
RawScene raw_legs(double trunk, double leg, bool walking);
/// Three fingers of two joints hold a ball with so much torque each.
RawScene raw_hand(double torque);
/// So many creatures of six parts, springs between them, drawn to one place.
RawScene raw_clump(int creatures);
/// So many boxes let fall onto a floor in layers.
RawScene raw_pile(int boxes);
/// 3 to 30 parts, masses over four decades, a third of the joints limited, three quarters driven.
RawScene raw_random_tree(unsigned seed, bool floor);

}  // namespace limber
