// Actuators, contact exclusions, keyframes, and sections without effect.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr double kMaxEffort = 1e9;
constexpr double kMaxGain = 1e6;
constexpr std::array<std::string_view, 11> kActuators{"motor",    "position", "velocity", "intvelocity",
                                                      "damper",   "general",  "cylinder", "muscle",
                                                      "adhesion", "plugin",   "dcmotor"};

// The gains of an actuator with feedback of the position: force = stiffness·(target - value) - damping·speed.
void set_gains(MjcfReader& reader, const MjcfElement& element, MjcfClass cls, double gear, MjcfJoint& joint) {
  double stiffness = 0, damping = 0;
  if (element.name == "position") {
    stiffness = reader.number(element, cls, "kp", 1);
    damping = reader.number(element, cls, "kv", 0);
  } else if (const std::string* const bias = reader.text(element, cls, "biastype");
             bias != nullptr && *bias == "affine") {
    const std::vector<double> numbers = reader.numbers(element, cls, "biasprm", 1, 10);
    if (numbers.size() > 1) stiffness = -numbers[1];
    if (numbers.size() > 2) damping = -numbers[2];
  }
  if (stiffness <= 0 || gear == 0) return;
  joint.gains = {std::min(stiffness * gear * gear, kMaxGain), -joint.reference,
                 std::clamp(damping * gear * gear, 0.0, kMaxGain)};
  reader.unsupported(
      element,
      fmt::format("<{}>: its servo uses its whole effort; its gains are those of the motor's spring", element.name),
      "Set motor.mode = \"spring\" to use the gains.");
}

double largest_of(const std::vector<double>& range) {
  double largest = 0;
  for (const double value : range) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

void MjcfFileReader::index_names() {
  constexpr std::size_t kMaxSuggestions = 200;
  for (std::size_t i = 0; i < file_.bodies.size(); ++i) {
    MjcfBody& b = file_.bodies[i];
    for (const MjcfSite& site : b.sites) sites_.try_emplace(site.name, Site{static_cast<int>(i), site});
    if (!b.name.empty()) body_index_.try_emplace(b.name, static_cast<int>(i));
    for (MjcfJoint& joint : b.joints) {
      if (joint.name.empty()) continue;
      joint_index_.try_emplace(joint.name, &joint);
      if (joint_names_.size() < kMaxSuggestions) joint_names_.push_back(joint.name);
    }
  }
}

int MjcfFileReader::body_named(const MjcfElement& element, const char* attribute) {
  const std::string* const name = element.attribute(attribute);
  const std::string written = name != nullptr ? *name : "";
  const auto found = body_index_.find(written);
  if (found != body_index_.end()) return found->second;
  if (!reader_.can_report()) return -1;
  std::vector<std::string> names;
  for (const auto& [known, index] : body_index_) {
    if (names.size() < 200) names.push_back(known);
  }
  reader_.error(element,
                fmt::format("{}: body '{}' does not exist{}; ignored", reader_.shown(element),
                            printable_excerpt(written), name_hint(written, names)),
                fmt::format("Write {}=\"…\" with the name of a body.", attribute));
  return -1;
}

MjcfJoint* MjcfFileReader::joint_named(const MjcfElement& element, const char* attribute, const std::string& use) {
  const std::string* const name = element.attribute(attribute);
  if (name == nullptr) return nullptr;
  const auto found = joint_index_.find(*name);
  if (found != joint_index_.end()) return found->second;
  if (!reader_.can_report()) return nullptr;
  reader_.error(element,
                fmt::format("{} {}: joint '{}' does not exist{}; ignored", reader_.shown(element), use,
                            printable_excerpt(*name), name_hint(*name, joint_names_)),
                fmt::format("Write {}=\"…\" with the name of a joint.", attribute));
  return nullptr;
}

void MjcfFileReader::read_actuator(const MjcfElement& element) {
  if (std::find(kActuators.begin(), kActuators.end(), element.name) == kActuators.end()) {
    reader_.unknown(element,
                    fmt::format("<{}> in <actuator> ignored: it is not an actuator", printable_excerpt(element.name)),
                    kActuators, "Use motor, position, velocity or general.");
    return;
  }
  reader_.check_attributes(element);
  const char* const attribute = element.attribute("joint") != nullptr ? "joint" : "jointinparent";
  if (const std::string* const tendon = element.attribute("tendon")) {
    const auto found = fixed_tendons_.find(*tendon);
    if (found != fixed_tendons_.end()) {
      for (const TendonJoint& pulled : found->second) {
        pulled.joint->driven = true;
        limit_joint(element, reader_.class_of(element, 0), std::abs(pulled.factor), *pulled.joint);
      }
      return;
    }
    if (spatial_tendons_.drive(element, *tendon)) return;
  }
  if (element.attribute(attribute) == nullptr) {
    reader_.unsupported(element, fmt::format("<{}> that drives no joint ignored: it has no force", element.name),
                        "Drive a joint: joint=\"…\".", Severity::warning);
    return;
  }
  MjcfJoint* const joint = joint_named(element, attribute, "drives");
  if (joint == nullptr) return;
  joint->driven = true;
  limit_joint(element, reader_.class_of(element, 0), 1, *joint);
}

// `lever`: factor of the joint in the actuator's tendon
void MjcfFileReader::limit_joint(const MjcfElement& element, MjcfClass cls, double lever, MjcfJoint& joint) {
  const std::vector<double> gears = reader_.numbers(element, cls, "gear", 1, 6);
  const double gear = (gears.empty() ? 1 : std::abs(gears[0])) * lever;
  const std::vector<double> force = reader_.limited(element, cls, "forcelimited", "forcerange")
                                        ? reader_.numbers(element, cls, "forcerange", 2, 2)
                                        : std::vector<double>();
  const std::vector<double> control = reader_.limited(element, cls, "ctrllimited", "ctrlrange")
                                          ? reader_.numbers(element, cls, "ctrlrange", 2, 2)
                                          : std::vector<double>();
  double effort = largest_of(force) * gear;
  const std::string* const bias = reader_.text(element, cls, "biastype");
  const bool general_motor = element.name == "general" && (bias == nullptr || *bias == "none");
  if (force.empty() && (element.name == "motor" || general_motor)) {
    const std::vector<double> gain = reader_.numbers(element, cls, "gainprm", 1, 10);
    effort = largest_of(control) * gear * (general_motor && !gain.empty() ? std::abs(gain[0]) : 1);
  }
  set_gains(reader_, element, cls, gear, joint);
  // a joint with several actuators gets the sum of their forces
  if (effort > 0) joint.effort = std::min(joint.effort + effort, kMaxEffort);
  if (element.name == "velocity" && !control.empty() && gear > 0)
    joint.velocity = std::min(std::max(joint.velocity, largest_of(control) / gear), kMaxEffort);
}

void MjcfFileReader::read_contacts(const MjcfElement& section) {
  for (const MjcfElement& e : section.children) {
    reader_.check_attributes(e);
    if (e.name != "exclude") {
      constexpr std::array<std::string_view, 2> kContacts{"exclude", "pair"};
      reader_.unknown(
          e,
          fmt::format("<{}> in <contact> ignored: contacts follow the masks of the geoms", printable_excerpt(e.name)),
          kContacts, "Set collision groups in the scene.", Severity::note);
      continue;
    }
    const int a = body_named(e, "body1");
    const int b = body_named(e, "body2");
    if (a >= 0 && b >= 0 && a != b) file_.exclusions.emplace_back(a, b);
  }
}

void MjcfFileReader::read_keyframes(const MjcfElement& section) {
  for (const MjcfElement& e : section.children) {
    const std::string* const name = e.attribute("name");
    if (e.name != "key" || name == nullptr || *name != "home") {
      reader_.unsupported(e, "<key> ignored: only a key named 'home' sets the start pose", "Save poses as presets.");
      continue;
    }
    return apply_keyframe(e);
  }
}

// The values are those of all joints in the order of the bodies: seven of a free joint, four of a ball, else one.
void MjcfFileReader::apply_keyframe(const MjcfElement& element) {
  std::size_t count = 0;
  for (const MjcfBody& b : file_.bodies) {
    if (b.free) count += 7;
    for (const MjcfJoint& joint : b.joints) count += joint.type == JointType::spherical ? 4 : 1;
  }
  const std::vector<double> values = reader_.numbers(element, 0, "qpos", count, count);
  if (values.empty()) return;
  std::size_t at = 0;
  for (MjcfBody& b : file_.bodies) {
    if (b.free) {
      const double* const v = values.data() + at;
      const Quat rotation = quat_xyzw(v[4], v[5], v[6], v[3]);
      if (glm::length(rotation) > 1e-9 && glm::length(vec3_at(v)) <= 1e4)
        b.start = {vec3_at(v), glm::normalize(rotation)};
      at += 7;
    }
    for (MjcfJoint& joint : b.joints) {
      if (joint.type == JointType::spherical) {
        const Quat rotation = quat_xyzw(values[at + 1], values[at + 2], values[at + 3], values[at]);
        if (glm::length(rotation) > 1e-9) joint.start_rotation = glm::normalize(rotation);
        at += 4;
      } else {
        joint.start = std::clamp(values[at++] - joint.reference, -1e4, 1e4);
      }
    }
  }
}

void MjcfFileReader::report_section(const MjcfElement& section) {
  if (section.name == "option") {
    reader_.unsupported(section, "<option> ignored: the scene sets gravity and time step",
                        "Set sim.gravity and sim.timestep in the scene.");
  } else if (section.name == "visual" || section.name == "statistic") {
    reader_.unsupported(section, fmt::format("<{}> ignored: the scene sets the view", section.name),
                        "Set visuals.camera and visuals.look in the scene.");
  } else if (section.name == "custom") {
    reader_.unsupported(section, "<custom> ignored: its numbers and texts have no meaning here",
                        "Keep them in the scene.");
  } else if (section.name == "deformable" || section.name == "extension") {
    reader_.unsupported(section, fmt::format("<{}> ignored: it is not supported", section.name),
                        "Remove it, or use rigid bodies.", Severity::warning);
  }
}

}  // namespace limber::model
