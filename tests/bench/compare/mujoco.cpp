// MuJoCo: joints are its coordinates, so they have no gaps. A servo is a position actuator, kp·(target - angle), with
// damping kd = kp·h/0.9, so that a stiff one approaches its target at the rate of Limber's. It has no maximal speed.
// With the Euler integrator, the damping belongs to the joint, where it is implicit, and the force is unbounded,
// because the bound would not include the damping. With the implicit integrator, both belong to the actuator and are
// within the servo's force.
#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "bench/compare/contender.h"

namespace limber {
namespace {

std::string xml_numbers(const Vec3& v) { return fmt::format("{:.17g} {:.17g} {:.17g}", v.x, v.y, v.z); }
std::string xml_numbers(const Quat& q) { return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w, q.x, q.y, q.z); }

// A scene in MuJoCo's XML: bodies nested along the joints, with frames at the centers of mass.
class MujocoXml {
 public:
  MujocoXml(const RawScene& scene, double kp, bool implicit)
      : scene_(scene), kp_(kp), kd_(kp * scene.step / kServoShare), implicit_(implicit) {
    text_ = fmt::format(
        "<mujoco><compiler angle='radian'/><option timestep='{:.17g}' gravity='{}' integrator='{}'/><worldbody>",
        scene.step, xml_numbers(scene.gravity), implicit ? "implicit" : "Euler");
    if (scene.floor) text_ += "<geom type='plane' size='0 0 1' contype='1' conaffinity='0' friction='0.8 0 0'/>";
    // static parts belong to the world body
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      if (scene.parts[i].mass <= 0) add_children(static_cast<int>(i), {});
    }
    text_ += "</worldbody><actuator>";
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
      if (scene.joints[i].force > 0) add_servo(i, scene.joints[i].force);
    }
    text_ += "</actuator></mujoco>";
  }
  const std::string& text() const { return text_; }

 private:
  void add_children(int parent, const Pose& parent_frame) {
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
      if (scene_.joints[i].parent == parent) add_child(i, parent_frame);
    }
  }
  void add_child(std::size_t i, const Pose& parent_frame) {
    const RawJoint& joint = scene_.joints[i];
    const RawPart& part = scene_.parts[static_cast<std::size_t>(joint.child)];
    const Pose frame = parent_frame.inverse() * part.pose;
    const Vec3 s = part.size * part.size;
    text_ += fmt::format("<body name='p{}' pos='{}' quat='{}'><inertial pos='0 0 0' mass='{:.17g}' diaginertia='{}'/>",
                         joint.child, xml_numbers(frame.position), xml_numbers(frame.rotation), part.mass,
                         xml_numbers(part.mass / 12 * Vec3(s.y + s.z, s.x + s.z, s.x + s.y)));
    const double damping = joint.force > 0 && !implicit_ ? kd_ : 0;
    text_ += fmt::format("<joint name='j{}' pos='{}' axis='{}' damping='{}'", i,
                         xml_numbers(part.pose.inverse() * joint.position),
                         xml_numbers(glm::conjugate(part.pose.rotation) * joint.axis), damping);
    if (joint.lower <= joint.upper) text_ += fmt::format(" limited='true' range='{} {}'", joint.lower, joint.upper);
    text_ += fmt::format("/><geom type='box' size='{}' contype='0' conaffinity='1' friction='0.8 0 0'/>",
                         xml_numbers(part.size * 0.5));
    add_children(joint.child, part.pose);
    text_ += "</body>";
  }

  void add_servo(std::size_t joint, double force) {
    text_ += fmt::format("<general joint='j{}' gainprm='{:.17g}' biastype='affine' biasprm='0 {:.17g} {:.17g}'", joint,
                         kp_, -kp_, implicit_ ? -kd_ : 0);
    if (implicit_) text_ += fmt::format(" forcelimited='true' forcerange='{} {}'", -force, force);
    text_ += "/>";
  }

  const RawScene& scene_;
  double kp_;
  double kd_;
  bool implicit_;
  std::string text_;
};

struct Free {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

std::unique_ptr<mjModel, Free> compile_model(const std::string& text) {
  constexpr const char* kName = "scene.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[500] = "";
  std::unique_ptr<mjModel, Free> model(mj_loadXML(kName, files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) mju_error(error);
  return model;
}

class MujocoContender : public Contender {
 public:
  MujocoContender(const RawScene& scene, double kp, bool implicit)
      : scene_(scene), model_(compile_model(MujocoXml(scene, kp, implicit).text())), data_(mj_makeData(model_.get())) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      bodies_.push_back(std::max(0, mj_name2id(model_.get(), mjOBJ_BODY, fmt::format("p{}", i).c_str())));
    }
    for (const RawJoint& joint : scene.joints) {
      if (joint.force > 0) driven_.push_back(joint);
    }
    mj_forward(model_.get(), data_.get());
  }
  void step() override {
    const double time = scene_.step * steps_;
    for (std::size_t i = 0; i < driven_.size(); ++i) data_->ctrl[i] = driven_[i].target(time);
    const double before = data_->time;
    mj_step(model_.get(), data_.get());
    // MuJoCo resets a diverging simulation silently
    resets_ += data_->time > before ? 0 : 1;
    ++steps_;
  }
  Pose pose(int part) const override {
    const std::ptrdiff_t body = bodies_[static_cast<std::size_t>(part)];
    if (body == 0) return scene_.parts[static_cast<std::size_t>(part)].pose;
    // after a step, MuJoCo still has the poses of its beginning
    if (steps_at_kinematics_ != steps_) mj_kinematics(model_.get(), data_.get());
    steps_at_kinematics_ = steps_;
    const mjtNum* p = data_->xpos + 3 * body;
    const mjtNum* q = data_->xquat + 4 * body;
    return {{p[0], p[1], p[2]}, quat_xyzw(q[1], q[2], q[3], q[0])};
  }
  std::string note() const override {
    return resets_ > 0 ? fmt::format("diverged and was reset {} times in {} steps", resets_, steps_) : std::string();
  }

 private:
  RawScene scene_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::vector<int> bodies_;  // 0: the world
  std::vector<RawJoint> driven_;
  int steps_ = 0;
  int resets_ = 0;
  mutable int steps_at_kinematics_ = 0;
};

}  // namespace

std::vector<ContenderFactory> mujoco_contenders() {
  // its warnings would create a file
  mju_user_warning = [](const char*) {};
  std::vector<ContenderFactory> all;
  for (const double kp : {2e4, 2e6}) {
    for (const bool implicit : {false, true}) {
      all.push_back({fmt::format("MuJoCo, {}, kp {:.0e}", implicit ? "implicit" : "Euler", kp),
                     [=](const RawScene& scene) { return std::make_unique<MujocoContender>(scene, kp, implicit); }});
    }
  }
  return all;
}

}  // namespace limber
