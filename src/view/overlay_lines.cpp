// Symbols: each kind has a form of its own, and a colour beside it.
#include "view/overlay_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber {

namespace {

constexpr double kTurn = 2 * kPi;
constexpr double kMostWeights = 4;  // an arrow's length, in sizes of the part
constexpr double kLeastWeights = 0.02;

using Kind = OverlayMark::Kind;

// linear, in the order of kinds: amber, amber, white, green, red, blue
const std::array<glm::vec3, 6> kPaints = {{{1.0F, 0.42F, 0.03F},
                                           {1.0F, 0.42F, 0.03F},
                                           {0.9F, 0.9F, 0.9F},
                                           {0.10F, 0.85F, 0.18F},
                                           {1.0F, 0.06F, 0.10F},
                                           {0.08F, 0.45F, 1.0F}}};

Vec3 axis_of(const OverlayMark& mark, int further) {
  Vec3 axis(0);
  axis[(mark.axis + further) % 3] = 1;
  return mark.turn * axis;
}

OverlayMark between(const OverlayMark& before, const OverlayMark& now, double mix) {
  OverlayMark mark = now;
  mark.at = glm::mix(before.at, now.at, mix);
  mark.vector = glm::mix(before.vector, now.vector, mix);
  mark.turn = glm::slerp(before.turn, now.turn, mix);
  mark.value = glm::mix(before.value, now.value, mix);
  return mark;
}

// contacts come and go between two ticks, and are nobody's
bool goes_on(const OverlayMark& before, const OverlayMark& now) {
  return before.kind == now.kind && before.slot == now.slot && before.axis == now.axis && now.kind != Kind::contact;
}

}  // namespace

void OverlayLines::line(const Vec3& from, const Vec3& to, double wide) {
  const glm::vec3 a(from);
  const glm::vec3 b(to);
  lines_.push_back(
      {{a.x, a.y, a.z}, static_cast<float>(width_ * wide), {b.x, b.y, b.z}, 0, {paint_.x, paint_.y, paint_.z, 1}});
}

void OverlayLines::cross(const Vec3& at, const Quat& turn, double half) {
  for (const Vec3& axis : {Vec3(half, 0, 0), Vec3(0, half, 0), Vec3(0, 0, half)})
    line(at - turn * axis, at + turn * axis);
}

void OverlayLines::arrow(const Vec3& from, const Vec3& way, double head) {
  const Vec3 to = from + way;
  line(from, to, 1.5);
  const double length = glm::length(way);
  if (length <= 0) return;
  const Vec3 along = way / length;
  const Vec3 any = std::abs(along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 side = glm::normalize(glm::cross(along, any));
  const Vec3 up = glm::cross(side, along);
  const double size = std::min(head, 0.5 * length);
  for (const Vec3& out : {side, -side, up, -up}) line(to, to - along * size + out * (0.4 * size), 1.5);
}

// from the x axis towards the y axis, rad
void OverlayLines::arc(const Vec3& at, const Vec3& x, const Vec3& y, double low, double high) {
  const int count = std::clamp(static_cast<int>(std::ceil((high - low) / kTurn * 32)), 1, 32);
  const auto point = [&](int i) {
    const double angle = low + (high - low) * i / count;
    return at + x * std::cos(angle) + y * std::sin(angle);
  };
  for (int i = 0; i < count; i++) line(point(i), point(i + 1));
}

// the axis, a fan between the limits or a ring, and a spoke where it stands
void OverlayLines::turn(const OverlayMark& mark) {
  const double size = 0.8 * mark.reach;
  const Vec3 axis = axis_of(mark, 0);
  const Vec3 x = axis_of(mark, 1) * size;
  const Vec3 y = axis_of(mark, 2) * size;
  line(mark.at - axis * (1.2 * size), mark.at + axis * (1.2 * size), 1.5);
  const auto spoke = [&](double angle, double wide) {
    line(mark.at, mark.at + x * std::cos(angle) + y * std::sin(angle), wide);
  };
  const bool part = mark.limited && mark.high - mark.low < kTurn;
  arc(mark.at, x, y, part ? mark.low : 0, part ? mark.high : kTurn);
  if (part) {
    spoke(mark.low, 1);
    spoke(mark.high, 1);
  }
  spoke(mark.value, 2);
}

// the way with a bar at each limit, and a bar twice as long where it stands; without limits an arrow's length of it
void OverlayLines::shift(const OverlayMark& mark) {
  const Vec3 axis = axis_of(mark, 0);
  const Vec3 side = axis_of(mark, 1) * (0.3 * mark.reach);
  const double low = mark.limited ? mark.low : mark.value - mark.reach;
  const double high = mark.limited ? mark.high : mark.value + mark.reach;
  line(mark.at + axis * low, mark.at + axis * high, 1.5);
  const auto bar = [&](double at, double long_by, double wide) {
    line(mark.at + axis * at - side * long_by, mark.at + axis * at + side * long_by, wide);
  };
  if (mark.limited) {
    bar(low, 1, 1);
    bar(high, 1, 1);
  }
  bar(mark.value, 2, 2);
}

void OverlayLines::draw(const OverlayMark& mark) {
  paint_ = kPaints[static_cast<std::size_t>(mark.kind)];
  const double reach = mark.reach;
  switch (mark.kind) {
    case Kind::turn:
      return turn(mark);
    case Kind::shift:
      return shift(mark);
    case Kind::center:
      return cross(mark.at, mark.turn, 0.3 * reach);
    case Kind::target:
      cross(mark.at, quat_identity(), reach);
      return arc(mark.at, {0.6 * reach, 0, 0}, {0, 0.6 * reach, 0}, 0, kTurn);
    case Kind::contact:
      arc(mark.at, {0.15 * reach, 0, 0}, {0, 0.15 * reach, 0}, 0, kTurn);
      break;
    case Kind::force:
      break;
  }
  const double length = glm::length(mark.vector);
  if (!(length > kLeastWeights) || !std::isfinite(length)) return;
  arrow(mark.at, mark.vector * (reach * std::min(1.0, kMostWeights / length)), 0.4 * reach);
}

void OverlayLines::gather(const Snapshot& before, const Snapshot& now, double mix, double pixels) {
  lines_.clear();
  width_ = pixels;
  const std::vector<OverlayMark>& old = before.overlay;
  for (std::size_t i = 0; i < now.overlay.size(); i++) {
    const OverlayMark& mark = now.overlay[i];
    draw(mix < 1 && i < old.size() && goes_on(old[i], mark) ? between(old[i], mark, mix) : mark);
  }
}

}  // namespace limber
