// Joints that close loops: those that the file declares, and those between pairs of closing frames, as onshape-to-robot
// writes them: links "closing_NAME_1" and "closing_NAME_2", for a hinge also "…_1_z" and "…_2_z" on its axis.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "base/utf8.h"
#include "model/urdf/build.h"

namespace limber::model {

namespace {

constexpr double kMaxStartGap = 1e-3;   // m; a larger one is reported
constexpr double kMaxStartTurn = 0.01;  // rad
constexpr std::size_t kMaxLoops = 10'000;
constexpr std::size_t kMaxNamePart = 40;  // bytes of a link's name in that of a loop

class LoopBuilder {
 public:
  explicit LoopBuilder(UrdfBuildContext& build) : build_(build) {
    for (std::size_t node = 0; node < build.tree.size(); ++node) nodes_.emplace(build.link(node).name, node);
    for (const JointModel& joint : build.model.joints) names_.insert(joint.name);
  }

  void run() {
    for (const UrdfLoop& loop : build_.file.loops) add_declared(loop);
    for (std::size_t node = 0; node < build_.tree.size(); ++node) add_closing(node);
    report_closing();
  }

 private:
  void add_declared(const UrdfLoop& from) {
    const std::optional<std::size_t> parent = node_of(from, from.parent, "parent");
    const std::optional<std::size_t> child = node_of(from, from.child, "child");
    if (!parent || !child) return;
    declared_.insert({from.parent, from.child});
    const Quat turn = rotation_to_axis(from.axis);
    JointModel joint;
    joint.name = from.name.empty() ? fmt::format("{}_{}_loop", utf8_prefix(from.parent, kMaxNamePart),
                                                 utf8_prefix(from.child, kMaxNamePart))
                                   : from.name;
    joint.type = from.type;
    joint.limited = from.limited;
    joint.lower = from.lower;
    joint.upper = from.upper;
    joint.friction = from.friction;
    joint.frame_in_parent = from.frame_in_parent * Pose{Vec3(0), turn};
    joint.frame_in_child = from.frame_in_child * Pose{Vec3(0), turn};
    add(std::move(joint), *parent, *child, from.line);
  }

  std::optional<std::size_t> node_of(const UrdfLoop& loop, const std::string& name, const char* side) {
    const auto found = nodes_.find(name);
    if (found != nodes_.end()) return found->second;
    if (build_.problems.list().size() >= Problems::kMaxProblems) return {};
    std::vector<std::string> names;
    for (std::size_t node = 0; node < build_.tree.size() && node < 200; ++node) names.push_back(build_.link(node).name);
    build_.problems.error(loop.line,
                          fmt::format("{}: its {} link '{}' is not part of the tree{}; the loop stays open",
                                      shown_loop(loop), side, printable(name), name_hint(name, names)),
                          "Write the name of a <link> of this file.");
    return {};
  }

  // `node` may be the first frame of a pair
  void add_closing(std::size_t node) {
    const std::string& first = build_.link(node).name;
    if (!first.starts_with("closing_") || !first.ends_with("_1") || first.size() < 11 || !is_frame(node)) return;
    const std::string stem = first.substr(0, first.size() - 1);
    const auto second = nodes_.find(stem + "2");
    if (second == nodes_.end() || !is_frame(second->second)) {
      build_.problems.warning(build_.link(node).line,
                              fmt::format("link '{}': there is no link '{}2' to close a loop with; the loop stays open",
                                          printable(first), printable(stem)),
                              "Export the file again, or add a <limber:loop>.");
      return;
    }
    if (declared_.contains({first, stem + "2"}) || declared_.contains({stem + "2", first})) return;
    const Vec3 axis_1 = axis_of(node, first);
    const Vec3 axis_2 = axis_of(second->second, stem + "2");
    const bool hinge = glm::length(axis_1) > 0.5 && glm::length(axis_2) > 0.5;
    JointModel joint;
    joint.name = stem.substr(0, stem.size() - 1);
    joint.type = hinge ? JointType::continuous : JointType::spherical;
    joint.frame_in_parent.rotation = hinge ? rotation_to_axis(axis_1) : quat_identity();
    joint.frame_in_child.rotation = hinge ? rotation_to_axis(axis_2) : quat_identity();
    if (add(std::move(joint), node, second->second, build_.link(node).line) && closed_++ == 0) first_closed_ = node;
  }

  // A link without a moving joint of its own.
  bool is_frame(std::size_t node) const { return node > 0 && build_.body_joint[node] < 0; }

  // The direction to the frame "…_z" of a hinge, in the frame; 0 if there is none.
  Vec3 axis_of(std::size_t node, const std::string& name) const {
    const auto found = nodes_.find(name + "_z");
    if (found == nodes_.end() || build_.body_link[found->second] != build_.body_link[node]) return Vec3(0);
    return normalized((build_.offset[node].inverse() * build_.offset[found->second]).position);
  }

  bool add(JointModel joint, std::size_t parent, std::size_t child, int line) {
    joint.parent = build_.body_link[parent];
    joint.child = build_.body_link[child];
    joint.driven = false;
    joint.frame_in_parent = build_.offset[parent] * joint.frame_in_parent;
    joint.frame_in_child = build_.offset[child] * joint.frame_in_child;
    if (joint.parent == joint.child || build_.model.loops.size() >= kMaxLoops) {
      build_.problems.warning(line,
                              fmt::format("loop '{}' ignored: {}", printable(joint.name),
                                          joint.parent == joint.child ? "both sides are on the same rigid link"
                                                                      : "there are too many loops"),
                              "Remove it.");
      return false;
    }
    if (joint.child == 0) swap_sides(joint);
    make_unique(joint, line);
    check_start(joint, line);
    build_.model.loops.push_back(std::move(joint));
    return true;
  }

  // the root must not be a child
  static void swap_sides(JointModel& joint) {
    std::swap(joint.parent, joint.child);
    std::swap(joint.frame_in_parent, joint.frame_in_child);
    joint.lower = -std::exchange(joint.upper, -joint.lower);
  }

  void make_unique(JointModel& joint, int line) {
    if (names_.insert(joint.name).second) return;
    const std::string base = joint.name;
    int& suffix = next_suffix_.try_emplace(base, 2).first->second;
    do {
      joint.name = fmt::format("{}_{}", base, suffix++);
    } while (!names_.insert(joint.name).second);
    build_.problems.warning(line,
                            fmt::format("loop '{}' has the name of another joint; it is called '{}'", printable(base),
                                        printable(joint.name)),
                            "Give every joint a name of its own.");
  }

  // Reports a loop that is open at the start.
  void check_start(const JointModel& joint, int line) {
    const auto frame = [&](int link, const Pose& pose) {
      return build_.model.links[static_cast<std::size_t>(link)].start * pose;
    };
    if (joint.type == JointType::prismatic || joint.type == JointType::planar) return;
    const Pose between =
        frame(joint.parent, joint.frame_in_parent).inverse() * frame(joint.child, joint.frame_in_child);
    const double gap = glm::length(between.position);
    const Quat& q = between.rotation;
    const double half = fixed::atan2(glm::length(Vec3(q.x, q.y, q.z)), std::abs(q.w));
    const double turn = joint.type == JointType::fixed ? 2 * half : 0;
    if (gap <= kMaxStartGap && turn <= kMaxStartTurn) return;
    build_.problems.warning(line,
                            fmt::format("loop '{}' is open at the start by {:.3g} mm{}; the simulation pulls it closed",
                                        printable(joint.name), gap * 1000,
                                        turn > kMaxStartTurn ? fmt::format(" and {:.3g} rad", turn) : ""),
                            "Start it where it is closed: pose = { joint = value }.");
  }

  void report_closing() {
    if (closed_ == 0) return;
    build_.problems.note(
        build_.link(first_closed_).line,
        fmt::format("{} between closing frames, first '{}', {} a loop: a hinge where there are frames named …_z, "
                    "else a ball joint",
                    closed_ == 1 ? "a joint" : fmt::format("{} joints", closed_),
                    printable(build_.link(first_closed_).name), closed_ == 1 ? "closes" : "close"),
        "For another type, write a <limber:loop> between the two frames.");
  }

  UrdfBuildContext& build_;
  std::unordered_map<std::string_view, std::size_t> nodes_;  // by name of the link
  std::set<std::string> names_;
  std::unordered_map<std::string, int> next_suffix_;
  std::set<std::pair<std::string, std::string>> declared_;
  int closed_ = 0;  // loops between closing frames
  std::size_t first_closed_ = 0;
};

}  // namespace

void build_loops(UrdfBuildContext& build) { LoopBuilder(build).run(); }

}  // namespace limber::model
