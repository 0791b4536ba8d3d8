// Interpolates numbers linearly and rotations along arcs; switches discrete values.
#include "properties/interpolate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/vec.h"

namespace limber {

namespace {

double lerp(double a, double b, double amount) {
  const double difference = b - a;
  // The other formula if b - a overflows.
  const double v = std::isfinite(difference) ? a + difference * amount : a * (1 - amount) + b * amount;
  return std::clamp(v, std::min(a, b), std::max(a, b));
}

Quat arc(const Quat& a, const Quat& b, double amount) { return slerp(a, b, amount); }

// The rotation Rx·Ry·Rz of Euler angles in degrees.
Quat rotation_of_degrees(const double* v) {
  const Vec3 r = vec3_at(v) * (kPi / 180);
  return quat_axis({1, 0, 0}, r.x) * quat_axis({0, 1, 0}, r.y) * quat_axis({0, 0, 1}, r.z);
}

// The transpose of Rx·Ry·Rz is Rz·Ry·Rx of the negated angles.
Vec3 degrees_of_rotation(const Quat& q) { return euler_of(glm::conjugate(q)) * (-180 / kPi); }

// An arc between two values within the range may leave the range.
void clamp_to_range(const Property& property, double* out) {
  for (std::uint32_t i = 0; i < property.width; i++) out[i] = std::clamp(out[i], property.low(i), property.high(i));
}

}  // namespace

void mix(const Property& property, const double* a, const double* b, double amount, double* out) {
  const bool at_a = amount <= 0;
  const bool at_b = amount >= 1;
  const bool is_discrete = property.type == PropertyType::boolean || property.type == PropertyType::flags3 ||
                           property.type == PropertyType::choice;
  if (at_a || at_b || is_discrete) {
    std::copy_n(amount < 0.5 ? a : b, property.width, out);
  } else if (property.type == PropertyType::quat) {
    put(out, arc(quat_at(a), quat_at(b), amount));
    clamp_to_range(property, out);
  } else if (property.euler) {
    put(out, degrees_of_rotation(arc(rotation_of_degrees(a), rotation_of_degrees(b), amount)));
    clamp_to_range(property, out);
  } else {
    for (std::uint32_t i = 0; i < property.width; i++) out[i] = lerp(a[i], b[i], amount);
    if (property.type == PropertyType::integer) out[0] = std::round(out[0]);
  }
}

}  // namespace limber
