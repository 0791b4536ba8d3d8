// Mimic joints, start values of joints, poses of links, and the lists of links and joints as written in the file.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "model/urdf/build.h"

namespace limber::model {

namespace {

bool can_mimic(JointType type) {
  return type == JointType::revolute || type == JointType::continuous || type == JointType::prismatic;
}

/// Resolves <mimic> chains: each follower refers to a joint that does not follow another.
class MimicResolver {
 public:
  explicit MimicResolver(UrdfBuildContext& build)
      : build_(build), mimics_(build.model.joints.size(), nullptr), leaders_(mimics_.size(), -1) {
    for (std::size_t i = 0; i < mimics_.size(); ++i) index_.emplace(build.model.joints[i].name, static_cast<int>(i));
    for (std::size_t node = 0; node < build.tree.size(); ++node) {
      const int at = build.body_joint[node];
      if (at >= 0 && build.joint(node).mimic) mimics_[static_cast<std::size_t>(at)] = &*build.joint(node).mimic;
    }
  }

  void run() {
    for (std::size_t i = 0; i < mimics_.size(); ++i) {
      if (mimics_[i]) find_leader(i);
    }
    for (std::size_t i = 0; i < mimics_.size(); ++i) {
      if (leaders_[i] >= 0) resolve(i);
    }
    for (std::size_t i = 0; i < mimics_.size(); ++i) {
      if (build_.model.joints[i].mimic >= 0) check_limits(i);
    }
  }

 private:
  void reject(std::size_t i, const std::string& reason) {
    build_.problems.error(
        mimics_[i]->line,
        fmt::format("joint '{}': its <mimic> {}; ignored", printable(build_.model.joints[i].name), reason),
        "Name another revolute, continuous or prismatic joint of this file, without a cycle.");
  }

  void find_leader(std::size_t i) {
    const auto found = index_.find(mimics_[i]->joint);
    if (found == index_.end()) {
      std::vector<std::string> names;
      for (const JointModel& j : build_.model.joints) {
        if (names.size() < 200) names.push_back(j.name);
      }
      reject(i, fmt::format("names '{}', which is not a movable joint{}", printable(mimics_[i]->joint),
                            name_hint(mimics_[i]->joint, names)));
    } else if (found->second == static_cast<int>(i)) {
      reject(i, "names the joint itself");
    } else if (!can_mimic(build_.model.joints[static_cast<std::size_t>(found->second)].type)) {
      reject(i, fmt::format("names '{}', which has no single axis", printable(mimics_[i]->joint)));
    } else {
      leaders_[i] = found->second;
    }
  }

  void resolve(std::size_t i) {
    double multiplier = 1, offset = 0;
    std::size_t at = i;
    for (std::size_t steps = 0; leaders_[at] >= 0; ++steps) {
      offset += multiplier * mimics_[at]->offset;
      multiplier *= mimics_[at]->multiplier;
      at = static_cast<std::size_t>(leaders_[at]);
      if (steps > mimics_.size() || at == i) return reject(i, "forms a cycle");
    }
    if (std::abs(multiplier) > 1e9 || std::abs(offset) > 1e9) return reject(i, "has a multiplier or offset above 1e9");
    JointModel& joint = build_.model.joints[i];
    joint.mimic = static_cast<int>(at);
    joint.mimic_multiplier = multiplier;
    joint.mimic_offset = offset;
    if (static_cast<int>(at) == leaders_[i]) return;
    build_.problems.note(mimics_[i]->line,
                         fmt::format("joint '{}': follows '{}', which follows another joint; it follows '{} instead",
                                     printable(joint.name), printable(mimics_[i]->joint), formula(joint)),
                         "Nothing to do.");
  }

  // "leader' * -1 + 0.2"; the caller writes the opening quote of the name
  std::string formula(const JointModel& joint) const {
    std::string text = fmt::format("{}' * {:.6g}", printable(leader_of(joint).name), joint.mimic_multiplier);
    if (joint.mimic_offset != 0)
      text += fmt::format(" {} {:.6g}", joint.mimic_offset < 0 ? '-' : '+', std::abs(joint.mimic_offset));
    return text;
  }

  const JointModel& leader_of(const JointModel& joint) const {
    return build_.model.joints[static_cast<std::size_t>(joint.mimic)];
  }

  // Reports a follower that reaches its limits within its leader's range.
  void check_limits(std::size_t i) {
    const JointModel& joint = build_.model.joints[i];
    const JointModel& leader = leader_of(joint);
    if (!joint.limited) return;
    constexpr double kSlack = 1e-4;  // files round
    const double infinity = std::numeric_limits<double>::infinity();
    const double multiplier = joint.mimic_multiplier;
    const auto follows = [&](double at, double free) {
      return multiplier == 0 ? joint.mimic_offset
                             : (leader.limited ? multiplier * at : multiplier * free) + joint.mimic_offset;
    };
    const double at_lower = follows(leader.lower, -infinity);
    const double at_upper = follows(leader.upper, infinity);
    const double tolerance = kSlack * (1 + std::abs(multiplier));
    std::vector<std::string> leader_values;
    const auto add_if_exceeded = [&](double limit, bool passed) {
      if (!passed) return;
      const std::string at =
          multiplier == 0 ? "anywhere" : fmt::format("at {:.6g}", (limit - joint.mimic_offset) / multiplier);
      if (leader_values.empty() || leader_values.back() != at) leader_values.push_back(at);
    };
    add_if_exceeded(joint.lower, std::min(at_lower, at_upper) < joint.lower - tolerance);
    add_if_exceeded(joint.upper, std::max(at_lower, at_upper) > joint.upper + tolerance);
    if (leader_values.empty()) return;
    const std::string range = leader.limited ? fmt::format("{:.6g}..{:.6g}", leader.lower, leader.upper) : "free";
    build_.problems.warning(
        mimics_[i]->line,
        fmt::format("joint '{}' follows '{}: its limits {:.6g}..{:.6g} are reached when '{}' is {} (range of '{}': {})",
                    printable(joint.name), formula(joint), joint.lower, joint.upper, printable(leader.name),
                    fmt::join(leader_values, " and "), printable(leader.name), range),
        fmt::format("Widen the limits of '{}', or narrow those of '{}'.", printable(joint.name),
                    printable(leader.name)));
  }

  UrdfBuildContext& build_;
  std::vector<const UrdfMimic*> mimics_;
  std::vector<int> leaders_;
  std::unordered_map<std::string_view, int> index_;
};

double clamped_to_limits(const JointModel& joint, double value) {
  return joint.limited ? std::clamp(value, joint.lower, joint.upper) : value;
}

/// Applies the start values in ImportOptions::pose.
Result<void> apply_start_values(UrdfBuildContext& build) {
  for (const auto& entry : build.options.pose) {
    const std::string& name = entry.first;
    const double value = entry.second;
    const auto found = std::find_if(build.model.joints.begin(), build.model.joints.end(),
                                    [&](const JointModel& j) { return j.name == name; });
    if (found == build.model.joints.end()) {
      std::vector<std::string> names;
      for (const JointModel& j : build.model.joints) names.push_back(j.name);
      return Error{fmt::format("pose: '{}' has no movable joint '{}'{}", printable(build.model.name), printable(name),
                               name_hint(name, names))};
    }
    if (!std::isfinite(value) || std::abs(value) > 1e4) {
      return Error{fmt::format("pose: joint '{}' can't start at {}. Give a number of radians or meters.",
                               printable(name), value)};
    }
    found->start = value;
  }
  return {};
}

void set_starts(UrdfBuildContext& build) {
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    if (build.body_joint[node] < 0) continue;
    JointModel& joint = build.model.joints[static_cast<std::size_t>(build.body_joint[node])];
    const double requested = joint.start;
    joint.start = clamped_to_limits(joint, requested);
    if (joint.start == requested || joint.mimic >= 0) continue;
    build.problems.note(build.joint(node).line,
                        fmt::format("joint '{}': {:.6g} is outside its limits {:.6g} to {:.6g}; it starts at {:.6g}",
                                    printable(joint.name), requested, joint.lower, joint.upper, joint.start),
                        "Nothing to do, unless the limits are wrong.");
  }
  for (JointModel& joint : build.model.joints) {
    if (joint.mimic < 0) continue;
    const double leader = build.model.joints[static_cast<std::size_t>(joint.mimic)].start;
    joint.start = clamped_to_limits(joint, joint.mimic_multiplier * leader + joint.mimic_offset);
  }
}

Pose joint_transform(const UrdfJoint& joint, double value) {
  if (joint.type == JointType::prismatic) return {value * joint.axis, quat_identity()};
  if (joint.type == JointType::revolute || joint.type == JointType::continuous) {
    const Quat rotation = quat_axis(joint.axis, value);
    return {joint.anchor - rotation * joint.anchor, rotation};
  }
  if (joint.type == JointType::spherical)
    return {joint.anchor - joint.start_rotation * joint.anchor, joint.start_rotation};
  return {};
}

FileLink file_link(const UrdfLink& link) {
  FileLink out;
  out.name = link.name;
  out.collisions = static_cast<int>(link.collisions.size());
  out.visuals = static_cast<int>(link.visuals.size());
  if (!link.inertial) return out;
  const Pose origin = link.inertial->origin.pose();
  const Mat3 rotation = glm::mat3_cast(origin.rotation);
  out.mass = link.inertial->mass;
  out.center = origin.position;
  out.tensor = rotation * link.inertial->tensor * glm::transpose(rotation);
  return out;
}

FileJoint file_joint(const UrdfJoint& joint) {
  FileJoint out;
  out.name = joint.name;
  out.type = joint_type_name(joint.type);
  out.parent = joint.parent;
  out.child = joint.child;
  out.axis = joint.axis;
  out.free = joint.type != JointType::fixed && !joint.limited;
  out.lower = joint.lower;
  out.upper = joint.upper;
  out.effort = joint.effort.value_or(0);
  out.velocity = joint.velocity.value_or(0);
  return out;
}

void place_links(UrdfBuildContext& build) {
  std::vector<FileLink>& links = build.model.file_links;
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    FileLink link = file_link(build.link(node));
    if (node == 0) {
      link.home = build.file.root_home;
      link.start = build.file.root_start;
    }
    if (build.tree[node].joint >= 0) {
      const UrdfJoint& joint = build.joint(node);
      const FileLink& parent = links[static_cast<std::size_t>(build.tree[node].parent)];
      const int at = build.body_joint[node];
      const double start = at >= 0 ? build.model.joints[static_cast<std::size_t>(at)].start : 0;
      link.home = parent.home * joint.origin.pose();
      link.start = parent.start * joint.origin.pose() * joint_transform(joint, start);
      build.model.file_joints.push_back(file_joint(joint));
      if (at >= 0 && build.model.joints[static_cast<std::size_t>(at)].mimic >= 0) {
        const JointModel& follower = build.model.joints[static_cast<std::size_t>(at)];
        FileJoint& listed = build.model.file_joints.back();
        listed.mimic = build.model.joints[static_cast<std::size_t>(follower.mimic)].name;
        listed.mimic_multiplier = follower.mimic_multiplier;
        listed.mimic_offset = follower.mimic_offset;
      }
    }
    link.home.rotation = glm::normalize(link.home.rotation);
    link.start.rotation = glm::normalize(link.start.rotation);
    links.push_back(std::move(link));
    const bool is_own_link =
        node == 0 || build.body_link[node] != build.body_link[static_cast<std::size_t>(build.tree[node].parent)];
    if (!is_own_link) continue;
    LinkModel& model = build.model.links[static_cast<std::size_t>(build.body_link[node])];
    model.home = links.back().home;
    model.start = links.back().start;
  }
}

}  // namespace

Result<void> build_poses(UrdfBuildContext& build) {
  MimicResolver(build).run();
  if (Result<void> applied = apply_start_values(build); !applied) return applied;
  set_starts(build);
  place_links(build);
  return {};
}

}  // namespace limber::model
