// <limber:loop>: a joint that closes a loop, an extension of URDF.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/urdf/reader.h"

namespace limber::model {

namespace {

constexpr const char* kExample =
    "Write <limber:loop name=\"…\" type=\"revolute\"> with <parent link=\"…\"><origin xyz=\"…\"/></parent>, "
    "<child link=\"…\"><origin xyz=\"…\"/></child> and <axis xyz=\"…\"/>.";

constexpr NumberRange kFrictionRange{0, 1e9, "from 0 to 1e9"};

bool closes_loops(JointType type) { return type != JointType::floating; }

}  // namespace

std::string shown_loop(const UrdfLoop& loop) {
  return loop.name.empty() ? "a loop" : fmt::format("loop '{}'", printable(loop.name));
}

bool UrdfReader::loop_sides(const Element& element, const std::string& owner, UrdfLoop& out) {
  for (const char* const side : {"parent", "child"}) {
    const Element* const found = unique_child(element, side, owner);
    const char* const link = found ? found->Attribute("link") : nullptr;
    if (!link || !*link) {
      problems.error(out.line, fmt::format("{} names no {} link; the loop stays open", owner, side), kExample);
      return false;
    }
    check_attributes(*found, {"link"});
    const bool is_parent = std::string_view(side) == "parent";
    (is_parent ? out.parent : out.child) = link;
    (is_parent ? out.frame_in_parent : out.frame_in_child) = origin(*found, owner).pose();
  }
  return true;
}

std::optional<UrdfLoop> UrdfReader::loop(const Element& element) {
  UrdfLoop out;
  out.line = element.GetLineNum();
  const char* const name = element.Attribute("name");
  const std::optional<std::string> fault = name ? name_error(name) : std::nullopt;
  if (name && !fault) out.name = name;
  const std::string owner = shown_loop(out);
  if (fault) problems.warning(out.line, fmt::format("{}: name ignored: {}", owner, *fault), kExample);
  check_attributes(element, {"name", "type"});
  if (!loop_sides(element, owner, out)) return std::nullopt;
  if (!element.Attribute("type")) {
    problems.error(out.line, fmt::format("{} has no type; taken as spherical", owner), kExample);
    out.type = JointType::spherical;
  } else {
    out.type = joint_type(element, owner);
  }
  if (!closes_loops(out.type)) {
    problems.error(out.line, fmt::format("{}: a {} joint closes nothing; ignored", owner, joint_type_name(out.type)),
                   kExample);
    return std::nullopt;
  }
  const bool has_axis = out.type != JointType::fixed && out.type != JointType::spherical;
  out.axis = has_axis ? axis(element, owner) : Vec3(0, 0, 1);
  if ((out.type == JointType::revolute || out.type == JointType::prismatic) && child(element, "limit")) {
    UrdfJoint limits;
    limits.type = out.type;
    bounds(*unique_child(element, "limit", owner), owner, limits);
    out.limited = limits.limited;
    out.lower = limits.lower;
    out.upper = limits.upper;
  }
  if (const Element* const found = child(element, "dynamics")) {
    check_attributes(*found, {"friction"});
    out.friction = number(*found, "friction", owner, kFrictionRange).value_or(0);
  }
  return out;
}

}  // namespace limber::model
