// Machines: arms, the robot of ofxDabPhysics, trees, legs, a gripper, creatures, a pile, and random trees.
#include "bench/raw/machines.h"

#include <cmath>
#include <random>

namespace limber {

RawScene raw_arm(int parts, double ratio, double force, double amplitude, bool square) {
  RawScene s;
  s.floor = true;
  s.parts.push_back({{0.1, 0.1, 0.2}, 0, {{0, 0, 0.1}, quat_identity()}});
  for (int i = 0; i < parts; ++i) {
    const double mass = i % 2 == 0 ? 1 / std::sqrt(ratio) : std::sqrt(ratio);
    s.parts.push_back({{0.1, 0.1, 0.2}, mass, {{0, 0, 0.3 + 0.2 * i}, quat_identity()}});
    RawJoint j;
    j.parent = i;
    j.child = i + 1;
    j.position = {0, 0, 0.2 + 0.2 * i};
    j.axis = i % 2 == 0 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    j.force = force;
    j.amplitude = amplitude;
    j.phase = 0.4 * i;
    j.square = square;
    s.joints.push_back(j);
  }
  return s;
}

RawScene raw_robot(double force, double amplitude) {
  constexpr double kGround = 0.2;  // position of the first joint
  constexpr double kBend = 0.25;   // from a twist joint to the following bend joint
  constexpr double kPitch = 0.325;
  constexpr int kPairs = 8;
  RawScene s;
  s.floor = true;
  s.parts.push_back({{0.2, 0.2, 0.025}, 0, {{0, 0, kGround - 0.0125}, quat_identity()}});
  const auto add = [&](double height, const Vec3& axis, double limit, const RawPart& part) {
    RawJoint j;
    j.parent = static_cast<int>(s.joints.size());
    j.child = j.parent + 1;
    j.position = {0, 0, height};
    j.axis = axis;
    if (limit > 0) {
      j.lower = -limit;
      j.upper = limit;
    }
    j.force = force;
    j.amplitude = amplitude;
    j.phase = 0.4 * j.parent;
    s.joints.push_back(j);
    s.parts.push_back(part);
  };
  const Vec3 twist(0, 0, -1);
  for (int i = 0; i < kPairs; ++i) {
    const double from = kGround + kPitch * i;
    add(from, twist, 0, {{0.1, 0.1, 0.3}, 0.303687, {{0.00348834, 0, from + 0.124569}, quat_identity()}});
    add(from + kBend, {1, 0, 0}, 1.5708,
        {{0.1, 0.1, 0.125}, 4.05265, {{-0.0126452, 0, from + kBend + 0.028125}, quat_identity()}});
  }
  const double tip = kGround + kPitch * kPairs;
  add(tip, twist, 0, {{0.1, 0.1, 0.025}, 0.0314159, {{0, 0, tip + 0.0125}, quat_identity()}});
  return s;
}

RawScene raw_limited(RawScene s, double limit, bool driven) {
  for (RawJoint& j : s.joints) {
    j.lower = -limit;
    j.upper = limit;
    if (!driven) j.force = 0;
  }
  for (RawPart& p : s.parts) p.pose.position.z += 3;
  for (RawJoint& j : s.joints) j.position.z += 3;
  return s;
}

RawScene raw_with_step(RawScene s, double step) {
  s.step = step;
  return s;
}

RawScene raw_tree(bool floating) {
  RawScene s;
  if (floating) s.gravity = Vec3(0);
  const Vec3 center(0, 0, 3);
  s.parts.push_back({{0.3, 0.3, 0.2}, floating ? 4.0 : 0.0, {center, quat_identity()}});
  for (int arm = 0; arm < 5; ++arm) {
    const Quat around = quat_axis({0, 0, 1}, 2 * kPi / 5 * arm);
    int last = 0;
    for (int i = 0; i < 5; ++i) {
      s.parts.push_back({{0.2, 0.1, 0.1}, fixed::pow(0.8, i), {center + around * Vec3(0.25 + 0.2 * i, 0, 0), around}});
      RawJoint j;
      j.parent = last;
      j.child = last = static_cast<int>(s.parts.size()) - 1;
      j.position = center + around * Vec3(0.15 + 0.2 * i, 0, 0);
      j.axis = around * (i % 2 == 0 ? Vec3(0, 1, 0) : Vec3(0, 0, 1));
      j.force = 10000;
      j.amplitude = 0.3;
      j.phase = 0.4 * i + arm;
      s.joints.push_back(j);
    }
  }
  return s;
}

RawScene raw_legs(double trunk, double leg, bool walking) {
  RawScene s;
  s.floor = true;
  s.parts = {{{0.6, 0.3, 0.16}, trunk, {{0, 0, 0.42}, quat_identity()}}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 hip((i & 1) != 0 ? 0.26 : -0.26, (i & 2) != 0 ? 0.19 : -0.19, 0.38);
    int last = 0;
    for (int k = 0; k < 3; ++k) {
      RawJoint j;
      j.parent = last;
      j.child = last = static_cast<int>(s.parts.size());
      j.position = hip - Vec3(0, 0, 0.17 * k);
      j.axis = {0, 1, 0};
      j.force = 10000;
      if (walking) {
        // diagonal legs move together; the ankle compensates hip and knee
        j.amplitude = k == 0 ? 0.25 : (k == 1 ? -0.3 : 0.05);
        j.frequency = 1;
        j.phase = i == 0 || i == 3 ? 0 : kPi;
      }
      const Vec3 size = k < 2 ? Vec3(0.06, 0.06, 0.17) : Vec3(0.1, 0.1, 0.04);
      s.parts.push_back({size, leg, {j.position - Vec3(0, 0, k < 2 ? 0.085 : 0.02), quat_identity()}});
      s.joints.push_back(j);
    }
  }
  return s;
}

RawScene raw_random_tree(unsigned seed, bool floor) {
  std::mt19937 generator(seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator()) / 4294967296.0);
  };
  const auto direction = [&] {
    const double x = draw(-1, 1);
    const double y = draw(-1, 1);
    return normalized(Vec3(x, y, draw(0.05, 1)));
  };
  RawScene s;
  s.floor = floor;
  const int count = 3 + static_cast<int>(generator() % 28);
  s.parts.push_back(
      {{0.1, 0.1, 0.2}, generator() % 2 == 0 ? 0 : fixed::pow(10, draw(-2, 2)), {{0, 0, 3}, quat_identity()}});
  const double force = fixed::pow(10, draw(-1, 4));
  const double speed = fixed::pow(10, draw(-0.5, 1.2));
  const double amplitude = draw(0.1, 1.2);
  for (int k = 1; k < count; ++k) {
    const int parent = generator() % 3 != 0 ? k - 1 : static_cast<int>(generator() % static_cast<unsigned>(k));
    const Vec3 offset = direction();
    const Vec3 from = s.parts[static_cast<std::size_t>(parent)].pose.position;
    const Quat turned = quat_axis(direction(), draw(0, 3));
    s.parts.push_back({{0.1, 0.1, 0.2}, fixed::pow(10, draw(-2, 2)), {from + offset * 0.2, turned}});
    RawJoint j;
    j.parent = parent;
    j.child = k;
    j.position = from + offset * 0.1;
    j.axis = direction();
    if (generator() % 3 == 0) {
      j.lower = -draw(0, 1.2);
      j.upper = draw(0, 1.2);
    }
    const unsigned drive = generator() % 4;
    if (drive != 0) {
      j.force = force;
      j.speed = speed;
      j.amplitude = amplitude;
      j.frequency = draw(0.2, 2);
      j.phase = draw(0, 6);
      j.square = drive == 3;
    }
    s.joints.push_back(j);
  }
  return s;
}

// Gravity across it: the arm falls and hits its limits.
RawScene raw_lying_arm(double limit) {
  RawScene s = raw_limited(raw_arm(17, 1, 0, 0, false), limit, false);
  s.gravity = {6.9, 3.1, -6.2};
  return s;
}

RawScene raw_arms(int count) {
  RawScene all;
  all.floor = true;
  const RawScene one = raw_arm(17, 1, 10000, 0.3, false);
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int k = 0; k < count; ++k) {
    const int row = k / side;
    const Vec3 shift(4.0 * (k % side), 4.0 * row, 0);
    const int first = static_cast<int>(all.parts.size());
    for (RawPart p : one.parts) {
      p.pose.position += shift;
      all.parts.push_back(p);
    }
    for (RawJoint j : one.joints) {
      j.parent += first;
      j.child += first;
      j.position += shift;
      all.joints.push_back(j);
    }
  }
  return all;
}

RawScene raw_gripper(double torque) {
  RawScene s;
  s.parts.push_back({{0.3, 0.3, 0.02}, 0, {{0, 0, 1.2}, quat_identity()}});
  const double radius = 0.06;
  for (int f = 0; f < 3; ++f) {
    const Quat around = quat_axis({0, 0, 1}, 2 * kPi / 3 * f);
    int last = 0;
    for (int k = 0; k < 2; ++k) {
      // straight down beside the ball, one millimeter away
      const Vec3 top = Vec3(0, 0, 1.18 - 0.08 * k) + around * Vec3(radius + 0.011, 0, 0);
      RawJoint j;
      j.parent = last;
      j.child = last = static_cast<int>(s.parts.size());
      j.position = top;
      j.axis = around * Vec3(0, 1, 0);
      j.force = torque;
      j.speed = 2;
      j.offset = k == 0 ? 0.15 : 0.25;  // inwards
      s.parts.push_back({{0.02, 0.03, 0.08}, 0.05, {top - Vec3(0, 0, 0.04), around}});
      s.joints.push_back(j);
    }
  }
  s.parts.push_back({{radius, 0, 0}, 0.2, {{0, 0, 1.08}, quat_identity()}});
  return s;
}

RawScene raw_clump(int creatures) {
  RawScene s;
  s.gravity = Vec3(0);
  s.self_collision = true;
  s.attraction = 4;
  const int side = static_cast<int>(std::ceil(fixed::cbrt(creatures)));
  for (int c = 0; c < creatures; ++c) {
    const Vec3 from = 0.8 * Vec3(c % side, c / side % side, c / (side * side)) - Vec3(0.4 * side, 0.4 * side, 0);
    const Quat turned = quat_axis(normalized(Vec3(1, 0.3 * c, 0.7)), 0.9 * c);
    const int first = static_cast<int>(s.parts.size());
    for (int k = 0; k < 6; ++k) {
      s.parts.push_back({{0.1, 0.1, 0.16}, 0.5, {from + turned * Vec3(0, 0, 0.2 * k), turned}});
      if (k == 0) continue;
      RawJoint j;
      j.parent = first + k - 1;
      j.child = first + k;
      j.position = from + turned * Vec3(0, 0, 0.2 * k - 0.1);
      j.axis = turned * (k % 2 == 0 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
      j.stiffness = 4;
      j.damping = 0.05;
      s.joints.push_back(j);
    }
  }
  return s;
}

RawScene raw_pile(int boxes) {
  constexpr int kLayer = 12;  // boxes per side
  RawScene s;
  s.floor = true;
  s.self_collision = true;
  for (int i = 0; i < boxes; ++i) {
    const int layer = i / (kLayer * kLayer);
    const int row = i / kLayer % kLayer;
    const Vec3 at(0.24 * (i % kLayer) + 0.05 * (layer % 3), 0.2 * row + 0.04 * (layer % 2), 0.08 + 0.14 * layer);
    s.parts.push_back({{0.2, 0.16, 0.12}, 1, {at, quat_axis(Vec3(0, 0, 1), 0.1 * (i % 7))}});
  }
  return s;
}

}  // namespace limber
