// MocapJoint: its properties, and its motion within limits.
#include "sim/mocap/mocap_joint.h"

#include <algorithm>
#include <utility>

#include "sim/mocap/mocap_source.h"

namespace limber::sim {

namespace {

using namespace properties;

constexpr double kMaxInterval = 0.25;    // s: a longer pause is a loss, and doesn't count as an interval
constexpr double kIntervalWeight = 0.2;  // of the newest interval in the mean

struct MocapJointProperties {
  const Property *position, *rotation, *local_rotation, *velocity, *speed, *age, *confidence, *contact;
};

const MocapJointProperties& mocap_joint_properties() {
  static const auto at = [](const char* name) { return &MocapJoint::table().at(name); };
  static const MocapJointProperties found{at("position"), at("rotation"), at("local_rotation"), at("velocity"),
                                          at("speed"),    at("age"),      at("confidence"),     at("contact")};
  return found;
}

double angle_between(const Quat& a, const Quat& b) { return 2 * fixed::acos(std::min(std::abs(glm::dot(a, b)), 1.0)); }

Quat turned_towards(const Quat& from, const Quat& to, double amount, double max_turn) {
  const double angle = angle_between(from, to);
  if (angle * amount > max_turn) amount = max_turn / angle;
  return amount >= 1 ? to : slerp(from, to, amount);
}

}  // namespace

const PropertyTable& MocapJoint::table() {
  constexpr double kFar = kUnbounded;
  static const PropertyTable table(
      "mocap_joint", "/physics/mocap/<mocap>/joint/<joint>", "",
      {
          hashed(transient(readout(vec3("position", "m", {0, 0, 0}, -kFar, kFar, "Place on stage, world axes.")))),
          hashed(transient(readout(quat("rotation", "Rotation on stage.")))),
          transient(readout(quat("local_rotation", "Rotation relative to its parent."))),
          transient(readout(vec3("velocity", "m/s", {0, 0, 0}, -kFar, kFar, "Velocity on stage."))),
          transient(readout(number("speed", "m/s", 0, 0, kFar, "Magnitude of its velocity."))),
          transient(readout(number("age", "s", -1, -1, kFar, "Time since its last sample; -1: there was none."))),
          transient(readout(number("confidence", "", 0, 0, 1,
                                   "1: tracked; 0: not seen yet. After a loss it falls to 0 over the source's fade."))),
          computed<&MocapJoint::read_number>(
              readout(integer("number", 1, 1, kFar, "Its number among the joints of its source, for behaviors."))),
          transient(readout(boolean("contact", false, "True if it is slow and near the floor."))),
      });
  return table;
}

MocapJoint::MocapJoint(MocapSource& source, NodeId group, std::string name, std::size_t index)
    : source_(source), id_(source.store().add(table(), group, std::move(name), this)), index_(index) {}

MocapJoint::~MocapJoint() { source_.store().remove(id_); }

const std::string& MocapJoint::name() const { return std::as_const(source_.store()).name(id_); }

void MocapJoint::count_sample(double time) {
  const double gap = time - state_.sampled_at;
  if (seen() && gap > 0 && gap <= kMaxInterval) {
    state_.interval += (state_.interval == 0 ? 1 : kIntervalWeight) * (gap - state_.interval);
  }
  state_.remaining = state_.interval;
  state_.sampled_at = time;
}

void MocapJoint::accept(const MocapSample& sample, const MocapAxes& axes, double time) {
  bool moved = false;
  if (sample.position) {
    state_.raw.position = axes.position(*sample.position);
    state_.is_local = false;
    moved = true;
  }
  if (sample.rotation) state_.raw.rotation = axes.rotation(*sample.rotation);
  if (sample.local_position) {
    state_.raw_local.position = axes.position(*sample.local_position);
    state_.has_local_position = true;
    // places in the world take precedence if a source sends both
    state_.is_local = state_.is_local || !seen();
    moved = true;
  }
  if (sample.local_rotation) {
    state_.raw_local.rotation = axes.rotation(*sample.local_rotation);
    state_.has_local_rotation = true;
  }
  if (sample.confidence) state_.confidence = *sample.confidence;
  if (moved) count_sample(time);
}

void MocapJoint::set_local(const Pose& pose, double time) {
  state_.raw_local = pose;
  state_.has_local_position = state_.has_local_rotation = state_.is_local = true;
  state_.sampled_at = time;
  state_.remaining = 0;
}

Pose MocapJoint::raw_pose(const Pose* parent) const {
  if (!state_.is_local) return state_.raw;
  return parent == nullptr ? state_.raw_local : *parent * state_.raw_local;
}

void MocapJoint::move(const Pose& raw, const MocapJoint* parent, const MocapMotion& motion) {
  const Pose target = motion.stage * Pose{raw.position * motion.scale, raw.rotation};
  const Pose before = state_.pose;
  const bool first = !std::exchange(state_.placed, true);
  // the sample is reached when the next one is due, so that a slow source moves evenly
  const double amount = state_.remaining > motion.dt ? motion.dt / state_.remaining : 1;
  state_.remaining = std::max(state_.remaining - motion.dt, 0.0);
  if (first) {
    state_.pose = target;
  } else {
    Vec3 step = (target.position - before.position) * amount;
    if (const double length = glm::length(step); length > motion.max_step) step *= motion.max_step / length;
    state_.pose.position = before.position + step;
    state_.pose.rotation = turned_towards(before.rotation, target.rotation, amount, motion.max_turn);
  }
  const Vec3 velocity = first ? Vec3(0) : (state_.pose.position - before.position) / motion.dt;
  state_.acceleration = first ? Vec3(0) : (velocity - state_.velocity) / motion.dt;
  state_.velocity = velocity;
  if (parent != nullptr) {
    state_.local_rotation = glm::conjugate(parent->state_.pose.rotation) * state_.pose.rotation;
  } else {
    const Quat& own = state_.has_local_rotation ? state_.raw_local.rotation : state_.pose.rotation;
    state_.local_rotation = first ? own : turned_towards(state_.local_rotation, own, amount, motion.max_turn);
  }
}

void MocapJoint::publish(double time, double trust, bool on_floor) {
  const MocapJointProperties& p = mocap_joint_properties();
  confidence_ = seen() ? state_.confidence * trust : 0;
  on_floor_ = on_floor;
  double* const block = source_.store().transient_block(id_);
  put(block + p.position->offset, state_.pose.position);
  put(block + p.rotation->offset, state_.pose.rotation);
  put(block + p.local_rotation->offset, state_.local_rotation);
  put(block + p.velocity->offset, state_.velocity);
  block[p.speed->offset] = glm::length(state_.velocity);
  block[p.age->offset] = seen() ? std::max(time - state_.sampled_at, 0.0) : -1;
  block[p.confidence->offset] = confidence_;
  block[p.contact->offset] = on_floor ? 1 : 0;
}

}  // namespace limber::sim
