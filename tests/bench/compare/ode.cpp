// ODE: boxes on hinges with motors that follow the law of Bullet's servo; default error reduction, softness and
// iterations. World step: one dense matrix, solved exactly; quick step: twenty sweeps.
#include <algorithm>
#include <array>
#include <utility>

#include <ode/ode.h>

#include "bench/compare/contender.h"

namespace limber {
namespace {

constexpr unsigned kFloor = 1;
constexpr unsigned kPart = 2;
constexpr double kFriction = 0.8;

class OdeContender : public Contender {
 public:
  OdeContender(const RawScene& scene, bool quick) : scene_(scene), quick_(quick) {
    dWorldSetGravity(world_, scene.gravity.x, scene.gravity.y, scene.gravity.z);
    for (const RawPart& part : scene.parts) add_part(part);
    for (const RawJoint& joint : scene.joints) add_joint(joint);
    if (!scene.floor) return;
    dGeomID floor = dCreatePlane(space_, 0, 0, 1, 0);
    dGeomSetCategoryBits(floor, kFloor);
    dGeomSetCollideBits(floor, kPart);
  }
  ~OdeContender() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  OdeContender(const OdeContender&) = delete;
  OdeContender& operator=(const OdeContender&) = delete;

  void step() override {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const RawJoint& joint = scene_.joints[i];
      if (joint.force <= 0) continue;
      const double rate = kServoShare * (joint.target(time_) - dJointGetHingeAngle(joints_[i])) / scene_.step;
      dJointSetHingeParam(joints_[i], dParamVel, std::clamp(rate, -joint.speed, joint.speed));
    }
    dSpaceCollide(space_, this, &OdeContender::on_near_pair);
    if (quick_) {
      dWorldQuickStep(world_, scene_.step);
    } else {
      dWorldStep(world_, scene_.step);
    }
    dJointGroupEmpty(contacts_);
    time_ += scene_.step;
  }
  Pose pose(int part) const override {
    dBodyID body = bodies_[static_cast<std::size_t>(part)];
    if (body == nullptr) return scene_.parts[static_cast<std::size_t>(part)].pose;
    const dReal* p = dBodyGetPosition(body);
    const dReal* q = dBodyGetQuaternion(body);
    return {{p[0], p[1], p[2]}, quat_xyzw(q[1], q[2], q[3], q[0])};
  }

 private:
  void add_part(const RawPart& part) {
    bodies_.push_back(nullptr);
    // static parts carry others and don't collide
    if (part.mass <= 0) return;
    dBodyID body = bodies_.back() = dBodyCreate(world_);
    dMass mass;
    dMassSetBoxTotal(&mass, part.mass, part.size.x, part.size.y, part.size.z);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, part.pose.position.x, part.pose.position.y, part.pose.position.z);
    const Quat& q = part.pose.rotation;
    const dQuaternion rotation = {q.w, q.x, q.y, q.z};
    dBodySetQuaternion(body, rotation);
    dGeomID box = dCreateBox(space_, part.size.x, part.size.y, part.size.z);
    dGeomSetBody(box, body);
    dGeomSetCategoryBits(box, kPart);
    dGeomSetCollideBits(box, kFloor);
  }
  void add_joint(const RawJoint& joint) {
    dJointID hinge = dJointCreateHinge(world_, nullptr);
    // the angle is of the first part relative to the second
    dJointAttach(hinge, bodies_[static_cast<std::size_t>(joint.child)],
                 bodies_[static_cast<std::size_t>(joint.parent)]);
    dJointSetHingeAnchor(hinge, joint.position.x, joint.position.y, joint.position.z);
    dJointSetHingeAxis(hinge, joint.axis.x, joint.axis.y, joint.axis.z);
    if (joint.lower <= joint.upper) {
      dJointSetHingeParam(hinge, dParamLoStop, joint.lower);
      dJointSetHingeParam(hinge, dParamHiStop, joint.upper);
    }
    dJointSetHingeParam(hinge, dParamFMax, joint.force);
    joints_.push_back(hinge);
  }
  static void on_near_pair(void* self, dGeomID a, dGeomID b) {
    const auto& me = *static_cast<OdeContender*>(self);
    std::array<dContact, 8> contacts{};
    const int count = dCollide(a, b, static_cast<int>(contacts.size()), &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      dContact& contact = contacts[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = kFriction;
      dJointAttach(dJointCreateContact(me.world_, me.contacts_, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  RawScene scene_;
  bool quick_;
  double time_ = 0;
  dWorldID world_ = dWorldCreate();
  dSpaceID space_ = dSimpleSpaceCreate(nullptr);
  dJointGroupID contacts_ = dJointGroupCreate(0);
  std::vector<dBodyID> bodies_;
  std::vector<dJointID> joints_;
};

}  // namespace

std::vector<ContenderFactory> ode_contenders() {
  static const int started = dInitODE2(0);
  if (started == 0) return {};
  const auto ode = [](bool quick) {
    return [quick](const RawScene& scene) { return std::make_unique<OdeContender>(scene, quick); };
  };
  return {{"ODE, world step", ode(false)}, {"ODE, quick step, 20 sweeps", ode(true)}};
}

}  // namespace limber
