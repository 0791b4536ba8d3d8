// Interpolation: exact at both ends, linear, along arcs, or switched at 0.5.
#include "properties/interpolate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/vec.h"

namespace limber {
namespace {

using Values = std::array<double, 4>;

// A property with the fields that PropertyTable computes.
Property as_table_property(Property property) {
  return PropertyTable("toy", "/toy", "", {std::move(property)}).property(0);
}

Values mixed(const Property& property, const Values& a, const Values& b, double amount) {
  Values out{};
  mix(property, a.data(), b.data(), amount, out.data());
  return out;
}

TEST(Mix, EndsAreExactAndValuesMonotonic) {
  const Property property = as_table_property(properties::number("x", "", 0, -1e300, 1e300, "A number."));
  Random random(3, "mix");
  for (int i = 0; i < 2000; i++) {
    const double scale = std::pow(10, random.uniform(-12, 12));
    const Values a{random.uniform(-1, 1) * scale};
    const Values b{random.uniform(-1, 1) * scale};
    EXPECT_EQ(mixed(property, a, b, 0)[0], a[0]);
    EXPECT_EQ(mixed(property, a, b, 1)[0], b[0]);
    double last = a[0];
    for (int k = 1; k <= 64; k++) {
      const double v = mixed(property, a, b, k / 64.0)[0];
      EXPECT_TRUE(a[0] <= b[0] ? v >= last : v <= last) << a[0] << " to " << b[0] << " at " << k;
      last = v;
    }
    EXPECT_EQ(last, b[0]);
  }
}

TEST(Mix, HandlesOverflowOfTheDifference) {
  const Property property = as_table_property(properties::number("x", "", 0, -kUnbounded, kUnbounded, "A number."));
  EXPECT_EQ(mixed(property, {-1.5e308}, {1.5e308}, 0.5)[0], 0);
  EXPECT_NEAR(mixed(property, {-1.5e308}, {1.5e308}, 0.75)[0] / 7.5e307, 1, 1e-12);
}

TEST(Mix, DiscreteValuesSwitchAtHalf) {
  const Property flag = as_table_property(properties::boolean("b", false, "A truth."));
  const Property flags = as_table_property(properties::flags3("f", {}, "Truths."));
  const Property choice = as_table_property(properties::choice("c", {"one", "two", "three"}, 0, "A choice."));
  for (const double amount : {0.0, 0.2, 0.499999}) {
    EXPECT_EQ(mixed(flag, {0}, {1}, amount)[0], 0);
    EXPECT_EQ(mixed(flags, {1, 0, 1}, {0, 1, 1}, amount), (Values{1, 0, 1}));
    EXPECT_EQ(mixed(choice, {0}, {2}, amount)[0], 0) << "never the second choice";
  }
  for (const double amount : {0.5, 0.7, 1.0}) {
    EXPECT_EQ(mixed(flag, {0}, {1}, amount)[0], 1);
    EXPECT_EQ(mixed(flags, {1, 0, 1}, {0, 1, 1}, amount), (Values{0, 1, 1}));
    EXPECT_EQ(mixed(choice, {0}, {2}, amount)[0], 2);
  }
}

// Rotates about an axis by an angle, so that the intermediate rotation is known without another slerp.
TEST(Mix, RotationsFollowTheShorterArcAtConstantSpeed) {
  const Property property = as_table_property(properties::quat("q", "A rotation."));
  Random random(4, "mix");
  for (int i = 0; i < 500; i++) {
    const Vec3 axis = random.direction();
    const double angle = random.uniform(0.01, kPi - 0.01);
    const Quat from = quat_axis(random.direction(), random.uniform(0, 6));
    const Quat to = quat_axis(axis, angle) * from;
    Values a{};
    Values b{};
    put(a.data(), from);
    put(b.data(), -to);  // the same rotation with the opposite sign
    for (const double amount : {0.25, 0.5, 0.9}) {
      const Quat expected = quat_axis(axis, angle * amount) * from;
      const Quat got = quat_at(mixed(property, a, b, amount).data());
      EXPECT_NEAR(std::abs(glm::dot(expected, got)), 1, 1e-12);
      EXPECT_NEAR(glm::dot(got, got), 1, 1e-14);
    }
  }
}

// Rx·Ry·Rz, computed directly.
Mat3 turn(const Values& degrees) {
  const auto about = [](int axis, double angle) {
    const double c = std::cos(angle * kPi / 180);
    const double s = std::sin(angle * kPi / 180);
    Mat3 m(1);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    m[u][u] = c;
    m[v][v] = c;
    m[u][v] = s;
    m[v][u] = -s;
    return m;
  };
  return about(0, degrees[0]) * about(1, degrees[1]) * about(2, degrees[2]);
}

TEST(Mix, EulerAnglesInterpolateAsRotations) {
  const Property property =
      as_table_property(properties::euler_angles(properties::vec3("r", "deg", {}, -36000, 36000, "A turn.")));
  // About z from 170 to 190 degrees: through 180, not back through 0.
  const Values half = mixed(property, {-80, 0, 170}, {-80, 0, -170}, 0.5);
  const Mat3 expected = turn({-80, 0, 180});
  const Mat3 got = turn(half);
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) EXPECT_NEAR(got[i][k], expected[i][k], 1e-9);
  }
  EXPECT_EQ(mixed(property, {-80, 0, 170}, {-80, 0, -170}, 1), (Values{-80, 0, -170}));
  EXPECT_EQ(mixed(property, {-80, 0, 530}, {-80, 0, -170}, 0), (Values{-80, 0, 530}));
}

TEST(Mix, ResultsStayInTheRange) {
  const Property whole = as_table_property(properties::integer("n", 0, 0, 9, "A whole number."));
  EXPECT_EQ(mixed(whole, {0}, {9}, 0.3)[0], 3);
  EXPECT_EQ(mixed(whole, {9}, {0}, 0.3)[0], 6);
  // From 170 to -170 degrees about z, the arc passes 180, which is outside the range.
  const Property narrow =
      as_table_property(properties::euler_angles(properties::vec3("r", "deg", {}, -175, 175, "A turn.")));
  EXPECT_EQ(std::abs(mixed(narrow, {0, 0, 170}, {0, 0, -170}, 0.4)[2]), 175);
}

}  // namespace
}  // namespace limber
