// Chooses a tree of bodies, and converts its bodies to links and its joints to one joint between two links each: a body
// with several joints gets connectors, light links without shapes, between them.
#include "model/mjcf/convert.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/plural.h"
#include "base/text.h"
#include "base/utf8.h"

namespace limber::model {

namespace {

// A connector has this share of the mass and inertia of its body: little enough to keep the motion, and far above the
// rounding of the solver.
constexpr double kConnectorShare = 1e-5;
constexpr int kLastVisibleGroup = 2;  // MuJoCo's viewer hides geoms of other groups at the start
constexpr double kDefaultEffort = 10000;
constexpr std::size_t kMaxExclusions = 20'000;
constexpr std::size_t kMaxShownNames = 8;
constexpr std::size_t kMaxStem = 100;  // bytes of a name before a suffix

/// The contact masks of a link's geoms, united.
struct ContactMask {
  unsigned type = 0;
  unsigned affinity = 0;
  bool operator<(const ContactMask& b) const { return std::pair(type, affinity) < std::pair(b.type, b.affinity); }
  bool touches(const ContactMask& b) const { return (type & b.affinity) != 0 || (b.type & affinity) != 0; }
};

class Converter {
 public:
  Converter(const MjcfFile& file, Problems& problems)
      : file_(file), problems_(problems), link_of_(file.bodies.size(), -1), masks_(file.bodies.size()) {}

  Result<UrdfFile> run(const std::string& root) {
    out_.name = file_.name;
    find_trees();
    const Result<int> chosen = choose(root);
    if (!chosen) return Error{chosen.error()};
    if (*chosen == 0) {
      add_world(true);
      for (std::size_t i = 1; i < file_.bodies.size(); ++i) add_body(i);
    } else {
      add_tree(static_cast<std::size_t>(*chosen));
    }
    convert_loops(file_, link_of_, static_cast<std::size_t>(*chosen), out_, problems_);
    convert_tendons(file_, link_of_, static_cast<std::size_t>(*chosen), out_, problems_);
    add_sensors();
    add_exclusions();
    report_joints();
    report_springs();
    return std::move(out_);
  }

 private:
  const MjcfBody& body(std::size_t index) const { return file_.bodies[index]; }
  static bool moves(const MjcfBody& b) { return b.free || !b.joints.empty(); }

  // True for the world and bodies that are fixed to it.
  bool is_static(std::size_t index) const {
    while (index != 0 && !moves(body(index))) index = static_cast<std::size_t>(body(index).parent);
    return index == 0;
  }

  // the top-level body of each body, and which of them contain a joint
  void find_trees() {
    top_.assign(file_.bodies.size(), 0);
    for (std::size_t i = 1; i < file_.bodies.size(); ++i) {
      const auto parent = static_cast<std::size_t>(body(i).parent);
      top_[i] = parent == 0 ? i : top_[parent];
      if (moves(body(i))) moving_.insert(top_[i]);
    }
  }

  Result<int> choose(const std::string& root) {
    std::vector<std::string> names{"world"};
    for (std::size_t i = 1; i < file_.bodies.size(); ++i) {
      if (body(i).parent != 0) continue;
      if (body(i).name == root) return static_cast<int>(i);
      names.push_back(body(i).name);
    }
    if (root == "world") return 0;
    if (!root.empty()) {
      return Error{
          fmt::format("{}: there is no top-level body '{}'{}", body(0).line, printable(root), name_hint(root, names))};
    }
    if (moving_.empty()) return file_.bodies.size() == 2 && body(0).geoms.empty() ? 1 : 0;
    report_others(*moving_.begin(), names);
    return static_cast<int>(*moving_.begin());
  }

  // `names`: "world" and the top-level bodies
  void report_others(std::size_t first, const std::vector<std::string>& names) {
    const std::size_t others = names.size() - 2;
    if (others == 0 && body(0).geoms.empty()) return;
    std::vector<std::string> shown;
    for (std::size_t i = 1; i < names.size() && shown.size() < kMaxShownNames; ++i) {
      if (names[i] != body(first).name) shown.push_back(printable(names[i]));
    }
    std::string rest = "the geoms of the world are";
    if (others > 0) {
      rest = fmt::format("{} ({}{}) and {}", counted(others, "other top-level body", "other top-level bodies"),
                         fmt::join(shown, ", "), others > shown.size() ? ", …" : "", rest);
    }
    problems_.note(body(0).line,
                   fmt::format("the body is the tree of '{}'; {} not part of it", printable(body(first).name), rest),
                   "Load with root = \"NAME\" for another one, or root = \"world\" for all in one body.");
  }

  void add_world(bool with_geoms) {
    UrdfLink link;
    link.name = "world";
    link.line = body(0).line;
    link.connector = !with_geoms || body(0).geoms.empty();
    out_.fixed_root = true;
    out_.links.push_back(std::move(link));
    if (!with_geoms) return;
    link_of_[0] = 0;
    add_geoms(0, out_.links.back());
    for (const MjcfSite& site : body(0).sites) add_frame(site.name, 0, site.pose);
  }

  void add_tree(std::size_t first) {
    const MjcfBody& root = body(first);
    if (root.joints.empty()) {
      out_.fixed_root = !root.free;
      out_.root_home = root.pose;
      out_.root_start = root.free ? root.start : root.pose;
      add_link(first);
    } else {
      add_world(false);
      link_of_[0] = 0;
      add_body(first);
    }
    for (std::size_t i = first + 1; i < file_.bodies.size(); ++i) {
      if (top_[i] == first) add_body(i);
    }
  }

  // a body below another one: its joints, and its link
  void add_body(std::size_t index) {
    const MjcfBody& b = body(index);
    const auto parent = static_cast<std::size_t>(b.parent);
    std::string from = out_.links[static_cast<std::size_t>(link_of_[parent])].name;
    Pose origin = b.pose;
    if (!moves(b) || b.free) {
      UrdfJoint joint;
      joint.name = unique_joint(b.name + (b.free ? "_free" : "_fixed"));
      joint.line = b.line;
      joint.type = b.free ? JointType::floating : JointType::fixed;
      joint.parent = from;
      joint.child = b.name;
      set_origin(joint, b.free ? b.start : origin);
      out_.joints.push_back(std::move(joint));
    }
    for (std::size_t j = 0; j < b.joints.size(); ++j) {
      const bool last = j + 1 == b.joints.size();
      UrdfJoint joint = converted(b.joints[j]);
      joint.parent = from;
      joint.child = last ? b.name : unique_link(fmt::format("{}_{}", b.name, b.joints[j].name));
      set_origin(joint, origin);
      origin = {};
      from = joint.child;
      if (!last) add_connector(b, from);
      out_.joints.push_back(std::move(joint));
    }
    add_link(index);
    // No joint connects them directly, so the pair would collide. In MuJoCo, too, bodies collide with static parents.
    if (b.joints.size() > 1 && !is_static(parent)) out_.exclusions.emplace_back(link_of_[parent], link_of_[index]);
  }

  void add_link(std::size_t index) {
    const MjcfBody& b = body(index);
    link_of_[index] = static_cast<int>(out_.links.size());
    UrdfLink link;
    link.name = b.name;
    link.line = b.line;
    if (b.inertial.mass > 0) link.inertial = urdf_inertial(b.inertial, 1);
    add_geoms(index, link);
    out_.links.push_back(std::move(link));
    for (const MjcfSite& site : b.sites) add_frame(site.name, link_of_[index], site.pose);
  }

  void add_connector(const MjcfBody& b, const std::string& name) {
    UrdfLink link;
    link.name = name;
    link.line = b.line;
    link.connector = true;
    link.inertial = b.inertial.mass > 0 ? urdf_inertial(b.inertial, kConnectorShare)
                                        : urdf_inertial({0.01, Vec3(0), Mat3(1e-5)}, 1);
    // a smaller mass can't be simulated
    constexpr double kMinMass = 2e-6;
    link.inertial->mass = std::max(link.inertial->mass, kMinMass);
    out_.links.push_back(std::move(link));
  }

  static UrdfInertial urdf_inertial(const Inertial& from, double share) {
    UrdfInertial out;
    out.mass = from.mass * share;
    out.origin.xyz = from.center;
    out.has_tensor = true;
    out.tensor = from.tensor * share;
    return out;
  }

  static void set_origin(UrdfJoint& joint, const Pose& pose) {
    joint.origin.xyz = pose.position;
    joint.origin.quat = pose.rotation;
  }

  // 0: not limited
  static double effort_of(const MjcfJoint& from) {
    if (from.largest_effort <= 0) return from.effort;
    return from.effort > 0 ? std::min(from.effort, from.largest_effort) : from.largest_effort;
  }

  // for report_joints()
  void count(const MjcfJoint& from) {
    if (!from.driven && from.type != JointType::spherical && !from.mimic) {
      if (passive_++ == 0) first_passive_ = &from;
    } else if (from.driven && effort_of(from) <= 0) {
      if (unlimited_++ == 0) first_unlimited_ = &from;
    }
    if (from.driven && from.spring.stiffness > 0 && sprung_++ == 0) first_sprung_ = &from;
  }

  UrdfJoint converted(const MjcfJoint& from) {
    UrdfJoint out;
    out.name = from.name;
    out.line = from.line;
    out.type = from.type == JointType::revolute && !from.limited ? JointType::continuous : from.type;
    out.anchor = from.anchor;
    out.axis = from.axis;
    out.limited = from.limited;
    out.lower = from.limited ? from.lower - from.reference : 0;
    out.upper = from.limited ? from.upper - from.reference : 0;
    out.effort = effort_of(from) > 0 ? effort_of(from) : kDefaultEffort;
    if (from.velocity > 0) out.velocity = from.velocity;
    out.damping = from.damping;
    out.friction = from.friction;
    out.armature = from.armature;
    if (from.largest_angle > 0) out.ball.angle = from.largest_angle;
    out.spring = from.driven ? from.gains : from.spring;
    out.start = from.start;
    out.start_rotation = from.start_rotation;
    out.driven = from.driven;
    out.mimic = from.mimic;
    count(from);
    return out;
  }

  void add_geoms(std::size_t index, UrdfLink& link) {
    bool collides = false;
    for (const MjcfGeom& geom : body(index).geoms) {
      const bool contact = geom.contact_type != 0 || geom.contact_affinity != 0;
      const bool visible = geom.group <= kLastVisibleGroup && geom.shape.material.alpha > 0;
      if (visible && (geom.shape.shape.kind != ShapeKind::plane || contact)) link.visuals.push_back(geom.shape);
      if (!contact) continue;
      collides = true;
      link.collisions.push_back(geom.shape);
      masks_[index].type |= geom.contact_type;
      masks_[index].affinity |= geom.contact_affinity;
    }
    if (collides) in_contact_.push_back(index);
  }

  void add_frame(const std::string& name, int link, const Pose& pose) {
    if (!frame_names_.insert(name).second) return;
    out_.frames.push_back({name, link, pose});
  }

  // those on bodies of the tree
  void add_sensors() {
    for (const MjcfSensor& from : file_.sensors) {
      const int link = link_of_[static_cast<std::size_t>(from.link)];
      if (link < 0) continue;
      out_.sensors.push_back(from);
      out_.sensors.back().link = link;
    }
  }

  // <exclude>, and pairs whose contact masks don't match
  void add_exclusions() {
    for (const auto& [a, b] : file_.exclusions) {
      const int link_a = link_of_[static_cast<std::size_t>(a)];
      const int link_b = link_of_[static_cast<std::size_t>(b)];
      if (link_a >= 0 && link_b >= 0) out_.exclusions.emplace_back(link_a, link_b);
    }
    std::map<ContactMask, std::vector<std::size_t>> by_mask;
    for (const std::size_t index : in_contact_) by_mask[masks_[index]].push_back(index);
    for (const auto& entry : by_mask) {
      const auto touches = [&](const auto& other) { return entry.first.touches(other.first); };
      if (std::any_of(by_mask.begin(), by_mask.end(), touches)) continue;
      for (const std::size_t index : entry.second) self_collision_off(index);
    }
    for (auto a = by_mask.begin(); a != by_mask.end(); ++a) {
      for (auto b = a; b != by_mask.end(); ++b) {
        if (!a->first.touches(b->first)) exclude(a->second, b->second);
      }
    }
  }

  void self_collision_off(std::size_t index) {
    out_.links[static_cast<std::size_t>(link_of_[index])].self_collision = false;
  }

  void exclude(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
    for (const std::size_t i : a) {
      for (const std::size_t j : b) {
        const UrdfLink& link_i = out_.links[static_cast<std::size_t>(link_of_[i])];
        const UrdfLink& link_j = out_.links[static_cast<std::size_t>(link_of_[j])];
        if (i >= j || !link_i.self_collision.value_or(true) || !link_j.self_collision.value_or(true)) continue;
        if (out_.exclusions.size() >= kMaxExclusions) return report_exclusions();
        out_.exclusions.emplace_back(link_of_[i], link_of_[j]);
      }
    }
  }

  void report_exclusions() {
    if (std::exchange(exclusions_reported_, true)) return;
    problems_.warning(
        body(0).line,
        fmt::format("more than {} pairs don't match by contype and conaffinity; the others collide", kMaxExclusions),
        "Set collision groups in the scene.");
  }

  void report_joints() {
    if (passive_ > 0) {
      problems_.note(
          first_passive_->line,
          fmt::format("{} no actuator and {} freely, first '{}'", counted(passive_, "joint has", "joints have"),
                      plural(passive_, "moves", "move"), printable(first_passive_->name)),
          "To drive a joint, set the mode of its motor in the scene.");
    }
    if (unlimited_ > 0) {
      problems_.note(first_unlimited_->line,
                     fmt::format("{} an actuator without a limit, first '{}'; using {:g} N·m or N",
                                 counted(unlimited_, "joint has", "joints have"), printable(first_unlimited_->name),
                                 kDefaultEffort),
                     "Write forcerange=\"…\" for the actuator.");
    }
  }

  void report_springs() {
    if (sprung_ == 0) return;
    problems_.warning(first_sprung_->line,
                      fmt::format("{} an actuator and a spring, first '{}'; the spring is ignored",
                                  counted(sprung_, "joint has", "joints have"), printable(first_sprung_->name)),
                      "Set the mode of the motor to \"spring\" in the scene, or remove the actuator.");
  }

  std::string unique_link(const std::string& base) { return unique(base, link_names_); }
  std::string unique_joint(const std::string& base) { return unique(base, joint_names_); }
  std::string unique(const std::string& base, std::set<std::string>& used) {
    if (used.empty()) {
      for (const MjcfBody& b : file_.bodies) {
        link_names_.insert(b.name);
        for (const MjcfJoint& j : b.joints) joint_names_.insert(j.name);
      }
      joint_names_.insert("");
    }
    const std::string stem(utf8_prefix(base, kMaxStem));
    std::string name = stem;
    while (!used.insert(name).second)
      name = fmt::format("{}_{}", stem, ++next_suffix_.try_emplace(stem, 1).first->second);
    return name;
  }

  const MjcfFile& file_;
  Problems& problems_;
  UrdfFile out_;
  std::vector<int> link_of_;             // by body: its link; -1: not part of the tree
  std::vector<ContactMask> masks_;       // by body
  std::vector<std::size_t> in_contact_;  // bodies with a geom that collides
  std::vector<std::size_t> top_;         // by body: its top-level body
  std::set<std::size_t> moving_;         // top-level bodies whose tree has a joint
  std::set<std::string> frame_names_, link_names_, joint_names_;
  std::map<std::string, int> next_suffix_;
  std::size_t passive_ = 0, unlimited_ = 0, sprung_ = 0;
  const MjcfJoint* first_passive_ = nullptr;
  const MjcfJoint* first_unlimited_ = nullptr;
  const MjcfJoint* first_sprung_ = nullptr;
  bool exclusions_reported_ = false;
};

/// Gives elements of one kind unique names.
class Namer {
 public:
  Namer(const char* kind, Problems& problems) : kind_(kind), problems_(problems) {}

  /// Makes `name` unique; an empty one starts with `base`.
  void complete(std::string& name, const std::string& base, int line) {
    if (!name.empty() && used_.insert(name).second) return;
    const std::string stem(utf8_prefix(base, kMaxStem));
    std::string next = stem;
    while (!used_.insert(next).second)
      next = fmt::format("{}_{}", stem, ++next_suffix_.try_emplace(stem, 1).first->second);
    if (!name.empty()) {
      problems_.error(
          line,
          fmt::format("{} '{}' is declared twice; the second is called '{}'", kind_, printable(name), printable(next)),
          fmt::format("Give every {} a name of its own.", kind_));
    }
    name = next;
  }

 private:
  const char* kind_;
  Problems& problems_;
  std::set<std::string> used_;
  std::map<std::string, int> next_suffix_;
};

}  // namespace

void complete_names(MjcfFile& file, Problems& problems) {
  Namer bodies("body", problems), joints("joint", problems);
  // names of the file have precedence over made-up ones
  for (MjcfBody& body : file.bodies) {
    if (!body.name.empty()) bodies.complete(body.name, body.name, body.line);
  }
  for (MjcfBody& body : file.bodies) {
    if (body.name.empty()) bodies.complete(body.name, "body", body.line);
  }
  for (const bool unnamed : {false, true}) {
    for (MjcfBody& body : file.bodies) {
      for (MjcfJoint& joint : body.joints) {
        if (joint.name.empty() == unnamed) joints.complete(joint.name, unnamed ? body.name : joint.name, joint.line);
      }
    }
  }
}

Result<UrdfFile> convert_mjcf(const MjcfFile& file, const std::string& root, Problems& problems) {
  return Converter(file, problems).run(root);
}

}  // namespace limber::model
