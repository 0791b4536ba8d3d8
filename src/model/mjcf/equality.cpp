// Equalities: joints that close loops, and joints that follow others.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr double kMaxAnchor = 1e4;
constexpr std::array<std::string_view, 6> kEqualities{"connect", "weld", "joint", "tendon", "flex", "flexvert"};

bool is_single_axis(JointType type) { return type == JointType::revolute || type == JointType::prismatic; }

bool is_near(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= kMaxAnchor; }

// The constant and the linear factor of `polycoef`.
std::array<double, 2> read_polynomial(MjcfReader& reader, const MjcfElement& element, MjcfClass cls) {
  std::vector<double> polynomial = reader.numbers(element, cls, "polycoef", 1, 5);
  if (polynomial.empty()) polynomial = {0, 1, 0, 0, 0};
  polynomial.resize(5, 0);
  if (polynomial[2] != 0 || polynomial[3] != 0 || polynomial[4] != 0) {
    reader.unsupported(element,
                       fmt::format("<{} polycoef> in <equality>: only the linear part has an effect", element.name),
                       "Drive the joint in the scene.", Severity::warning);
  }
  return {polynomial[0], polynomial[1]};
}

}  // namespace

void MjcfFileReader::read_equality(const MjcfElement& element) {
  const bool of_joints = element.name == "joint" || element.name == "tendon";
  reader_.check_attributes(element, of_joints ? "equality of joints" : std::string_view(element.name));
  const MjcfClass cls = reader_.class_of(element, 0);
  const std::string* active = reader_.text(element, cls, "active");
  if (active == nullptr) active = reader_.default_text("equality", cls, "active");
  const std::string shown = fmt::format("<{}> in <equality>", printable_excerpt(element.name));
  if (active != nullptr && *active == "false") {
    reader_.unsupported(element, shown + " ignored: it is not active", "Write active=\"true\" to use it.");
  } else if (element.name == "connect" || element.name == "weld") {
    read_loop(element, cls);
  } else if (element.name == "joint") {
    couple_joints(element, cls);
  } else if (element.name == "tendon") {
    couple_tendon(element, cls);
  } else {
    reader_.unknown(element, shown + " ignored: nothing is constrained", kEqualities, "Use connect, weld or joint.");
  }
}

// connect: a point of body1 stays at a point of body2; weld: so does the orientation. Without body2, the world.
void MjcfFileReader::read_loop(const MjcfElement& element, MjcfClass cls) {
  const bool weld = element.name == "weld";
  MjcfLoop loop;
  loop.line = reader_.line_of(element);
  loop.name = reader_.name(element);
  loop.type = weld ? JointType::fixed : JointType::spherical;
  if (element.attribute("site1") != nullptr || element.attribute("site2") != nullptr) {
    const Site* const first = site_named(element, "site1");
    const Site* const second = site_named(element, "site2");
    if (first == nullptr || second == nullptr) return;
    loop.body_1 = first->body;
    loop.body_2 = second->body;
    loop.frame_1 = first->site.pose;
    loop.frame_2 = second->site.pose;
  } else {
    loop.body_1 = body_named(element, "body1");
    loop.body_2 = element.attribute("body2") != nullptr ? body_named(element, "body2") : 0;
    if (loop.body_1 < 0 || loop.body_2 < 0) return;
    const std::optional<Vec3> anchor = reader_.vector(element, cls, "anchor");
    if ((!weld && !anchor) || !is_near(anchor.value_or(Vec3(0)))) {
      reader_.error(element, fmt::format("{} has no valid anchor; the loop stays open", reader_.shown(element)),
                    "Write anchor=\"x y z\", a point of body1 within 10000 m.");
      return;
    }
    if (!weld) {
      loop.frame_1.position = *anchor;  // the other frame follows from the home pose
    } else {
      set_weld(element, cls, anchor.value_or(Vec3(0)), loop);
    }
  }
  if (loop.body_1 == loop.body_2) {
    reader_.error(element, fmt::format("{} connects a body to itself; ignored", reader_.shown(element)),
                  "Name two bodies.");
    return;
  }
  file_.loops.push_back(std::move(loop));
}

// `relpose`: the pose of body2 in body1; if its quaternion is 0, that of the home pose. `anchor` is in body2.
void MjcfFileReader::set_weld(const MjcfElement& element, MjcfClass cls, const Vec3& anchor, MjcfLoop& loop) {
  const std::vector<double> relative = reader_.numbers(element, cls, "relpose", 7, 7);
  if (relative.empty()) return;
  const Quat rotation = quat_xyzw(relative[4], relative[5], relative[6], relative[3]);
  if (glm::length(rotation) < 1e-9 || !is_near(vec3_at(relative.data()))) return;
  const Pose second_in_first{vec3_at(relative.data()), glm::normalize(rotation)};
  loop.frame_2 = Pose{anchor, quat_identity()};
  loop.frame_1 = second_in_first * *loop.frame_2;
}

const MjcfFileReader::Site* MjcfFileReader::site_named(const MjcfElement& element, const char* attribute) {
  const std::string* const name = element.attribute(attribute);
  const std::string written = name != nullptr ? *name : "";
  const auto found = sites_.find(written);
  if (found != sites_.end()) return &found->second;
  if (!reader_.can_report()) return nullptr;
  std::vector<std::string> names;
  for (const auto& [known, site] : sites_) {
    if (names.size() < 200) names.push_back(known);
  }
  reader_.error(element,
                fmt::format("{}: site '{}' does not exist{}; ignored", reader_.shown(element),
                            printable_excerpt(written), name_hint(written, names)),
                fmt::format("Write {}=\"…\" with the name of a site.", attribute));
  return nullptr;
}

// joint1 - its value at home = a + b * (joint2 - its value at home); without joint2, joint1 doesn't move.
void MjcfFileReader::couple_joints(const MjcfElement& element, MjcfClass cls) {
  MjcfJoint* const follower = joint_named(element, "joint1", "couples");
  const bool alone = element.attribute("joint2") == nullptr;
  MjcfJoint* const leader = alone ? nullptr : joint_named(element, "joint2", "couples");
  const auto [constant, factor] = read_polynomial(reader_, element, cls);
  if (alone && follower != nullptr && is_single_axis(follower->type)) {
    const double value = std::clamp(constant, -kMaxAnchor, kMaxAnchor) + follower->reference;
    follower->limited = true;
    follower->lower = follower->upper = value;
    reader_.note(element, fmt::format("{} without joint2: the joint is locked", reader_.shown(element)),
                 "Set its limits in the scene to release it.");
    return;
  }
  if (follower == nullptr || leader == nullptr || follower == leader || !is_single_axis(follower->type) ||
      !is_single_axis(leader->type)) {
    if (follower != nullptr) {
      reader_.unsupported(element, "<joint> in <equality> ignored: it names no two joints with one axis each",
                          "Name two hinges or slides.", Severity::warning);
    }
    return;
  }
  follower->mimic =
      UrdfMimic{reader_.line_of(element), leader->name, std::clamp(factor, -1e6, 1e6), std::clamp(constant, -1e6, 1e6)};
}

// A fixed tendon of constant length couples its two joints.
void MjcfFileReader::couple_tendon(const MjcfElement& element, MjcfClass cls) {
  const std::string* const name = element.attribute("tendon1");
  const auto found = name != nullptr ? fixed_tendons_.find(*name) : fixed_tendons_.end();
  const bool single = element.attribute("tendon2") == nullptr;
  if (!single || found == fixed_tendons_.end() || found->second.size() != 2 || found->second[0].factor == 0 ||
      found->second[1].factor == 0 || found->second[0].joint == found->second[1].joint) {
    reader_.unsupported(element, "<tendon> in <equality> ignored: it is not one fixed tendon of two joints",
                        "Couple two joints with <joint> in <equality>, or add gears in the scene.", Severity::warning);
    return;
  }
  const auto& [leader, follower] = std::tie(found->second[0], found->second[1]);
  const double constant = read_polynomial(reader_, element, cls)[0];
  follower.joint->mimic =
      UrdfMimic{reader_.line_of(element), leader.joint->name, std::clamp(-leader.factor / follower.factor, -1e6, 1e6),
                std::clamp(constant / follower.factor, -1e6, 1e6)};
}

}  // namespace limber::model
