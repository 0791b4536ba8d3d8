// The symbols of the debug overlay; each kind has its own shape and color.
#include "ui/render/overlay_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber::render {

namespace {

constexpr double kTurn = 2 * kPi;
constexpr double kMaxWeights =
    4;  // force of the longest arrow, in weights of the part; the arrow of one weight has the length OverlayMark::size
constexpr double kMinWeights = 0.02;

using Kind = sim::OverlayMark::Kind;

// linear, in the order of kinds: amber, amber, white, green, red, blue
const std::array<glm::vec3, 6> kColors = {{{1.0F, 0.42F, 0.03F},
                                           {1.0F, 0.42F, 0.03F},
                                           {0.9F, 0.9F, 0.9F},
                                           {0.10F, 0.85F, 0.18F},
                                           {1.0F, 0.06F, 0.10F},
                                           {0.08F, 0.45F, 1.0F}}};

Vec3 axis_of(const sim::OverlayMark& mark, int offset) {
  Vec3 axis(0);
  axis[(mark.axis + offset) % 3] = 1;
  return mark.rotation * axis;
}

sim::OverlayMark interpolate(const sim::OverlayMark& previous, const sim::OverlayMark& current, double mix) {
  sim::OverlayMark mark = current;
  mark.position = glm::mix(previous.position, current.position, mix);
  mark.vector = glm::mix(previous.vector, current.vector, mix);
  mark.rotation = glm::slerp(previous.rotation, current.rotation, mix);
  mark.value = glm::mix(previous.value, current.value, mix);
  return mark;
}

// true if both are the same mark; contacts have no identity across ticks
bool is_same_mark(const sim::OverlayMark& previous, const sim::OverlayMark& current) {
  return previous.kind == current.kind && previous.slot == current.slot && previous.axis == current.axis &&
         current.kind != Kind::contact;
}

}  // namespace

void OverlayLines::line(const Vec3& from, const Vec3& to, double width) {
  const glm::vec3 a(from);
  const glm::vec3 b(to);
  lines_.push_back(
      {{a.x, a.y, a.z}, static_cast<float>(width_ * width), {b.x, b.y, b.z}, 0, {color_.x, color_.y, color_.z, 1}});
}

void OverlayLines::cross(const Vec3& at, const Quat& rotation, double half) {
  for (const Vec3& axis : {Vec3(half, 0, 0), Vec3(0, half, 0), Vec3(0, 0, half)})
    line(at - rotation * axis, at + rotation * axis);
}

void OverlayLines::arrow(const Vec3& from, const Vec3& vector, double head) {
  const Vec3 to = from + vector;
  line(from, to, 1.5);
  const double length = glm::length(vector);
  if (length <= 0) return;
  const Vec3 along = vector / length;
  const Vec3 any = std::abs(along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 side = glm::normalize(glm::cross(along, any));
  const Vec3 up = glm::cross(side, along);
  const double size = std::min(head, 0.5 * length);
  for (const Vec3& out : {side, -side, up, -up}) line(to, to - along * size + out * (0.4 * size), 1.5);
}

// an arc from the x axis towards the y axis; angles in rad
void OverlayLines::arc(const Vec3& at, const Vec3& x, const Vec3& y, double low, double high) {
  const int count = std::clamp(static_cast<int>(std::ceil((high - low) / kTurn * 32)), 1, 32);
  const auto point = [&](int i) {
    const double angle = low + (high - low) * i / count;
    return at + x * std::cos(angle) + y * std::sin(angle);
  };
  for (int i = 0; i < count; i++) line(point(i), point(i + 1));
}

// a hinge: its axis, an arc between the limits or a circle, and a spoke at the current angle
void OverlayLines::hinge(const sim::OverlayMark& mark) {
  const double size = 0.8 * mark.size;
  const Vec3 axis = axis_of(mark, 0);
  const Vec3 x = axis_of(mark, 1) * size;
  const Vec3 y = axis_of(mark, 2) * size;
  line(mark.position - axis * (1.2 * size), mark.position + axis * (1.2 * size), 1.5);
  const auto spoke = [&](double angle, double width) {
    line(mark.position, mark.position + x * std::cos(angle) + y * std::sin(angle), width);
  };
  const bool part = mark.limited && mark.upper - mark.lower < kTurn;
  arc(mark.position, x, y, part ? mark.lower : 0, part ? mark.upper : kTurn);
  if (part) {
    spoke(mark.lower, 1);
    spoke(mark.upper, 1);
  }
  spoke(mark.value, 2);
}

// a slider: a line along its range with a bar at each limit and a longer bar at the current position; without limits, a
// line around the position
void OverlayLines::slider(const sim::OverlayMark& mark) {
  const Vec3 axis = axis_of(mark, 0);
  const Vec3 side = axis_of(mark, 1) * (0.3 * mark.size);
  const double low = mark.limited ? mark.lower : mark.value - mark.size;
  const double high = mark.limited ? mark.upper : mark.value + mark.size;
  line(mark.position + axis * low, mark.position + axis * high, 1.5);
  const auto bar = [&](double at, double half_length, double width) {
    line(mark.position + axis * at - side * half_length, mark.position + axis * at + side * half_length, width);
  };
  if (mark.limited) {
    bar(low, 1, 1);
    bar(high, 1, 1);
  }
  bar(mark.value, 2, 2);
}

void OverlayLines::draw(const sim::OverlayMark& mark) {
  color_ = kColors[static_cast<std::size_t>(mark.kind)];
  const double size = mark.size;
  switch (mark.kind) {
    case Kind::rotation_axis:
      return hinge(mark);
    case Kind::translation_axis:
      return slider(mark);
    case Kind::center:
      return cross(mark.position, mark.rotation, 0.3 * size);
    case Kind::target:
      cross(mark.position, quat_identity(), size);
      return arc(mark.position, {0.6 * size, 0, 0}, {0, 0.6 * size, 0}, 0, kTurn);
    case Kind::contact:
      arc(mark.position, {0.15 * size, 0, 0}, {0, 0.15 * size, 0}, 0, kTurn);
      break;
    case Kind::force:
      break;
  }
  const double length = glm::length(mark.vector);
  if (!(length > kMinWeights) || !std::isfinite(length)) return;
  arrow(mark.position, mark.vector * (size * std::min(1.0, kMaxWeights / length)), 0.4 * size);
}

void OverlayLines::update(const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                          double pixels) {
  lines_.clear();
  width_ = pixels;
  const std::vector<sim::OverlayMark>& old = previous.overlay;
  for (std::size_t i = 0; i < current.overlay.size(); i++) {
    const sim::OverlayMark& mark = current.overlay[i];
    draw(mix < 1 && i < old.size() && is_same_mark(old[i], mark) ? interpolate(old[i], mark, mix) : mark);
  }
}

}  // namespace limber::render
