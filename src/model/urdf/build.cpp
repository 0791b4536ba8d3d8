// Structure of the body: links, merging of fixed links, joint frames and limits.
#include "model/urdf/build.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/mesh/surface.h"

namespace limber::model {

namespace {

// Root links that are fixed to the world collide with the triangles of concave meshes.
bool collides_as_surface(const UrdfBuildContext& build, std::size_t node, const UrdfShape& shape) {
  return shape.concave && shape.shape.kind == ShapeKind::mesh && build.body_link[node] == 0 && is_root_fixed(build);
}

PlacedShape placed(const UrdfShape& from, const Pose& offset, bool collides) {
  PlacedShape out;
  out.shape = from.shape;
  out.origin = offset * from.origin.pose();
  // a texture replaces the color, except its alpha
  if (out.shape.texture == nullptr) out.color = from.material.color;
  out.alpha = from.material.alpha;
  out.shape.mesh_colors = from.material.keeps_mesh_colors() && out.shape.texture == nullptr;
  if (!collides || !from.shape.mesh || from.shape.surface != nullptr || !from.shape.mesh->primitive) return out;
  // a mesh recognized as a box, sphere or capsule collides as that primitive, at the primitive's pose
  const PlacedShape& primitive = *from.shape.mesh->primitive;
  out.shape = primitive.shape;
  out.shape.mesh = from.shape.mesh;
  out.shape.mesh_pose = primitive.origin.inverse();
  out.origin = out.origin * primitive.origin;
  return out;
}

void add_shapes(UrdfBuildContext& build, std::size_t node) {
  LinkModel& to = build.model.links[static_cast<std::size_t>(build.body_link[node])];
  const UrdfLink& from = build.link(node);
  for (const UrdfShape& s : from.collisions) {
    UrdfShape shape = s;
    if (collides_as_surface(build, node, s)) {
      shape.shape.surface = std::make_shared<Surface>(s.shape.mesh);
    } else if (s.shape.kind == ShapeKind::mesh) {
      const std::string owner = fmt::format("link '{}'", printable(from.name));
      if (s.concave) build.meshes.decompose(shape, owner);
      build.meshes.report_collision(shape, owner);
    }
    to.collisions.push_back(placed(shape, build.offset[node], true));
  }
  for (const UrdfShape& s : from.visuals) to.visuals.push_back(placed(s, build.offset[node], false));
}

JointModel make_joint(UrdfBuildContext& build, std::size_t node) {
  const UrdfJoint& from = build.joint(node);
  const auto parent = static_cast<std::size_t>(build.tree[node].parent);
  const bool has_axis = from.type != JointType::fixed && from.type != JointType::floating;
  const Quat rotation = has_axis ? rotation_to_axis(from.axis) : quat_identity();
  JointModel out;
  out.name = from.name;
  out.type = from.type;
  out.parent = build.body_link[parent];
  out.child = build.body_link[node];
  out.frame_in_parent = build.offset[parent] * from.origin.pose() * Pose{from.anchor, rotation};
  out.frame_in_child = {from.anchor, rotation};
  out.limited = from.limited;
  out.lower = from.lower;
  out.upper = from.upper;
  out.velocity = from.velocity.value_or(0);
  out.damping = from.damping;
  out.friction = from.friction;
  out.armature = from.armature;
  out.ball = from.ball;
  out.spring = from.spring;
  out.start = from.start;
  out.driven = from.driven;
  if (from.effort.value_or(0) > 0) out.effort = *from.effort;
  return out;
}

/// Joints that get the same motor, for a note.
struct MotorGroup {
  std::size_t count = 0;
  const UrdfJoint* first = nullptr;

  void add(const UrdfJoint& joint) {
    if (count++ == 0) first = &joint;
  }
  /// "2 joints have effort 0, first 'a'"
  std::string text(const char* what) const {
    return fmt::format("{} {}, first '{}'", counted(count, "joint has", "joints have"), what, printable(first->name));
  }
};

bool has_motor(const UrdfJoint& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::continuous || joint.type == JointType::prismatic;
}

void report_motors(UrdfBuildContext& build, const MotorGroup& passive, const MotorGroup& without,
                   const MotorGroup& unlimited) {
  if (passive.count > 0) {
    build.problems.note(passive.first->line,
                        fmt::format("{}, and {} no motor, because other joints have effort", passive.text("effort 0"),
                                    passive.count == 1 ? "gets" : "get"),
                        "Load with motors = \"servo\" to drive all joints.");
  }
  if (without.count > 0) {
    build.problems.note(without.first->line,
                        fmt::format("{}; {} a servo of {:g} N·m or N", without.text("no effort"),
                                    without.count == 1 ? "it gets" : "each gets", JointModel().effort),
                        "Write <limit effort=\"…\"/> with the motor's largest torque or force.");
  }
  if (unlimited.count > 0) {
    build.problems.note(unlimited.first->line, unlimited.text("velocity 0") + ", which means no limit",
                        "Write <limit velocity=\"…\"/> in rad/s or m/s.");
  }
}

/// Decides which joints without effort have a motor: a written effort of 0 means none, as for wheels and casters, if
/// another joint has effort. All others get the default effort.
void choose_motors(UrdfBuildContext& build) {
  bool has_effort = false;
  for (std::size_t node = 1; node < build.tree.size(); ++node)
    has_effort = has_effort || build.joint(node).effort.value_or(0) > 0;
  MotorGroup passive, without, unlimited;
  for (std::size_t node = 1; node < build.tree.size(); ++node) {
    const UrdfJoint& from = build.joint(node);
    if (!has_motor(from) || build.body_joint[node] < 0) continue;
    if (from.velocity == 0) unlimited.add(from);
    if (from.effort.value_or(0) > 0) continue;
    const bool is_passive = has_effort && from.effort.has_value();
    if (is_passive) build.model.joints[static_cast<std::size_t>(build.body_joint[node])].driven = false;
    (is_passive ? passive : without).add(from);
  }
  report_motors(build, passive, without, unlimited);
}

// Adds a tendon with the points that are on links of the tree, if they are on at least two links.
void add_tendon(UrdfBuildContext& build, const TendonModel& from, const std::vector<int>& node_of_link) {
  TendonModel tendon = from;
  tendon.points.clear();
  for (const TendonModel::Point& point : from.points) {
    const int node = node_of_link[static_cast<std::size_t>(point.link)];
    if (node < 0) continue;
    const auto at = static_cast<std::size_t>(node);
    tendon.points.push_back({build.body_link[at], build.offset[at] * point.position});
  }
  const bool connects = std::any_of(tendon.points.begin(), tendon.points.end(), [&](const TendonModel::Point& point) {
    return point.link != tendon.points.front().link;
  });
  if (connects) build.model.tendons.push_back(std::move(tendon));
}

// frames and sensors on links, tendons, and pairs of links that don't collide
void add_frames_and_exclusions(UrdfBuildContext& build) {
  if (build.file.frames.empty() && build.file.exclusions.empty() && build.file.tendons.empty() &&
      build.file.sensors.empty())
    return;
  std::vector<int> node_of_link(build.file.links.size(), -1);
  for (std::size_t node = 0; node < build.tree.size(); ++node)
    node_of_link[static_cast<std::size_t>(build.tree[node].link)] = static_cast<int>(node);
  for (const UrdfFrame& frame : build.file.frames) {
    const int node = node_of_link[static_cast<std::size_t>(frame.link)];
    if (node < 0) continue;
    const auto at = static_cast<std::size_t>(node);
    build.model.merged.push_back({frame.name, build.body_link[at], build.offset[at] * frame.pose, true});
  }
  for (const TendonModel& tendon : build.file.tendons) add_tendon(build, tendon, node_of_link);
  for (const SensorModel& sensor : build.file.sensors) {
    const int node = node_of_link[static_cast<std::size_t>(sensor.link)];
    if (node < 0) continue;
    SensorModel& out = build.model.sensors.emplace_back(sensor);
    out.link = build.body_link[static_cast<std::size_t>(node)];
    out.pose = build.offset[static_cast<std::size_t>(node)] * sensor.pose;
  }
  for (const auto& [a, b] : build.file.exclusions) {
    const int node_a = node_of_link[static_cast<std::size_t>(a)];
    const int node_b = node_of_link[static_cast<std::size_t>(b)];
    if (node_a < 0 || node_b < 0) continue;
    const int link_a = build.body_link[static_cast<std::size_t>(node_a)];
    const int link_b = build.body_link[static_cast<std::size_t>(node_b)];
    if (link_a != link_b) build.model.exclusions.emplace_back(std::minmax(link_a, link_b));
  }
  std::sort(build.model.exclusions.begin(), build.model.exclusions.end());
  const auto end = std::unique(build.model.exclusions.begin(), build.model.exclusions.end());
  build.model.exclusions.erase(end, build.model.exclusions.end());
}

bool is_merged(UrdfBuildContext& build, std::size_t node) {
  if (build.tree[node].joint < 0 || build.joint(node).type != JointType::fixed) return false;
  if (!build.options.keep_fixed) return true;
  const UrdfLink& link = build.link(node);
  if (is_marker(link)) return true;
  if (link.inertial && link.inertial->mass > 0) return false;
  build.problems.note(
      link.line,
      fmt::format("link '{}' has no mass; merged into its parent in spite of keep_fixed", printable(link.name)),
      "Give it an <inertial> with a mass to keep it apart.");
  return true;
}

}  // namespace

Quat rotation_to_axis(const Vec3& axis) {
  if (axis.z >= 1 - 1e-15 && fixed::hypot(axis.x, axis.y) < 1e-12) return quat_identity();
  if (axis.z <= -1 + 1e-15 && fixed::hypot(axis.x, axis.y) < 1e-12) return quat_xyzw(1, 0, 0, 0);
  const Vec3 helper = std::abs(axis.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = normalized(glm::cross(axis, helper));
  return glm::normalize(glm::quat_cast(Mat3(glm::cross(y, axis), y, axis)));
}

bool is_marker(const UrdfLink& link) {
  return link.inertial && link.inertial->mass > 0 && link.inertial->mass <= kMaxMarkerMass && link.collisions.empty() &&
         link.visuals.empty();
}

void build_structure(UrdfBuildContext& build) {
  const std::size_t count = build.tree.size();
  build.body_link.assign(count, -1);
  build.body_joint.assign(count, -1);
  build.offset.assign(count, Pose{});
  for (std::size_t node = 0; node < count; ++node) {
    if (is_merged(build, node)) {
      const auto parent = static_cast<std::size_t>(build.tree[node].parent);
      build.body_link[node] = build.body_link[parent];
      build.offset[node] = build.offset[parent] * build.joint(node).origin.pose();
      build.model.merged.push_back({build.link(node).name, build.body_link[node], build.offset[node], false});
      const LinkModel& carrier = build.model.links[static_cast<std::size_t>(build.body_link[node])];
      if (!build.link(node).self_collision.value_or(true) && carrier.self_collision) {
        build.problems.warning(build.link(node).line,
                               fmt::format("link '{}': <selfCollide> false ignored: it is merged into '{}'",
                                           printable(build.link(node).name), printable(carrier.name)),
                               "Write it for that link, or keep fixed joints (keep_fixed).");
      }
    } else {
      build.body_link[node] = static_cast<int>(build.model.links.size());
      LinkModel& link = build.model.links.emplace_back();
      link.name = build.link(node).name;
      link.self_collision = build.link(node).self_collision.value_or(true);
      if (build.tree[node].joint >= 0) {
        build.body_joint[node] = static_cast<int>(build.model.joints.size());
        build.model.joints.push_back(make_joint(build, node));
      }
    }
    add_shapes(build, node);
  }
  choose_motors(build);
  add_frames_and_exclusions(build);
}

Result<void> build_body(UrdfBuildContext& build) {
  build_structure(build);
  build_masses(build);
  if (Result<void> posed = build_poses(build); !posed) return posed;
  build_loops(build);
  build_collisions(build);
  return {};
}

}  // namespace limber::model
