// Scenes for measuring and testing solvers: arms, trees, legs, a gripper, piles. [any]
#pragma once

#include "bench/raw/scene.h"

namespace limber {

/// An arm of `parts` parts on a base on a floor, with masses alternating between 1/sqrt(ratio) and sqrt(ratio) kg.
RawScene raw_arm(int parts, double ratio, double force, double amplitude, bool square);
/// The robot of 17 joints of ofxDabPhysics, upright: eight pairs of a link that twists and a part that bends by
/// ±pi/2, and a tip. Masses and joint positions are from its URDF; a part is a box of its mesh's size around its
/// center of mass.
RawScene raw_robot(double force, double amplitude);
/// 17 parts in the air with gravity across them, joints limited to ±limit.
RawScene raw_lying_arm(double limit);
/// Arms of 1 kg parts side by side.
RawScene raw_arms(int count);
/// Limits the joints to ±limit (rad) and lifts the scene; removes the servos unless `driven`.
RawScene raw_limited(RawScene scene, double limit, bool driven);
RawScene raw_with_step(RawScene scene, double step);
/// 5 branches of 5 joints on a hub, which is fixed or floating.
RawScene raw_tree(bool floating);
/// A trunk on four legs of hip, knee and ankle; standing or walking.
RawScene raw_legs(double trunk, double leg, bool walking);
/// Three fingers of two joints hold a ball with the given torque per joint.
RawScene raw_gripper(double torque);
/// Creatures of six parts connected by springs, attracted by one point.
RawScene raw_clump(int creatures);
/// Boxes that fall onto a floor in layers.
RawScene raw_pile(int boxes);
/// 3 to 30 parts, masses over four decades, a third of the joints limited, three quarters driven.
RawScene raw_random_tree(unsigned seed, bool floor);

}  // namespace limber
