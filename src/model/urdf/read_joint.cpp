// Joints of a URDF: type, axis, limits, dynamics, mimic.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/urdf/reader.h"

namespace limber::model {

namespace {

struct TypeName {
  JointType type;
  std::string_view name;
};
constexpr std::array<TypeName, 8> kTypeNames{{{JointType::fixed, "fixed"},
                                              {JointType::revolute, "revolute"},
                                              {JointType::continuous, "continuous"},
                                              {JointType::prismatic, "prismatic"},
                                              {JointType::planar, "planar"},
                                              {JointType::floating, "floating"},
                                              {JointType::spherical, "spherical"},
                                              {JointType::spherical, "ball"}}};

constexpr NumberRange kForceRange{0, 1e9, "from 0 to 1e9 (N·m or N)"};
constexpr NumberRange kSpeedRange{0, 1e9, "from 0 to 1e9 (rad/s or m/s)"};
constexpr NumberRange kDampingRange{0, 1e9, "from 0 to 1e9"};
constexpr NumberRange kConeRange{0.01, kPi, "from 0.01 to π"};
constexpr NumberRange kTwistRange{-kPi, kPi, "within π"};
constexpr NumberRange kBoundRange{-1e300, 1e300, "in radians or meters"};
constexpr NumberRange kFactorRange{-1e6, 1e6, "within 1e6"};
constexpr NumberRange kAxisRange{-1e300, 1e300, "as the components of a direction"};
// some tools write limits beyond this to mean "none"
constexpr double kNoBound = 1e4;

bool is_hinge_or_slide(JointType type) {
  return type == JointType::revolute || type == JointType::continuous || type == JointType::prismatic;
}

const char* or_continuous_hint(JointType type) {
  return type == JointType::revolute ? ", or use type continuous." : ".";
}

}  // namespace

std::optional<UrdfJoint> UrdfReader::joint(const Element& element, const std::string& name) {
  UrdfJoint out;
  out.name = name;
  out.line = element.GetLineNum();
  const std::string owner = fmt::format("joint '{}'", printable(name));
  for (const char* side : {"parent", "child"}) {
    const Element* found = unique_child(element, side, owner);
    const char* link = found ? found->Attribute("link") : nullptr;
    if (found) check_attributes(*found, {"link"});
    if (!link || !*link) {
      problems.error(out.line, fmt::format("{} names no {} link; ignored", owner, side),
                     fmt::format("Write <{} link=\"…\"/> inside the joint.", side));
      return std::nullopt;
    }
    (std::string_view(side) == "parent" ? out.parent : out.child) = link;
  }
  check_attributes(element, {"name", "type"});
  out.type = joint_type(element, owner);
  out.origin = origin(element, owner);
  const bool has_axis = out.type != JointType::fixed && out.type != JointType::floating;
  if (out.type == JointType::spherical) {
    spherical(element, owner, out);
  } else if (has_axis) {
    out.axis = axis(element, owner);
  }
  if (is_hinge_or_slide(out.type)) {
    limit(element, owner, out);
    out.mimic = mimic(element, owner);
  } else if (const std::optional<UrdfMimic> ignored = mimic(element, owner)) {
    problems.error(ignored->line,
                   fmt::format("{}: is {} and can't follow '{}'; its <mimic> is ignored", owner,
                               joint_type_name(out.type), printable(ignored->joint)),
                   "Make it revolute, continuous or prismatic, or remove the <mimic>.");
  }
  dynamics(element, owner, out);
  return out;
}

void UrdfReader::spherical(const Element& element, const std::string& owner, UrdfJoint& out) {
  out.axis = Vec3(0, 0, 1);
  out.driven = false;
  const Element* found = unique_child(element, "limit", owner);
  if (!found) return;
  check_attributes(*found, {"cone", "twist_lower", "twist_upper", "rotation", "lower", "upper", "effort", "velocity"});
  ball_limits(*found, owner, out.ball);
  if (!found->Attribute("lower") && !found->Attribute("upper")) return;
  problems.warning(found->GetLineNum(),
                   fmt::format("{}: the limits of a spherical joint are ignored: it has no single angle", owner),
                   "Write cone=, twist_lower= and twist_upper=, or rotation=, in radians.");
}

// Attributes of <limit> that extend URDF.
void UrdfReader::ball_limits(const Element& limit, const std::string& owner, BallLimitsModel& out) {
  out.cone = number(limit, "cone", owner, kConeRange).value_or(out.cone);
  out.angle = number(limit, "rotation", owner, kConeRange).value_or(out.angle);
  const std::optional<double> lower = number(limit, "twist_lower", owner, kTwistRange);
  const std::optional<double> upper = number(limit, "twist_upper", owner, kTwistRange);
  if (!lower && !upper) return;
  if (!lower || !upper || *lower > *upper) {
    problems.warning(limit.GetLineNum(),
                     lower && upper
                         ? fmt::format("{}: twist_lower {:.6g} is above twist_upper {:.6g}; its twist is free", owner,
                                       *lower, *upper)
                         : fmt::format("{}: has only one limit of its twist, which is free", owner),
                     "Write twist_lower= and twist_upper= in radians, the lower one first.");
    return;
  }
  out.twist_lower = *lower;
  out.twist_upper = *upper;
}

void UrdfReader::dynamics(const Element& element, const std::string& owner, UrdfJoint& out) {
  const Element* found = unique_child(element, "dynamics", owner);
  if (!found) return;
  check_attributes(*found, {"damping", "friction"});
  if (!found->Attribute("damping") && !found->Attribute("friction")) {
    problems.warning(found->GetLineNum(),
                     fmt::format("{}: <dynamics> has neither damping nor friction; ignored", owner),
                     "Write damping=\"…\" or friction=\"…\", or remove the element.");
  } else if (out.type != JointType::fixed) {
    out.damping = number(*found, "damping", owner, kDampingRange).value_or(0);
    out.friction = number(*found, "friction", owner, kDampingRange).value_or(0);
  }
}

JointType UrdfReader::joint_type(const Element& element, const std::string& owner) {
  const char* text = element.Attribute("type");
  const std::string fix = "Use revolute, continuous, prismatic, spherical, fixed, planar or floating.";
  if (!text) {
    problems.error(element.GetLineNum(), fmt::format("{} has no type; taken as fixed", owner), fix);
    return JointType::fixed;
  }
  for (const TypeName& known : kTypeNames) {
    if (known.name == text) return known.type;
    if (!same_name(known.name, text)) continue;
    problems.warning(element.GetLineNum(),
                     fmt::format("{}: type '{}' is read as {}", owner, printable(text), known.name),
                     fmt::format("Write type=\"{}\".", known.name));
    return known.type;
  }
  problems.error(element.GetLineNum(),
                 fmt::format("{}: '{}' is not a URDF joint type; taken as fixed", owner, printable(text)), fix);
  return JointType::fixed;
}

Vec3 UrdfReader::axis(const Element& element, const std::string& owner) {
  const Vec3 fallback{1, 0, 0};
  const std::string fix = "Write <axis xyz=\"x y z\"/>, a direction in the joint's frame.";
  const Element* found = unique_child(element, "axis", owner);
  if (found) check_attributes(*found, {"xyz"});
  if (!found || !found->Attribute("xyz")) {
    problems.warning((found ? found : &element)->GetLineNum(),
                     fmt::format("{} has no axis; using URDF's default 1 0 0", owner), fix);
    return fallback;
  }
  const std::optional<Vec3> read = vector(*found, "xyz", owner, kAxisRange);
  if (!read) return fallback;
  // scaled first, so that the squares of 1e-200 and 1e200 neither underflow nor overflow
  const double largest = std::max({std::abs(read->x), std::abs(read->y), std::abs(read->z)});
  if (largest == 0) {
    problems.error(found->GetLineNum(), fmt::format("{}: axis 0 0 0 is not a direction; using 1 0 0", owner), fix);
    return fallback;
  }
  const double length = largest * glm::length(*read / largest);
  if (std::abs(length - 1) > 1e-3) {
    problems.note(found->GetLineNum(), fmt::format("{}: the axis has length {:.6g}, not 1; normalized", owner, length),
                  "Write a direction of length 1.");
  }
  return normalized(*read / largest);
}

void UrdfReader::limit(const Element& element, const std::string& owner, UrdfJoint& out) {
  const Element* found = unique_child(element, "limit", owner);
  if (!found) {
    if (out.type == JointType::continuous) return;
    problems.warning(element.GetLineNum(), fmt::format("{} has no <limit>; it is free", owner),
                     fmt::format("Write <limit lower= upper= effort= velocity=/>{}", or_continuous_hint(out.type)));
    return;
  }
  check_attributes(*found, {"lower", "upper", "effort", "velocity"});
  out.effort = number(*found, "effort", owner, kForceRange);
  out.velocity = number(*found, "velocity", owner, kSpeedRange);
  if (!found->Attribute("velocity")) {
    problems.note(found->GetLineNum(), fmt::format("{}: <limit> has no velocity; as fast as the effort allows", owner),
                  "Write velocity=\"…\" in rad/s or m/s.");
  }
  if (out.type != JointType::continuous) bounds(*found, owner, out);
}

void UrdfReader::bounds(const Element& limit, const std::string& owner, UrdfJoint& out) {
  const int line = limit.GetLineNum();
  const bool has_lower = limit.Attribute("lower");
  const bool has_upper = limit.Attribute("upper");
  if (!has_lower && !has_upper) {
    problems.note(line, fmt::format("{}: <limit> has neither lower nor upper; it is free", owner),
                  fmt::format("Write lower= and upper={}", or_continuous_hint(out.type)));
    return;
  }
  const std::optional<double> lower = number(limit, "lower", owner, kBoundRange);
  const std::optional<double> upper = number(limit, "upper", owner, kBoundRange);
  if ((has_lower && !lower) || (has_upper && !upper)) {
    problems.error(line, fmt::format("{}: its limits can't be read; it is free", owner), "Write lower= and upper=.");
    return;
  }
  if (!has_lower || !has_upper) {
    problems.warning(line,
                     fmt::format("{}: <limit> has no {}; using URDF's default 0", owner, has_lower ? "upper" : "lower"),
                     "Write both lower= and upper=.");
  }
  out.lower = lower.value_or(0);
  out.upper = upper.value_or(0);
  if (out.lower > out.upper) {
    problems.warning(line,
                     fmt::format("{}: lower {:.6g} is above upper {:.6g}; it is free", owner, out.lower, out.upper),
                     fmt::format("Exchange lower and upper{}", or_continuous_hint(out.type)));
  } else if (out.lower < -kNoBound && out.upper > kNoBound) {
    problems.note(line, fmt::format("{}: limits beyond {:g} mean no limits; it is free", owner, kNoBound),
                  fmt::format("Remove lower and upper{}", or_continuous_hint(out.type)));
  } else {
    out.limited = true;
    out.lower = std::clamp(out.lower, -kNoBound, kNoBound);
    out.upper = std::clamp(out.upper, -kNoBound, kNoBound);
  }
  if (!out.limited) out.lower = out.upper = 0;
}

std::optional<UrdfMimic> UrdfReader::mimic(const Element& element, const std::string& owner) {
  const Element* found = unique_child(element, "mimic", owner);
  if (!found) return std::nullopt;
  UrdfMimic out;
  out.line = found->GetLineNum();
  check_attributes(*found, {"joint", "multiplier", "offset"});
  const char* joint = found->Attribute("joint");
  if (!joint || !*joint) {
    problems.error(out.line, fmt::format("{}: <mimic> names no joint; ignored", owner), "Write joint=\"…\".");
    return std::nullopt;
  }
  out.joint = joint;
  out.multiplier = number(*found, "multiplier", owner, kFactorRange).value_or(1);
  out.offset = number(*found, "offset", owner, kFactorRange).value_or(0);
  return out;
}

}  // namespace limber::model
