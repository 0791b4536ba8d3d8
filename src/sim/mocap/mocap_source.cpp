// MocapSource: its properties, and its ticks.
#include "sim/mocap/mocap_source.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "base/text.h"
#include "sim/mocap/mocap_list.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

constexpr double kJump = 0.6;          // m: a change of the samples in one tick that is no motion
constexpr double kSwapDistance = 0.3;  // m: between the places of two sources that have changed places
constexpr double kSwapTime = 0.25;     // s: between their jumps
constexpr double kMissingAfter = 2;    // s of frames after which joints that have not arrived are reported

struct MocapProperties {
  const Property *active, *offset, *rotation, *scale, *max_speed, *max_turn, *timeout, *fade, *floor, *contact_height,
      *contact_speed, *playing, *loop, *speed, *time, *tracked, *age, *frames, *missing, *center, *mean_speed, *jerk,
      *expansion, *symmetry, *contacts;
};

const MocapProperties& mocap_properties() {
  static const auto at = [](const char* name) { return &MocapSource::table().at(name); };
  static const MocapProperties found{
      at("active"),        at("offset"),  at("rotation"),  at("scale"),    at("max_speed"),
      at("max_turn"),      at("timeout"), at("fade"),      at("floor"),    at("contact_height"),
      at("contact_speed"), at("playing"), at("loop"),      at("speed"),    at("time"),
      at("tracked"),       at("age"),     at("frames"),    at("missing"),  at("center"),
      at("mean_speed"),    at("jerk"),    at("expansion"), at("symmetry"), at("contacts")};
  return found;
}

Result<void> check_bones(const MocapSetup& setup) {
  for (const MocapBone& bone : setup.bones) {
    const std::string& child = bone.child;
    for (const std::string* joint : {&bone.parent, &child}) {
      if (const auto wrong = name_error(*joint)) return Error{fmt::format("bones: {}", *wrong)};
    }
    const auto same_child = [&](const MocapBone& each) { return each.child == child; };
    if (std::ranges::count_if(setup.bones, same_child) > 1)
      return Error{fmt::format("bones: '{}' has two parents; remove one of the bones", child)};
    // follows the parents of the child, at most as many as there are bones
    std::string_view at = bone.parent;
    for (std::size_t i = 0; i <= setup.bones.size(); i++) {
      if (at == child) return Error{fmt::format("bones: '{}' is its own ancestor; remove one of the bones", child)};
      const auto up = std::ranges::find_if(setup.bones, [&](const MocapBone& each) { return each.child == at; });
      if (up == setup.bones.end()) break;
      at = up->parent;
    }
  }
  return {};
}

}  // namespace

const PropertyTable& MocapSource::table() {
  constexpr double kFar = kUnbounded;
  static const PropertyTable table(
      "mocap", "/physics/mocap/<mocap>", "",
      {
          boolean("active", true, "False: its joints stay where they are."),
          vec3("offset", "m", {0, 0, 0}, -1e4, 1e4, "Where the source's origin is on stage."),
          euler_angles(vec3("rotation", "deg", {0, 0, 0}, -360, 360,
                            "Turns the source about its origin, by angles about x, y and z; z is vertical.")),
          number("scale", "", 1, 1e-3, 1e3, "Factor on the lengths of the source."),
          number("max_speed", "m/s", 20, 0.01, 1e4,
                 "Largest speed of a joint; it follows losses, bursts and jumps of its samples at this speed."),
          number("max_turn", "rad/s", 40, 0.01, 1e4, "Largest angular speed of a joint."),
          number("timeout", "s", 0.5, 0.02, 60, "Time without frames after which the source is lost."),
          number("fade", "s", 0, 0, 600,
                 "Time in which the confidence of lost joints falls to 0; 0: it stays, and the last values are held."),
          number("floor", "m", 0, -1e4, 1e4, "Height of the floor, for contact."),
          number("contact_height", "m", 0.1, 0, 10, "Largest height above the floor of a joint in contact."),
          number("contact_speed", "m/s", 0.5, 0, 100, "Largest speed of a joint in contact."),
          boolean("playing", true, "Player: false stops the time of its file."),
          boolean("loop", true, "Player: starts again at the end of its file."),
          number("speed", "× real time", 1, -100, 100, "Player: its speed; negative: backwards."),
          transient(state(number("time", "s", 0, 0, 1e6, "Player: time in its file; can be set."))),
          computed<&MocapSource::read_number>(
              readout(integer("number", 1, 1, kFar, "Its number among the sources, for behaviors."))),
          computed<&MocapSource::read_duration>(
              readout(number("duration", "s", 0, 0, kFar, "Player: length of its file; else 0."))),
          transient(readout(boolean("tracked", false, "True while frames arrive, or its file plays."))),
          transient(readout(number("age", "s", -1, -1, kFar, "Time since its last frame; -1: there was none."))),
          transient(readout(integer("frames", 0, 0, kFar, "Number of messages that were accepted."))),
          transient(readout(integer("missing", 0, 0, kFar, "Number of joints without a sample within timeout."))),
          transient(readout(vec3("center", "m", {0, 0, 0}, -kFar, kFar, "Mean place of its joints."))),
          transient(readout(number("mean_speed", "m/s", 0, 0, kFar, "Mean speed of its joints."))),
          transient(readout(number("jerk", "m/s³", 0, 0, kFar, "Mean change of its joints' acceleration, smoothed."))),
          transient(readout(number("expansion", "m", 0, 0, kFar,
                                   "Root of the mean squared distance of its joints from the center."))),
          transient(readout(number("symmetry", "", 0, 0, 1, "1: its left side mirrors the right one."))),
          transient(readout(integer("contacts", 0, 0, kFar, "Number of its joints on the floor."))),
      });
  return table;
}

MocapSource::MocapSource(World& world, NodeId group, std::string name, std::shared_ptr<const MocapSetup> setup)
    : world_(world),
      id_(world.store().add(table(), group, std::move(name), this)),
      joint_group_(world.store().add_group(id_, "joint")),
      setup_(std::move(setup)) {
  for (const MocapMapping& mapping : setup_->messages) messages_.push_back(*MocapMessage::compile(mapping));
  if (is_player()) {
    for (const model::BvhJoint& joint : setup_->clip->joints) add_joint(joint.name);
  }
  for (const std::string& joint : setup_->joints) {
    if (find(joint) == nullptr) add_joint(joint);
  }
  for (const MocapBone& bone : setup_->bones) {
    if (setup_->is_vmc) break;  // most dancers lack some of them
    for (const std::string& joint : {bone.parent, bone.child}) {
      if (find(joint) == nullptr) add_joint(joint);
    }
  }
  declared_ = joints_.size();
  link_joints();
  if (is_player()) publish_start();
}

MocapSource::~MocapSource() {
  joints_.clear();
  store().remove(joint_group_);
  store().remove(id_);
}

Result<void> MocapSource::check(const MocapSetup& setup) {
  for (const MocapMapping& mapping : setup.messages) {
    if (const Result<MocapMessage> compiled = MocapMessage::compile(mapping); !compiled) return Error{compiled.error()};
  }
  std::set<std::string_view> names(setup.joints.begin(), setup.joints.end());
  for (const MocapBone& bone : setup.bones) names.insert({bone.parent, bone.child});
  if (names.size() > kMaxJoints)
    return Error{fmt::format("has {} joints; at most {} are allowed", names.size(), kMaxJoints)};
  for (const std::string& joint : setup.joints) {
    if (const auto wrong = name_error(joint)) return Error{fmt::format("joint: {}", *wrong)};
    if (std::ranges::count(setup.joints, joint) > 1)
      return Error{fmt::format("there is a joint '{}' already; names are unique", joint)};
  }
  return check_bones(setup);
}

Store& MocapSource::store() const { return world_.store(); }
const std::string& MocapSource::name() const { return std::as_const(store()).name(id_); }

double MocapSource::setting(const Property* property) const { return std::as_const(store()).values(id_, *property)[0]; }

MocapJoint* MocapSource::find(std::string_view name) const {
  const NodeId id = store().child(joint_group_, name);
  return id.null() ? nullptr : static_cast<MocapJoint*>(store().object(id));
}

MocapJoint& MocapSource::add_joint(std::string name) {
  joints_.push_back(std::make_unique<MocapJoint>(*this, joint_group_, std::move(name), joints_.size()));
  return *joints_.back();
}

Result<MocapJoint*> MocapSource::expect(std::string name) {
  if (MocapJoint* const known = find(name)) return known;
  if (const auto wrong = name_error(name)) return Error{fmt::format("joint: {}", *wrong)};
  if (is_player()) {
    std::vector<std::string_view> names;
    for (const auto& joint : joints_) names.push_back(joint->name());
    return Error{fmt::format("mocap '{}' has no joint '{}'{}", this->name(), name, name_hint(name, names))};
  }
  if (joints_.size() == kMaxJoints)
    return Error{fmt::format("mocap '{}' has {} joints, the most that are allowed", this->name(), kMaxJoints)};
  MocapJoint& added = add_joint(std::move(name));
  link_joints();
  world_.transaction().record(
      [](void* source, std::size_t) {
        MocapSource& self = *static_cast<MocapSource*>(source);
        self.joints_.pop_back();
        self.link_joints();
      },
      this);
  return &added;
}

// Finds parents, skipping bones that the source does not have, and the order in which parents come first.
void MocapSource::link_joints() {
  const auto number_of = [&](std::string_view name) {
    const auto found = std::ranges::find_if(joints_, [&](const auto& joint) { return joint->name() == name; });
    return found == joints_.end() ? -1 : static_cast<int>(found - joints_.begin());
  };
  const auto parent_by_bones = [&](std::string_view name) {
    for (std::size_t i = 0; i <= setup_->bones.size(); i++) {
      const auto bone = std::ranges::find_if(setup_->bones, [&](const auto& each) { return each.child == name; });
      if (bone == setup_->bones.end()) return -1;
      if (const int parent = number_of(bone->parent); parent >= 0) return parent;
      name = bone->parent;
    }
    return -1;
  };
  for (std::size_t i = 0; i < joints_.size(); i++) {
    const bool played = is_player() && i < setup_->clip->joints.size();
    joints_[i]->set_parent(played ? setup_->clip->joints[i].parent : parent_by_bones(joints_[i]->name()));
  }
  const auto depth = [&](std::size_t joint) {
    std::size_t steps = 0;
    for (int at = joints_[joint]->parent(); at >= 0; at = joints_[static_cast<std::size_t>(at)]->parent()) steps++;
    return steps;
  };
  order_.resize(joints_.size());
  for (std::size_t i = 0; i < order_.size(); i++) order_[i] = i;
  std::ranges::stable_sort(order_, {}, depth);
  raw_.resize(joints_.size());
  accelerations_.resize(joints_.size(), Vec3(0));
  features_.find_pairs(joints_);
}

MocapJoint* MocapSource::joint_for(const MocapSample& sample, std::string_view named) {
  std::string_view name = named.empty() ? sample.joint : named;
  std::string numbered;  // short enough not to allocate
  if (name.empty()) {
    if (sample.index < declared_) return joints_[sample.index].get();
    numbered = fmt::format("joint_{}", sample.index + 1);
    name = numbered;
  }
  if (MocapJoint* const known = find(name)) return known;
  if (joints_.size() == kMaxJoints || name_error(name)) return nullptr;
  add_joint(std::string(name));
  link_joints();
  return joints_.back().get();
}

Result<void> MocapSource::accept(std::size_t mapping, std::span<const Arg> args, std::string_view joint) {
  const MocapMessage& message = messages_[mapping];
  if (message.ignored()) return {};
  const Result<std::size_t> count = message.count(args);
  if (!count) return Error{fmt::format("mocap '{}': {}", name(), count.error())};
  if (*count > kMaxJoints)
    return Error{fmt::format("mocap '{}': has {} joints; at most {} are accepted", name(), *count, kMaxJoints)};
  const double time = world_.time();
  for (std::size_t i = 0; i < *count; i++) {
    const MocapSample sample = message.decode(args, i);
    MocapJoint* const to = joint_for(sample, joint);
    if (to == nullptr)
      return Error{
          fmt::format("mocap '{}': the joint '{}' can't be added: its name can't be printed, or there are {} "
                      "joints already",
                      name(), printable(shortened(joint.empty() ? sample.joint : joint, 40)), kMaxJoints)};
    to->accept(sample, setup_->axes, time);
  }
  state_.frames++;
  state_.last_frame = time;
  if (state_.first_frame < 0) state_.first_frame = time;
  return {};
}

void MocapSource::step(double dt) {
  const double time = world_.time() + dt;
  if (setting(mocap_properties().active) != 0) {
    if (is_player()) play(dt);
    move_joints(dt);
  } else {
    for (const auto& joint : joints_) joint->stop();
  }
  report(time);
  publish_joints(time);
  publish_features(dt);
}

void MocapSource::play(double dt) {
  const MocapProperties& p = mocap_properties();
  const model::BvhClip& clip = *setup_->clip;
  double* const at = store().transient_block(id_) + p.time->offset;
  const double length = clip.duration();
  double time = std::clamp(*at, 0.0, length);
  if (setting(p.playing) != 0) {
    time += dt * setting(p.speed);
    if (setting(p.loop) != 0 && length > 0) time -= length * std::floor(time / length);
    time = std::clamp(time, 0.0, length);
  }
  *at = time;
  const MocapAxes& axes = setup_->axes;
  state_.last_frame = world_.time() + dt;
  for (std::size_t i = 0; i < clip.joints.size(); i++) {
    const Pose local = clip.local_pose_at(i, time);
    joints_[i]->set_local({axes.position(local.position), axes.rotation(local.rotation)}, state_.last_frame);
  }
}

// Publishes the first frame of a player, before the script sets its properties; the first tick places its joints.
void MocapSource::publish_start() {
  play(0);
  move_joints(0);
  publish_joints(world_.time());
  for (const auto& joint : joints_) joint->state().placed = false;
}

double MocapSource::bone_length(const MocapJoint& joint) const {
  if (is_player() && joint.index() < setup_->clip->joints.size())
    return glm::length(setup_->clip->local_pose(joint.index(), 0).position) * setup_->axes.unit;
  const auto bone =
      std::ranges::find_if(setup_->bones, [&](const MocapBone& each) { return each.child == joint.name(); });
  return bone == setup_->bones.end() ? MocapBone::kDefaultLength : bone->length;
}

void MocapSource::move_joints(double dt) {
  const MocapProperties& p = mocap_properties();
  const double* const settings = std::as_const(store()).persistent_block(id_);
  const Vec3 turn = vec3_at(settings + p.rotation->offset) * (kPi / 180);
  const Quat rotation = quat_axis({1, 0, 0}, turn.x) * quat_axis({0, 1, 0}, turn.y) * quat_axis({0, 0, 1}, turn.z);
  const MocapMotion motion{dt,
                           {vec3_at(settings + p.offset->offset), rotation},
                           setting(p.scale),
                           setting(p.max_speed) * dt,
                           setting(p.max_turn) * dt};
  Vec3 center(0);
  int count = 0;
  for (const std::size_t i : order_) {
    MocapJoint& joint = *joints_[i];
    if (!joint.seen()) continue;
    int above = joint.parent();
    while (above >= 0 && !joints_[static_cast<std::size_t>(above)]->seen())
      above = joints_[static_cast<std::size_t>(above)]->parent();
    const bool has_parent = above >= 0;
    const auto parent = static_cast<std::size_t>(std::max(above, 0));
    raw_[i] = joint.raw_pose(has_parent ? &raw_[parent] : nullptr);
    center += motion.stage * (raw_[i].position * motion.scale);
    count++;
    joint.move(raw_[i], has_parent ? joints_[parent].get() : nullptr, motion);
  }
  if (count > 0) follow_samples(center / static_cast<double>(count), world_.time() + dt);
}

void MocapSource::follow_samples(const Vec3& center, double time) {
  SampleCenter& samples = state_.samples;
  if (samples.known && glm::length(center - samples.place) > kJump) {
    samples.before_jump = samples.place;
    samples.jumped_at = time;
  }
  samples.place = center;
  samples.known = true;
}

bool MocapSource::consume_swap(MocapSource& other) {
  SampleCenter& a = state_.samples;
  SampleCenter& b = other.state_.samples;
  const double now = world_.time();
  const auto is_recent = [&](const SampleCenter& jump) {
    return jump.jumped_at >= 0 && now - jump.jumped_at < kSwapTime;
  };
  if (!is_recent(a) || !is_recent(b)) return false;
  if (glm::length(a.place - b.before_jump) > kSwapDistance || glm::length(b.place - a.before_jump) > kSwapDistance)
    return false;
  a.jumped_at = b.jumped_at = -1;
  return true;
}

double MocapSource::trust(double age) const {
  const double fade = setting(mocap_properties().fade);
  const double late = age - setting(mocap_properties().timeout);
  return fade <= 0 || late <= 0 ? 1 : std::max(1 - late / fade, 0.0);
}

void MocapSource::publish_joints(double time) {
  const MocapProperties& p = mocap_properties();
  const double floor = setting(p.floor) + setting(p.contact_height);
  const double contact_speed = setting(p.contact_speed);
  const double timeout = setting(p.timeout);
  int missing = 0;
  for (const auto& joint : joints_) {
    const double age = time - joint->sampled_at();
    if (!joint->seen() || age > timeout) missing++;
    const bool on_floor =
        joint->placed() && joint->pose().position.z <= floor && glm::length(joint->velocity()) <= contact_speed;
    joint->publish(time, trust(age), on_floor);
  }
  double* const block = store().transient_block(id_);
  block[p.missing->offset] = missing;
  block[p.frames->offset] = state_.frames;
  block[p.age->offset] = state_.last_frame < 0 ? -1 : std::max(time - state_.last_frame, 0.0);
  block[p.tracked->offset] = state_.last_frame >= 0 && !state_.lost ? 1 : 0;
}

void MocapSource::publish_features(double dt) {
  const MocapProperties& p = mocap_properties();
  const MocapFeatures now = features_.extract(joints_, accelerations_, state_.jerk, dt);
  state_.jerk = now.jerk;
  for (std::size_t i = 0; i < joints_.size(); i++) accelerations_[i] = joints_[i]->acceleration();
  double* const block = store().transient_block(id_);
  put(block + p.center->offset, now.center);
  block[p.mean_speed->offset] = now.speed;
  block[p.jerk->offset] = now.jerk;
  block[p.expansion->offset] = now.expansion;
  block[p.symmetry->offset] = now.symmetry;
  block[p.contacts->offset] = now.contacts;
}

void MocapSource::report(double time) {
  if (state_.last_frame < 0 || is_player()) return;
  const double timeout = setting(mocap_properties().timeout);
  const bool lost = time - state_.last_frame > timeout;
  if (lost != std::exchange(state_.lost, lost)) {
    if (lost) {
      log_warning("mocap '{}': no frame for {:g} s; its last values are held. Check its sender", name(), timeout);
    } else {
      log_info("mocap '{}': frames arrive again", name());
    }
  }
  if (!lost && time - state_.first_frame > kMissingAfter && !std::exchange(state_.reported_missing, true))
    report_missing();
}

void MocapSource::report_missing() {
  std::string missing;
  std::string known;
  for (const auto& joint : joints_) {
    std::string& list = joint->seen() ? known : missing;
    if (list.size() < 200) list += (list.empty() ? "" : ", ") + joint->name();
  }
  if (!missing.empty())
    log_warning("mocap '{}': joints that have not arrived: {}. The source sends: {}", name(), missing,
                known.empty() ? "none" : known);
}

void MocapSource::serialize(Archive& archive) {
  archive.serialize_all(state_, accelerations_);
  for (const auto& joint : joints_) archive.serialize(joint->state());
}

void MocapSource::read_number(double* out) const {
  const auto list = world_.sensing().mocap().list();
  const auto found = std::ranges::find_if(list, [&](const auto& each) { return each.get() == this; });
  *out = static_cast<double>(found - list.begin()) + 1;
}
void MocapSource::read_duration(double* out) const { *out = is_player() ? setup_->clip->duration() : 0; }

}  // namespace limber::sim
