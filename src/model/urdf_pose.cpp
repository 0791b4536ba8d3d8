// Who follows whom, where joints start, where links are; and the lists of the file as it is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "model/urdf_build.h"

namespace limber {

namespace {

bool can_follow(JointType type) {
  return type == JointType::revolute || type == JointType::continuous || type == JointType::prismatic;
}

/// Resolves <mimic> to joints that follow nobody.
class Mimics {
 public:
  explicit Mimics(UrdfBuild& build) : build_(build), from_(build.model.joints.size(), nullptr), to_(from_.size(), -1) {
    for (std::size_t i = 0; i < from_.size(); ++i) index_.emplace(build.model.joints[i].name, static_cast<int>(i));
    for (std::size_t node = 0; node < build.tree.size(); ++node) {
      const int at = build.body_joint[node];
      if (at >= 0 && build.joint(node).mimic) from_[static_cast<std::size_t>(at)] = &*build.joint(node).mimic;
    }
  }

  void run() {
    for (std::size_t i = 0; i < from_.size(); ++i) {
      if (from_[i]) find(i);
    }
    for (std::size_t i = 0; i < from_.size(); ++i) {
      if (to_[i] >= 0) resolve(i);
    }
    for (std::size_t i = 0; i < from_.size(); ++i) {
      if (build_.model.joints[i].mimic >= 0) check_reach(i);
    }
  }

 private:
  void refuse(std::size_t i, const std::string& why) {
    build_.problems.error(
        from_[i]->line,
        fmt::format("joint '{}': its <mimic> {}; left out", printable(build_.model.joints[i].name), why),
        "Name another joint of this file that turns or slides, without a circle.");
  }

  void find(std::size_t i) {
    const auto found = index_.find(from_[i]->joint);
    if (found == index_.end()) {
      std::vector<std::string> names;
      for (const JointModel& j : build_.model.joints) {
        if (names.size() < 200) names.push_back(j.name);
      }
      refuse(i, fmt::format("names '{}', which is no joint that moves{}", printable(from_[i]->joint),
                            name_hint(from_[i]->joint, names)));
    } else if (found->second == static_cast<int>(i)) {
      refuse(i, "names the joint itself");
    } else if (!can_follow(build_.model.joints[static_cast<std::size_t>(found->second)].type)) {
      refuse(i, fmt::format("names '{}', which has no single axis", printable(from_[i]->joint)));
    } else {
      to_[i] = found->second;
    }
  }

  void resolve(std::size_t i) {
    double multiplier = 1, offset = 0;
    std::size_t at = i;
    for (std::size_t steps = 0; to_[at] >= 0; ++steps) {
      offset += multiplier * from_[at]->offset;
      multiplier *= from_[at]->multiplier;
      at = static_cast<std::size_t>(to_[at]);
      if (steps > from_.size() || at == i) return refuse(i, "runs in a circle");
    }
    if (std::abs(multiplier) > 1e9 || std::abs(offset) > 1e9) return refuse(i, "multiplies too far");
    JointModel& joint = build_.model.joints[i];
    joint.mimic = static_cast<int>(at);
    joint.mimic_multiplier = multiplier;
    joint.mimic_offset = offset;
    if (static_cast<int>(at) == to_[i]) return;
    build_.problems.note(from_[i]->line,
                         fmt::format("joint '{}': follows '{}', which follows another joint; it follows '{} instead",
                                     printable(joint.name), printable(from_[i]->joint), relation(joint)),
                         "Nothing to do.");
  }

  // "lead' * -1 + 0.2", to stand between quotes up to the name's end
  std::string relation(const JointModel& joint) const {
    std::string text = fmt::format("{}' * {:.6g}", printable(leader_of(joint).name), joint.mimic_multiplier);
    if (joint.mimic_offset != 0)
      text += fmt::format(" {} {:.6g}", joint.mimic_offset < 0 ? '-' : '+', std::abs(joint.mimic_offset));
    return text;
  }

  const JointModel& leader_of(const JointModel& joint) const {
    return build_.model.joints[static_cast<std::size_t>(joint.mimic)];
  }

  // Reports a follower whose limits stop its leader.
  void check_reach(std::size_t i) {
    const JointModel& joint = build_.model.joints[i];
    const JointModel& leader = leader_of(joint);
    if (!joint.limited) return;
    constexpr double kSlack = 1e-4;  // files round
    const double far = std::numeric_limits<double>::infinity();
    const double multiplier = joint.mimic_multiplier;
    const auto follows = [&](double at, double free) {
      return multiplier == 0 ? joint.mimic_offset
                             : (leader.limited ? multiplier * at : multiplier * free) + joint.mimic_offset;
    };
    const double one = follows(leader.lower, -far);
    const double other = follows(leader.upper, far);
    const double tolerance = kSlack * (1 + std::abs(multiplier));
    std::vector<std::string> reached;
    const auto look = [&](double limit, bool passed) {
      if (!passed) return;
      const std::string at =
          multiplier == 0 ? "anywhere" : fmt::format("at {:.6g}", (limit - joint.mimic_offset) / multiplier);
      if (reached.empty() || reached.back() != at) reached.push_back(at);
    };
    look(joint.lower, std::min(one, other) < joint.lower - tolerance);
    look(joint.upper, std::max(one, other) > joint.upper + tolerance);
    if (reached.empty()) return;
    const std::string range = leader.limited ? fmt::format("{:.6g}..{:.6g}", leader.lower, leader.upper) : "free";
    build_.problems.warning(
        from_[i]->line,
        fmt::format("joint '{}' follows '{}: its limits {:.6g}..{:.6g} are reached when '{}' is {} (range of '{}': {})",
                    printable(joint.name), relation(joint), joint.lower, joint.upper, printable(leader.name),
                    fmt::join(reached, " and "), printable(leader.name), range),
        fmt::format("Widen the limits of '{}', or narrow those of '{}'.", printable(joint.name),
                    printable(leader.name)));
  }

  UrdfBuild& build_;
  std::vector<const UrdfMimic*> from_;
  std::vector<int> to_;
  std::unordered_map<std::string_view, int> index_;
};

double allowed(const JointModel& joint, double value) {
  return joint.limited ? std::clamp(value, joint.lower, joint.upper) : value;
}

/// The start values that the asker gave, by joint.
Result<void> take_pose(UrdfBuild& build) {
  for (const auto& asked : build.options.pose) {
    const std::string& name = asked.first;
    const double value = asked.second;
    const auto found = std::find_if(build.model.joints.begin(), build.model.joints.end(),
                                    [&](const JointModel& j) { return j.name == name; });
    if (found == build.model.joints.end()) {
      std::vector<std::string> names;
      for (const JointModel& j : build.model.joints) names.push_back(j.name);
      return Error{fmt::format("pose: '{}' has no joint '{}' that moves{}", printable(build.model.name),
                               printable(name), name_hint(name, names))};
    }
    if (!std::isfinite(value) || std::abs(value) > 1e4) {
      return Error{fmt::format("pose: joint '{}' can't start at {}. Give a number of radians or metres.",
                               printable(name), value)};
    }
    found->start = value;
  }
  return {};
}

void set_starts(UrdfBuild& build) {
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    if (build.body_joint[node] < 0) continue;
    JointModel& joint = build.model.joints[static_cast<std::size_t>(build.body_joint[node])];
    const double wanted = joint.start;
    joint.start = allowed(joint, wanted);
    if (joint.start == wanted || joint.mimic >= 0) continue;
    build.problems.note(build.joint(node).line,
                        fmt::format("joint '{}': {:.6g} is outside its limits {:.6g} to {:.6g}; it starts at {:.6g}",
                                    printable(joint.name), wanted, joint.lower, joint.upper, joint.start),
                        "Nothing to do, unless the limits are wrong.");
  }
  for (JointModel& joint : build.model.joints) {
    if (joint.mimic < 0) continue;
    const double leader = build.model.joints[static_cast<std::size_t>(joint.mimic)].start;
    joint.start = allowed(joint, joint.mimic_multiplier * leader + joint.mimic_offset);
  }
}

Pose motion(const UrdfJoint& joint, double value) {
  if (joint.type == JointType::prismatic) return {value * joint.axis, quat_identity()};
  if (joint.type == JointType::revolute || joint.type == JointType::continuous) {
    return {Vec3(0), quat_axis(joint.axis, value)};
  }
  return {};
}

FileLink file_link(const UrdfLink& link) {
  FileLink out;
  out.name = link.name;
  out.collisions = static_cast<int>(link.collisions.size());
  out.visuals = static_cast<int>(link.visuals.size());
  if (!link.inertial) return out;
  const Pose origin = link.inertial->origin.pose();
  const Mat3 turn = glm::mat3_cast(origin.rotation);
  out.mass = link.inertial->mass;
  out.center = origin.position;
  out.tensor = turn * link.inertial->tensor * glm::transpose(turn);
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
  out.effort = joint.effort;
  out.velocity = joint.velocity;
  return out;
}

void place(UrdfBuild& build) {
  std::vector<FileLink>& links = build.model.file_links;
  for (std::size_t node = 0; node < build.tree.size(); ++node) {
    FileLink link = file_link(build.link(node));
    if (build.tree[node].joint >= 0) {
      const UrdfJoint& joint = build.joint(node);
      const FileLink& parent = links[static_cast<std::size_t>(build.tree[node].parent)];
      const int at = build.body_joint[node];
      const double start = at >= 0 ? build.model.joints[static_cast<std::size_t>(at)].start : 0;
      link.home = parent.home * joint.origin.pose();
      link.start = parent.start * joint.origin.pose() * motion(joint, start);
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
    const bool own =
        node == 0 || build.body_link[node] != build.body_link[static_cast<std::size_t>(build.tree[node].parent)];
    if (!own) continue;
    LinkModel& model = build.model.links[static_cast<std::size_t>(build.body_link[node])];
    model.home = links.back().home;
    model.start = links.back().start;
  }
}

}  // namespace

Result<void> build_poses(UrdfBuild& build) {
  Mimics(build).run();
  if (Result<void> taken = take_pose(build); !taken) return taken;
  set_starts(build);
  place(build);
  return {};
}

}  // namespace limber
