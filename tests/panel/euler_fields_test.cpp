// Euler angles beside a quaternion, compared with the product of three rotation matrices.
#include "ui/panel/widgets/euler_fields.h"

#include <array>
#include <cmath>
#include <random>

#include "panel/drawn_text.h"
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; i++) {
    for (std::size_t j = 0; j < 3; j++) {
      for (std::size_t k = 0; k < 3; k++) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

// The rotation about the fixed axes x, then y, then z.
Matrix matrix_of_degrees(double x, double y, double z) {
  const auto c = [](double degrees) { return std::cos(degrees * std::acos(-1) / 180); };
  const auto s = [](double degrees) { return std::sin(degrees * std::acos(-1) / 180); };
  const Matrix about_x{{{1, 0, 0}, {0, c(x), -s(x)}, {0, s(x), c(x)}}};
  const Matrix about_y{{{c(y), 0, s(y)}, {0, 1, 0}, {-s(y), 0, c(y)}}};
  const Matrix about_z{{{c(z), -s(z), 0}, {s(z), c(z), 0}, {0, 0, 1}}};
  return product(about_z, product(about_y, about_x));
}

// The matrix of a quaternion x y z w.
Matrix matrix_of_quaternion(const double* q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

double difference(const Matrix& a, const Matrix& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; i++) {
    for (std::size_t j = 0; j < 3; j++) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  }
  return largest;
}

TEST(EulerFields, AnglesGiveTheSameRotation) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; i++) {
    double q[4];
    double sum = 0;
    for (double& v : q) {
      v = normal(random);
      sum += v * v;
    }
    for (double& v : q) v /= std::sqrt(sum);
    const Vec3 degrees = degrees_of(q);
    EXPECT_LT(difference(matrix_of_degrees(degrees.x, degrees.y, degrees.z), matrix_of_quaternion(q)), 1e-9);
    EXPECT_LE(std::abs(degrees.x), 180);
    EXPECT_LE(std::abs(degrees.y), 90);
    EXPECT_LE(std::abs(degrees.z), 180);
  }
}

TEST(EulerFields, ConvertsAnglesOfEveryQuadrant) {
  for (double x = -180; x <= 180; x += 30) {
    for (double y = -90; y <= 90; y += 15) {
      for (double z = -180; z <= 180; z += 30) {
        double q[4];
        put_degrees({x, y, z}, q);
        EXPECT_LT(difference(matrix_of_degrees(x, y, z), matrix_of_quaternion(q)), 1e-12) << x << " " << y << " " << z;
        const Vec3 back = degrees_of(q);
        EXPECT_LT(difference(matrix_of_degrees(back.x, back.y, back.z), matrix_of_quaternion(q)), 1e-6)
            << x << " " << y << " " << z;
        if (std::abs(y) == 90) {
          EXPECT_EQ(back.z, 0) << "gimbal lock";
          EXPECT_NEAR(back.y, y, 1e-5);
        }
      }
    }
  }
}

constexpr double kHeight = 5000;  // all properties are visible
const std::string kRotation = "/physics/body/arm/part/tip/rotation";

TEST(EulerFields, ShowAndSetTheRotation) {
  PanelFixture fixture(kScene, 1280, kHeight);
  fixture.show.send("/physics/body/arm/motor/hinge/mode", "off");
  double q[4];
  put_degrees({30, -45, 120}, q);
  fixture.show.send(kRotation, q[0], q[1], q[2], q[3]);
  fixture.gui->context().selected = "/physics/body/arm/part/tip";
  fixture.sync();
  fixture.sync();
  const DrawnText drawn;
  EXPECT_EQ(drawn.in(fixture.rect_of("name:euler:" + kRotation)), "Euler angles");
  for (const auto& [i, expected] : {std::pair(0, 30.0), {1, -45.0}, {2, 120.0}})
    EXPECT_NEAR(std::stod(drawn.in(fixture.rect_of("euler:" + kRotation + "/" + std::to_string(i)))), expected, 0.01);
  fixture.click("euler:" + kRotation + "/0", 0, kCtrl);
  fixture.key(GuiKey::a, kCtrl);
  fixture.type("60");
  fixture.key(GuiKey::enter);
  double read[4];
  for (std::size_t i = 0; i < 4; i++) read[i] = fixture.read(kRotation, i);
  EXPECT_LT(difference(matrix_of_degrees(60, -45, 120), matrix_of_quaternion(read)), 1e-5);
}

}  // namespace
}  // namespace limber::panel::test
