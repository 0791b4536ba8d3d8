// Straight lines, arcs and switches.
#include "params/mix.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/vec.h"

namespace limber {

namespace {

double between(double a, double b, double amount) {
  const double way = b - a;
  // ends that lie further apart than a double reaches
  const double v = std::isfinite(way) ? a + way * amount : a * (1 - amount) + b * amount;
  return std::clamp(v, std::min(a, b), std::max(a, b));
}

Quat arc(const Quat& a, const Quat& b, double amount) { return slerp(a, b, amount); }

// Rx·Ry·Rz, degrees
Quat turn_of(const double* v) {
  const Vec3 r = vec3_at(v) * (kPi / 180);
  return quat_axis({1, 0, 0}, r.x) * quat_axis({0, 1, 0}, r.y) * quat_axis({0, 0, 1}, r.z);
}

// Rx·Ry·Rz transposed is Rz·Ry·Rx of the angles turned round
Vec3 degrees_of(const Quat& q) { return euler_of(glm::conjugate(q)) * (-180 / kPi); }

// an arc may leave the range that both its ends keep
void bound(const Row& row, double* out) {
  for (std::uint32_t i = 0; i < row.width; i++) out[i] = std::clamp(out[i], row.low(i), row.high(i));
}

}  // namespace

void mix(const Row& row, const double* a, const double* b, double amount, double* out) {
  const bool at_a = amount <= 0;
  const bool at_b = amount >= 1;
  const bool switches = row.type == RowType::boolean || row.type == RowType::flags3 || row.type == RowType::choice;
  if (at_a || at_b || switches) {
    std::copy_n(amount < 0.5 ? a : b, row.width, out);
  } else if (row.type == RowType::quat) {
    put(out, arc(quat_at(a), quat_at(b), amount));
    bound(row, out);
  } else if (row.turns) {
    put(out, degrees_of(arc(turn_of(a), turn_of(b), amount)));
    bound(row, out);
  } else {
    for (std::uint32_t i = 0; i < row.width; i++) out[i] = between(a[i], b[i], amount);
    if (row.type == RowType::integer) out[0] = std::round(out[0]);
  }
}

}  // namespace limber
