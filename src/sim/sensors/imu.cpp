// Imu: accelerometer and gyroscope at a place on a part.
#include <memory>
#include <string>
#include <utility>

#include "sim/bullet/island_world.h"
#include "sim/sensors/sensor.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

struct ImuProperties {
  const Property *position, *rotation, *specific_force, *angular_velocity;
};

const ImuProperties& imu_properties() {
  static const auto at = [](const char* name) { return &imu_table().at(name); };
  static const ImuProperties found{at("position"), at("rotation"), at("specific_force"), at("angular_velocity")};
  return found;
}

class Imu final : public Sensor {
 public:
  Imu(Part& part, NodeId group, std::string name) : Sensor(SensorKind::imu, part, group, std::move(name)) {}

  void begin_tick() override {
    last_ = motion();
    sum_ = Vec3(0);
    time_ = 0;
  }

  // The velocity of a step changes at once, so its mean acceleration acts between the orientations before and after it.
  void end_substep(double h) override {
    const State now = motion();
    const double sign = glm::dot(last_.rotation, now.rotation) < 0 ? -1 : 1;
    const Quat middle = glm::normalize(last_.rotation + sign * now.rotation);
    const Vec3 spin = 0.5 * (last_.spin + now.spin);
    const Vec3 angular_acceleration = (now.spin - last_.spin) / h;
    const Vec3 arm = vec3_at(setting(*imu_properties().position)) - part().geometry()->frame.position;
    const Vec3 of_center = glm::conjugate(middle) * ((now.velocity - last_.velocity) / h - gravity());
    sum_ += h * (of_center + glm::cross(angular_acceleration, arm) + glm::cross(spin, glm::cross(spin, arm)));
    time_ += h;
    last_ = now;
  }

  void end_tick(Sensing&) override {
    if (!(time_ > 0)) return;
    const Quat to_sensor = glm::conjugate(quat_at(setting(*imu_properties().rotation)));
    publish(*imu_properties().specific_force, to_sensor * (sum_ / time_));
    publish(*imu_properties().angular_velocity, to_sensor * motion().spin);
  }

 private:
  struct State {
    Quat rotation = quat_identity();  // of the link frame, world
    Vec3 velocity{0};                 // of the center of mass, world
    Vec3 spin{0};                     // angular velocity, link frame
  };

  State motion() const {
    const btRigidBody& rigid = part().rigid();
    State now;
    now.rotation = glm::normalize(bullet::from_bt(rigid.getWorldTransform().getRotation()) *
                                  glm::conjugate(part().geometry()->frame.rotation));
    now.velocity = bullet::from_bt(rigid.getLinearVelocity());
    now.spin = glm::conjugate(now.rotation) * bullet::from_bt(rigid.getAngularVelocity());
    return now;
  }
  Vec3 gravity() const {
    const btRigidBody& rigid = part().rigid();
    return bullet::from_bt(part().is_static() ? body().world().bullet().getGravity() : rigid.getGravity());
  }

  State last_;
  Vec3 sum_{0};  // of the present tick, m/s
  double time_ = 0;
};

}  // namespace

const PropertyTable& imu_table() {
  static const PropertyTable table(
      "imu", "/physics/body/<body>/sensor/<imu>", "",
      {
          vec3("position", "m", {0, 0, 0}, -1e4, 1e4, "Its place in the part's link frame."),
          quat("rotation", "Its axes in the part's link frame: x y z w."),
          transient(readout(vec3("specific_force", "m/s²", {0, 0, 0}, -kUnbounded, kUnbounded,
                                 "Acceleration without gravity, its own axes, mean of the last tick. At rest it points "
                                 "up with 9.81 m/s²; in free fall it is 0."))),
          transient(readout(vec3("angular_velocity", "rad/s", {0, 0, 0}, -kUnbounded, kUnbounded,
                                 "Angular velocity, its own axes, after the last tick."))),
      });
  return table;
}

std::unique_ptr<Sensor> create_imu(Part& part, NodeId group, std::string name) {
  return std::make_unique<Imu>(part, group, std::move(name));
}

}  // namespace limber::sim
