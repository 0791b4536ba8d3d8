// The text has generated names, because urdfdom formats names into its messages and looks shapes up by them.
#include "urdfdom_reference.h"

#include <cmath>
#include <exception>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

namespace limber::model::test {

namespace {

std::string vec(const Vec3& v) { return fmt::format("{:.17g} {:.17g} {:.17g}", v.x, v.y, v.z); }
std::string origin_text(const UrdfOrigin& o) {
  // urdfdom 1.0 reads no quaternions
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", vec(o.xyz), vec(o.quat ? euler_of(*o.quat) : o.rpy));
}

// urdfdom supports neither capsules nor planes: they are written as similar shapes, so that the counts are comparable
std::string geometry_text(const ShapeModel& s) {
  switch (s.kind) {
    case ShapeKind::sphere:
      return fmt::format("<sphere radius=\"{:.17g}\"/>", s.radius);
    case ShapeKind::box:
      return fmt::format("<box size=\"{}\"/>", vec(s.size));
    case ShapeKind::cylinder:
    case ShapeKind::capsule:
      return fmt::format("<cylinder radius=\"{:.17g}\" length=\"{:.17g}\"/>", s.radius, s.height);
    case ShapeKind::mesh:
      return "<mesh filename=\"m\"/>";
    default:
      return "<box size=\"1 1 1\"/>";
  }
}

void write_link(const UrdfLink& link, std::size_t at, std::string& out) {
  out += fmt::format("<link name=\"l{}\">", at);
  if (link.inertial) {
    const Mat3& t = link.inertial->tensor;
    out += fmt::format(
        "<inertial>{}<mass value=\"{:.17g}\"/><inertia ixx=\"{:.17g}\" ixy=\"{:.17g}\" ixz=\"{:.17g}\" iyy=\"{:.17g}\" "
        "iyz=\"{:.17g}\" izz=\"{:.17g}\"/></inertial>",
        origin_text(link.inertial->origin), link.inertial->mass, t[0][0], t[0][1], t[0][2], t[1][1], t[1][2], t[2][2]);
  }
  const auto shapes = [&](const std::vector<UrdfShape>& list, const char* kind) {
    for (const UrdfShape& s : list) {
      out += fmt::format("<{0}>{1}<geometry>{2}</geometry></{0}>", kind, origin_text(s.origin), geometry_text(s.shape));
    }
  };
  shapes(link.visuals, "visual");
  shapes(link.collisions, "collision");
  out += "</link>\n";
}

void write_joint(const UrdfJoint& j, std::size_t at, int parent, std::string& out) {
  out += fmt::format(
      "<joint name=\"j{0}\" type=\"{1}\"><parent link=\"l{2}\"/><child link=\"l{0}\"/>{3}<axis xyz=\"{4}\"/>", at,
      joint_type_name(j.type), parent, origin_text(j.origin), vec(j.axis));
  if (j.type == JointType::revolute || j.type == JointType::prismatic || j.type == JointType::continuous) {
    out += fmt::format("<limit lower=\"{:.17g}\" upper=\"{:.17g}\" effort=\"{:.17g}\" velocity=\"{:.17g}\"/>", j.lower,
                       j.upper, j.effort.value_or(0), j.velocity.value_or(0));
  }
  if (j.type != JointType::fixed) {
    out += fmt::format("<dynamics damping=\"{:.17g}\" friction=\"{:.17g}\"/>", j.damping, j.friction);
  }
  out += "</joint>\n";
}

bool nearly_equal(double a, double b) {
  return std::abs(a - b) <= 1e-12 * std::max(1.0, std::max(std::abs(a), std::abs(b)));
}
bool nearly_equal(const Vec3& a, const urdf::Vector3& b) {
  return nearly_equal(a.x, b.x) && nearly_equal(a.y, b.y) && nearly_equal(a.z, b.z);
}

bool matches(const UrdfLink& ours, const urdf::Link& theirs) {
  const bool inertial = ours.inertial.has_value() == (theirs.inertial != nullptr) &&
                        (!ours.inertial || (nearly_equal(ours.inertial->mass, theirs.inertial->mass) &&
                                            nearly_equal(ours.inertial->origin.xyz, theirs.inertial->origin.position)));
  return inertial && ours.visuals.size() == theirs.visual_array.size() &&
         ours.collisions.size() == theirs.collision_array.size();
}

bool matches(const UrdfJoint& ours, const urdf::Joint& theirs) {
  const urdf::Pose& pose = theirs.parent_to_joint_origin_transform;
  const Quat q = ours.origin.pose().rotation;
  double x = 0, y = 0, z = 0, w = 1;
  pose.rotation.getQuaternion(x, y, z, w);
  const bool turned = std::abs(std::abs(q.x * x + q.y * y + q.z * z + q.w * w) - 1) < 1e-9;
  const bool axis =
      ours.type == JointType::fixed || ours.type == JointType::floating || nearly_equal(ours.axis, theirs.axis);
  const bool limits = !ours.limited || (theirs.limits && nearly_equal(ours.lower, theirs.limits->lower) &&
                                        nearly_equal(ours.upper, theirs.limits->upper));
  return nearly_equal(ours.origin.xyz, pose.position) && turned && axis && limits;
}

urdf::ModelInterfaceSharedPtr parse(std::string text) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
  text.append(8, '\0');  // it reads past the end of the buffer
  try {
    return urdf::parseURDF(text);
  } catch (const std::exception&) {
    return nullptr;
  }
}

}  // namespace

std::vector<std::string> urdfdom_differences(const UrdfFile& file, const std::vector<UrdfNode>& tree) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n";
  for (std::size_t i = 0; i < tree.size(); ++i) {
    write_link(file.links[static_cast<std::size_t>(tree[i].link)], i, text);
    if (tree[i].joint >= 0) write_joint(file.joints[static_cast<std::size_t>(tree[i].joint)], i, tree[i].parent, text);
  }
  const urdf::ModelInterfaceSharedPtr model = parse(text + "</robot>\n");
  if (!model) return {"urdfdom rejects the file"};
  std::vector<std::string> differences;
  if (model->links_.size() != tree.size() || model->joints_.size() + 1 != tree.size()) {
    differences.push_back(fmt::format("urdfdom finds {} links and {} joints, expected {} and {}", model->links_.size(),
                                      model->joints_.size(), tree.size(), tree.size() - 1));
  }
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const UrdfLink& link = file.links[static_cast<std::size_t>(tree[i].link)];
    const urdf::LinkConstSharedPtr theirs = model->getLink(fmt::format("l{}", i));
    if (!theirs || !matches(link, *theirs)) differences.push_back(fmt::format("link '{}'", link.name));
    if (tree[i].joint < 0) continue;
    const UrdfJoint& joint = file.joints[static_cast<std::size_t>(tree[i].joint)];
    const urdf::JointConstSharedPtr other = model->getJoint(fmt::format("j{}", i));
    if (!other || !matches(joint, *other)) differences.push_back(fmt::format("joint '{}'", joint.name));
  }
  return differences;
}

}  // namespace limber::model::test
