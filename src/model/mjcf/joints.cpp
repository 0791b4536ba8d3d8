// Joints: type, axis, limits, passive forces.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxJointsOfBody = 6;
constexpr double kMaxForce = 1e9;
constexpr double kMaxStiffness = 1e6;
constexpr double kMaxArmature = 1e6;
constexpr double kMinBallAngle = 0.01;  // rad
constexpr double kMaxBound = 1e4;       // limits beyond this mean none

std::optional<JointType> joint_type_of(std::string_view text) {
  if (text == "hinge") return JointType::revolute;
  if (text == "slide") return JointType::prismatic;
  if (text == "ball") return JointType::spherical;
  return {};
}

void read_free_joint(MjcfReader& reader, const MjcfElement& element, MjcfBody& body) {
  if (body.parent != 0 || !body.joints.empty() || body.free) {
    reader.error(
        element,
        fmt::format("{} ignored: a free joint must be the only joint of a top-level body", reader.shown(element)),
        "Move the body into <worldbody>, and remove its other joints.");
    return;
  }
  body.free = true;
}

// Limits the angle of the whole rotation to the larger number, as MuJoCo does.
void read_ball_range(MjcfReader& reader, const MjcfElement& element, MjcfClass cls, MjcfJoint& joint) {
  const std::vector<double> range = reader.numbers(element, cls, "range", 2, 2);
  if (range.empty()) return;
  const double angle = std::max(range[0], range[1]) * (reader.compiler.degrees ? kPi / 180 : 1);
  if (!(angle > 0)) {
    reader.error(element,
                 fmt::format("{}: range {:g} {:g} can't be a limit; the joint is free", reader.shown(element), range[0],
                             range[1]),
                 "Write range=\"0 angle\" with the largest angle of the rotation.");
    return;
  }
  joint.largest_angle = std::clamp(angle, kMinBallAngle, kPi);
  if (angle < kMinBallAngle) {
    reader.warning(
        element,
        fmt::format("{}: the largest angle is {:.3g} rad; using {:g} rad", reader.shown(element), angle, kMinBallAngle),
        "To lock the rotation, remove the joint.");
  }
}

}  // namespace

void MjcfFileReader::read_joint(const MjcfElement& element, MjcfBody& body, MjcfClass inherited, const Pose& frame) {
  reader_.check_attributes(element);
  const MjcfClass cls = reader_.class_of(element, inherited);
  const std::string* const written = reader_.text(element, cls, "type");
  if (element.name == "freejoint" || (written != nullptr && *written == "free"))
    return read_free_joint(reader_, element, body);
  MjcfJoint joint;
  joint.line = reader_.line_of(element);
  const std::optional<JointType> type = joint_type_of(written == nullptr ? "hinge" : *written);
  if (!type) {
    reader_.error(
        element,
        fmt::format("{}: '{}' is not a joint type; ignored", reader_.shown(element), printable_excerpt(*written)),
        "Use hinge, slide, ball or free.");
    return;
  }
  if (body.free || body.joints.size() >= kMaxJointsOfBody) {
    reader_.error(element,
                  fmt::format("{} ignored: {}", reader_.shown(element),
                              body.free ? "its body has a free joint" : "its body has six joints already"),
                  "Remove it.");
    return;
  }
  joint.type = *type;
  joint.name = reader_.name(element);
  joint.anchor = frame * reader_.vector(element, cls, "pos").value_or(Vec3(0));
  const Vec3 axis = reader_.vector(element, cls, "axis").value_or(Vec3(0, 0, 1));
  joint.axis = normalized(frame.rotation * axis);
  if (glm::length(joint.axis) < 0.5) {
    reader_.error(element, fmt::format("{}: axis 0 0 0 is not a direction; using 0 0 1", reader_.shown(element)),
                  "Write axis=\"x y z\", a direction in the body's frame.");
    joint.axis = frame.rotation * Vec3(0, 0, 1);
  }
  read_limits(element, cls, joint);
  read_passive_forces(element, cls, joint);
  body.joints.push_back(std::move(joint));
}

void MjcfFileReader::read_limits(const MjcfElement& element, MjcfClass cls, MjcfJoint& joint) {
  const bool limited = reader_.limited(element, cls, "limited", "range");
  if (joint.type == JointType::spherical) {
    if (limited) read_ball_range(reader_, element, cls, joint);
    return;
  }
  const double unit = joint.type == JointType::revolute && reader_.compiler.degrees ? kPi / 180 : 1;
  joint.reference = reader_.number(element, cls, "ref", 0) * unit;
  if (std::abs(joint.reference) > kMaxBound) joint.reference = 0;
  if (joint.reference != 0) {
    reader_.unsupported(element, "<joint ref>: values are counted from the home pose, limits are shifted by -ref",
                        "Subtract ref from MuJoCo's joint values.");
  }
  const std::vector<double> range = reader_.numbers(element, cls, "range", 2, 2);
  if (!limited || range.empty()) return;
  joint.lower = range[0] * unit;
  joint.upper = range[1] * unit;
  joint.limited =
      joint.lower <= joint.upper && std::abs(joint.lower) <= kMaxBound && std::abs(joint.upper) <= kMaxBound;
  if (!joint.limited) {
    reader_.error(element,
                  fmt::format("{}: range {:g} {:g} can't be a limit; the joint is free", reader_.shown(element),
                              range[0], range[1]),
                  "Write range=\"lower upper\".");
  }
}

void MjcfFileReader::read_spring(const MjcfElement& element, MjcfClass cls, double stiffness, MjcfJoint& joint) {
  if (stiffness <= 0) return;
  if (joint.type == JointType::spherical) {
    reader_.unsupported(element, "stiffness of a ball joint ignored: the joint has no spring",
                        "Set the springs of its motor in the scene.", Severity::warning);
    return;
  }
  const double unit = joint.type == JointType::revolute && reader_.compiler.degrees ? kPi / 180 : 1;
  joint.spring.stiffness = std::min(stiffness, kMaxStiffness);
  joint.spring.rest =
      std::clamp(reader_.number(element, cls, "springref", 0) * unit - joint.reference, -kMaxBound, kMaxBound);
}

void MjcfFileReader::read_passive_forces(const MjcfElement& element, MjcfClass cls, MjcfJoint& joint) {
  // MuJoCo 3 has coefficients of powers as second and third numbers
  const auto first_of = [&](const char* attribute) {
    const std::vector<double> read = reader_.numbers(element, cls, attribute, 1, 3);
    return read.empty() ? 0.0 : read[0];
  };
  joint.damping = std::clamp(first_of("damping"), 0.0, kMaxForce);
  joint.friction = std::clamp(reader_.number(element, cls, "frictionloss", 0), 0.0, kMaxForce);
  read_spring(element, cls, first_of("stiffness"), joint);
  if (reader_.text(element, cls, "springdamper") != nullptr) {
    reader_.unsupported(element, "<joint springdamper> ignored: the joint has no spring",
                        "Set the motor's mode to \"spring\" in the scene.", Severity::warning);
  }
  joint.armature = std::clamp(reader_.number(element, cls, "armature", 0), 0.0, kMaxArmature);
  if (joint.type == JointType::spherical && joint.armature > 0) {
    reader_.unsupported(element, "armature of a ball joint ignored: it moves as if its rotors had no inertia",
                        "Nothing to do.");
  }
  if (reader_.limited(element, cls, "actuatorfrclimited", "actuatorfrcrange")) {
    const std::vector<double> range = reader_.numbers(element, cls, "actuatorfrcrange", 2, 2);
    if (!range.empty()) joint.largest_effort = std::min(std::max(std::abs(range[0]), std::abs(range[1])), kMaxForce);
  }
}

}  // namespace limber::model
