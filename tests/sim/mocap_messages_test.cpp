// Messages of motion capture: words, values that are not valid, axes, and dialects.
#include "sim/mocap/mocap_messages.h"

#include <gtest/gtest.h>

#include <limits>

namespace limber::sim {
namespace {

MocapMessage compiled(const std::string& words, const std::string& address = "/a") {
  Result<MocapMessage> message = MocapMessage::compile({address, words});
  EXPECT_TRUE(message.ok()) << (message.ok() ? "" : message.error());
  return message.ok() ? *message : MocapMessage();
}
std::string compile_error(const std::string& words, const std::string& address = "/a") {
  const Result<MocapMessage> message = MocapMessage::compile({address, words});
  return message.ok() ? "" : message.error();
}
std::vector<Arg> args(std::initializer_list<double> numbers) {
  std::vector<Arg> list;
  for (const double number : numbers) list.push_back(Arg::of(number));
  return list;
}

TEST(MocapMessages, DecodeFlatListsJointByJoint) {
  const MocapMessage message = compiled("x y z");
  const std::vector<Arg> list = args({1, 2, 3, 4, 5, 6});
  ASSERT_EQ(message.count(list).value(), 2u);
  EXPECT_EQ(*message.decode(list, 1).position, Vec3(4, 5, 6));
  EXPECT_EQ(message.decode(list, 1).index, 1u);
  EXPECT_FALSE(message.decode(list, 1).rotation.has_value());
}

TEST(MocapMessages, DecodeQuaternionsInAnyOrderAndNormalizeThem) {
  const std::vector<Arg> list = args({2, 0, 0, 2});
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(compiled("qw qx qy qz").decode(list, 0).rotation->w, half, 1e-15);
  EXPECT_NEAR(compiled("qw qx qy qz").decode(list, 0).rotation->z, half, 1e-15);
  EXPECT_NEAR(compiled("qx qy qz qw").decode(list, 0).rotation->x, half, 1e-15);
}

TEST(MocapMessages, OmitValuesThatMarkAJointAsNotSeen) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MocapMessage message = compiled("x y z qw qx qy qz");
  const MocapSample lost = message.decode(args({1, nan, 3, 0, 0, 0, 0}), 0);
  EXPECT_FALSE(lost.position.has_value());
  EXPECT_FALSE(lost.rotation.has_value());
  EXPECT_FALSE(message.decode(args({1, 2e6, 3, 1, 0, 0, 0}), 0).position.has_value());
}

TEST(MocapMessages, NameJointsByAnArgumentOrInTheAddress) {
  const MocapMessage by_argument = compiled("joint x y z");
  std::vector<Arg> list = args({1, 2, 3});
  list.insert(list.begin(), Arg::of("hand"));
  list.push_back(Arg::of("more"));  // newer versions of a protocol append arguments
  ASSERT_EQ(by_argument.count(list).value(), 1u);
  EXPECT_EQ(by_argument.decode(list, 0).joint, "hand");
  const MocapMessage by_address = compiled("x y z", "/rigid/<joint>/pose");
  EXPECT_EQ(by_address.joint_in("/rigid/hat/pose"), "hat");
  EXPECT_EQ(by_address.joint_in("/rigid//pose"), "");
  EXPECT_EQ(by_address.joint_in("/rigid/a/b/pose"), "");
  EXPECT_EQ(by_address.joint_in("/other/hat/pose"), "");
}

TEST(MocapMessages, RejectArgumentsThatDoNotFit) {
  EXPECT_EQ(compiled("x y z").count(args({1, 2})).error(), "takes a multiple of 3 arguments, got 2");
  EXPECT_EQ(compiled("x y z").count({}).error(), "takes a multiple of 3 arguments, got 0");
  std::vector<Arg> list = args({1, 2, 3});
  list[1] = Arg::of("2");
  EXPECT_EQ(compiled("x y z").count(list).error(), "argument 2 must be a number");
  EXPECT_EQ(compiled("joint x y z").count(args({1, 2, 3, 4})).error(), "argument 1 must be a joint's name");
}

TEST(MocapMessages, RejectWordsThatMakeNoSense) {
  EXPECT_EQ(compile_error("x y"), "/a: 'x' needs all 3 words of its vector");
  EXPECT_EQ(compile_error("qw qx qy"), "/a: 'qw' needs all 4 words of its quaternion");
  EXPECT_EQ(compile_error("x y z x"), "/a: 'x' appears twice");
  EXPECT_EQ(compile_error("x y zz").substr(0, 27), "/a: there is no word 'zz'; ");
  EXPECT_EQ(compile_error("joint x y z", "/a/<joint>"),
            "/a/<joint>: the joint is named in the address and by an argument; remove one");
  EXPECT_EQ(compile_error("x y z", "a"), "'a' is not an OSC address; it starts with / and has at most 200 characters");
}

// A point and a rotation that moves another one to it give the same result before and after the conversion.
TEST(MocapAxes, KeepRotationsConsistentWithPoints) {
  for (const MocapAxes::Up up : {MocapAxes::Up::x, MocapAxes::Up::y, MocapAxes::Up::z}) {
    for (const bool left : {false, true}) {
      const MocapAxes axes{up, left, 0.01};
      Vec3 vertical(0);
      vertical[static_cast<int>(up)] = 100;
      EXPECT_EQ(axes.position(vertical), Vec3(0, 0, 1));
      const Vec3 point(1, -2, 3);
      const Vec3 axis = normalized({3, 1, -2});
      // a left-handed system counts angles the other way: its rotation matrix is that of the negated angle
      const Quat q = quat_axis(axis, 0.7);
      const Vec3 turned = q * point;
      const Vec3 converted = axes.rotation(q) * axes.direction(point);
      EXPECT_LT(glm::length(converted - axes.direction(turned)), 1e-14) << static_cast<int>(up) << left;
      const double volume =
          glm::dot(glm::cross(axes.direction({1, 0, 0}), axes.direction({0, 1, 0})), axes.direction({0, 0, 1}));
      EXPECT_EQ(volume, left ? -1 : 1);
    }
  }
}

TEST(MocapDialects, HaveTheAddressesOfTheirSenders) {
  MocapSetup setup;
  ASSERT_TRUE(set_mocap_dialect(setup, "osc", "3", true).ok());
  EXPECT_EQ(setup.messages.front().address, "/mocap/3/joint/pos_world");
  MocapSetup vmc;
  ASSERT_TRUE(set_mocap_dialect(vmc, "vmc", "", true).ok());
  EXPECT_EQ(vmc.bones.size(), 55u);
  EXPECT_EQ(set_mocap_dialect(vmc, "pns", "", true).error().substr(0, 27), "there is no dialect 'pns'; ");
}

}  // namespace
}  // namespace limber::sim
