// Reads skeletons from the world when bodies were added or removed, poses from snapshots.
#include "app/motion/motion_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::app {

namespace {

struct JointOffsets {
  std::uint32_t value, angles, offsets, relrot;
};

const JointOffsets& joint_offsets() {
  static const auto at = [](const char* name) { return sim::Joint::table().at(name).offset; };
  static const JointOffsets layout{at("value"), at("angles"), at("offsets"), at("relrot")};
  return layout;
}

struct NamedValue {
  const char* name;
  std::uint32_t offset;
  bool wraps;
};

// the exported values of a joint
std::vector<NamedValue> exported_values(model::JointType type) {
  const JointOffsets& layout = joint_offsets();
  std::vector<NamedValue> turned = {
      {"angle_x", layout.relrot, true}, {"angle_y", layout.relrot + 1, true}, {"angle_z", layout.relrot + 2, true}};
  std::vector<NamedValue> shifted = {{"shift_x", layout.offsets, false},
                                     {"shift_y", layout.offsets + 1, false},
                                     {"shift_z", layout.offsets + 2, false}};
  switch (type) {
    case model::JointType::revolute:
    case model::JointType::continuous:
      return {{"angle", layout.value, false}};
    case model::JointType::prismatic:
      return {{"shift", layout.value, false}};
    case model::JointType::planar:
      return {shifted[0], shifted[1], {"angle", layout.angles + 2, false}};
    case model::JointType::spherical:
      return turned;
    case model::JointType::floating:
      shifted.insert(shifted.end(), turned.begin(), turned.end());
      return shifted;
    case model::JointType::fixed:
      break;
  }
  return {};
}

std::vector<std::string> value_names(model::JointType type) {
  std::vector<std::string> names;
  for (const NamedValue& value : exported_values(type)) names.emplace_back(value.name);
  return names;
}

// calls visit(node, property, name of the object) for each readout of the extras, in the order of the columns
template <class Visit>
void visit_extras(const sim::Body& body, const MotionExtras& extras, Visit visit) {
  const auto visit_all = [&](const auto& objects, const PropertyTable& table, const char* kind, const auto& name_of,
                             std::initializer_list<const char*> properties) {
    for (const auto& object : objects) {
      for (const char* property : properties)
        visit(object->id(), table.at(property), fmt::format("{}/{}", kind, escape_name(name_of(*object))));
    }
  };
  const auto own_name = [](const auto& object) { return object.name(); };
  const auto joint_name = [](const sim::Motor& motor) { return motor.joint().name(); };
  const PropertyTable& parts = sim::Part::table();
  if (extras.velocities) {
    visit_all(body.parts(), parts, "part", own_name, {"linear_velocity", "angular_velocity"});
    visit_all(body.joints(), sim::Joint::table(), "joint", own_name, {"speed"});
  }
  if (extras.torques)
    visit_all(body.motors(), sim::Motor::table(), "motor", joint_name, {"applied_force", "applied_torque"});
  if (extras.contacts) visit_all(body.parts(), parts, "part", own_name, {"contact_normal_force", "contact_force"});
}

std::vector<std::string> extra_names(const sim::Body& body, const MotionExtras& extras) {
  std::vector<std::string> names;
  visit_extras(body, extras, [&](NodeId, const Property& property, const std::string& object) {
    if (property.width == 1) {
      names.push_back(fmt::format("{}/{}", object, property.name));
      return;
    }
    for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{}/{}_{}", object, property.name, axis));
  });
  return names;
}

std::uint64_t content_of(const sim::Body& body) { return body.model() == nullptr ? 0 : body.model()->content_hash; }

bool same_parts(const exporter::MotionBody& known, const sim::Body& body) {
  const auto parts = body.parts();
  const auto joints = body.joints();
  return known.links.size() == parts.size() && known.joints.size() == joints.size() &&
         std::equal(parts.begin(), parts.end(), known.links.begin(),
                    [](const auto& part, const exporter::MotionLink& link) { return part->name() == link.name; }) &&
         std::equal(joints.begin(), joints.end(), known.joints.begin(),
                    [](const auto& joint, const exporter::MotionJoint& as) {
                      return joint->name() == as.name && value_names(joint->type()) == as.values;
                    });
}

Pose interpolate(const Pose& a, const Pose& b, double mix) {
  return {glm::mix(a.position, b.position, mix), slerp(a.rotation, b.rotation, mix)};
}

// The parent of each link is that of the first joint that leads to it and closes no loop. Sets it, and the rest poses
// along these joints.
void set_parents(exporter::MotionBody& motion, const sim::Body& body, const std::vector<Pose>& current) {
  std::map<const sim::Part*, int> number;
  for (std::size_t i = 0; i < body.parts().size(); i++) number[body.parts()[i].get()] = static_cast<int>(i);
  std::vector<const sim::Joint*> by(motion.links.size(), nullptr);
  for (const auto& joint : body.joints()) {
    const int parent = number[&joint->parent()];
    const int child = number[&joint->child()];
    int top = parent;
    while (top >= 0 && top != child) top = motion.links[static_cast<std::size_t>(top)].parent;
    exporter::MotionLink& link = motion.links[static_cast<std::size_t>(child)];
    if (top == child || link.parent >= 0) continue;
    link.parent = parent;
    by[static_cast<std::size_t>(child)] = joint.get();
  }
  for (const std::size_t i : exporter::link_order(motion).links) {
    exporter::MotionLink& link = motion.links[i];
    if (link.parent < 0) {
      link.rest = current.front().inverse() * current[i];
    } else {
      const sim::JointSpec& spec = by[i]->spec();
      link.rest = motion.links[static_cast<std::size_t>(link.parent)].rest * spec.frame_in_parent *
                  spec.frame_in_child.inverse();
    }
  }
}

}  // namespace

bool MotionSource::is_selected(const std::string& name) const {
  return patterns_.empty() || std::any_of(patterns_.begin(), patterns_.end(), [&](const std::string& pattern) {
           return pattern == name || pattern_match(pattern, name);
         });
}

MotionSource::Track MotionSource::make_track(const sim::Body& body, const engine::BodyEntry& entry,
                                             const engine::Snapshot& current) {
  Track track;
  track.content = content_of(body);
  track.body.name = body.name();
  std::map<std::uint32_t, std::vector<engine::RenderInstance>> instances;
  for (const engine::RenderInstance& instance : current.render_scene->instances) {
    if (instance.enabled_offset == entry.enabled_offset) instances[instance.part_offset].push_back(instance);
  }
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < body.parts().size(); i++) {
    poses.push_back(engine::part_pose(current, entry.part_offsets[i]));
    track.body.links.push_back(
        {body.parts()[i]->name(), -1, {}, surfaces_.surfaces_of(current, instances[entry.part_offsets[i]])});
  }
  set_parents(track.body, body, poses);
  for (std::size_t i = 0; i < body.joints().size(); i++) {
    const sim::Joint& joint = *body.joints()[i];
    track.body.joints.push_back({joint.name(), value_names(joint.type())});
    for (const NamedValue& value : exported_values(joint.type()))
      track.values.push_back({i, value.offset, value.wraps});
  }
  track.body.extras = extra_names(body, extras_);
  return track;
}

int MotionSource::find_or_add_track(const sim::Body& body, const engine::BodyEntry& entry,
                                    const engine::Snapshot& current) {
  if (body.parts().empty() || !is_selected(body.name())) return -1;
  for (std::size_t i = 0; i < tracks_.size(); i++) {
    const Track& track = tracks_[i];
    if (track.body.name == body.name() && track.content == content_of(body) && same_parts(track.body, body))
      return static_cast<int>(i);
  }
  tracks_.push_back(make_track(body, entry, current));
  return static_cast<int>(tracks_.size()) - 1;
}

void MotionSource::update(const sim::World& world, const engine::Snapshot& current) {
  if (recent_[0].body_list != current.body_list) update_body_list(world, current);
  read_extras(world);
}

// Reads the extras of all bodies after a tick.
void MotionSource::read_extras(const sim::World& world) {
  const BodyListTracks& tracks = recent_[0];
  for (std::size_t i = 0; i < tracks_.size(); i++) {
    Track& track = tracks_[i];
    if (track.body.extras.empty()) continue;
    std::swap(track.extras_before, track.extras_now);
    track.extras_now.clear();
    if (i >= tracks.body_of.size() || tracks.body_of[i] < 0) continue;
    const sim::Body& body = *world.bodies()[static_cast<std::size_t>(tracks.body_of[i])];
    visit_extras(body, extras_, [&](NodeId node, const Property& property, const std::string&) {
      std::array<double, 4> values{};
      world.store().get(node, property, values.data());
      track.extras_now.insert(track.extras_now.end(), values.begin(), values.begin() + property.width);
    });
  }
}

// Interpolates between the last two ticks.
void MotionSource::fill_extras(const Track& track, double mix, exporter::MotionSample& sample) const {
  const std::vector<double>& now = track.extras_now;
  const std::vector<double>& before = track.extras_before.size() == now.size() ? track.extras_before : now;
  sample.extras.assign(track.body.extras.size(), 0.0);
  for (std::size_t k = 0; k < std::min(now.size(), sample.extras.size()); k++)
    sample.extras[k] = before[k] + (now[k] - before[k]) * mix;
}

void MotionSource::update_body_list(const sim::World& world, const engine::Snapshot& current) {
  std::swap(recent_[0], recent_[1]);
  BodyListTracks& tracks = recent_[0];
  tracks.body_list = current.body_list;
  tracks.track_of.clear();
  for (std::size_t i = 0; i < current.body_list->bodies.size(); i++) {
    const sim::Body& body = *world.bodies()[i];
    if (std::find(names_.begin(), names_.end(), body.name()) == names_.end()) names_.push_back(body.name());
    tracks.track_of.push_back(find_or_add_track(body, current.body_list->bodies[i], current));
  }
  tracks.body_of.assign(tracks_.size(), -1);
  for (std::size_t i = 0; i < tracks.track_of.size(); i++) {
    if (tracks.track_of[i] >= 0) tracks.body_of[static_cast<std::size_t>(tracks.track_of[i])] = static_cast<int>(i);
  }
}

const MotionSource::BodyListTracks& MotionSource::tracks_of(const engine::BodyList* body_list) const {
  return recent_[0].body_list.get() == body_list ? recent_[0] : recent_[1];
}

Result<void> MotionSource::add_frame(double time, const engine::Snapshot& previous, const engine::Snapshot& current,
                                     double mix, exporter::MotionWriter& writer) {
  const engine::Snapshot& snapshot = mix >= 1 ? current : previous;
  const BodyListTracks& here = tracks_of(snapshot.body_list.get());
  const BodyListTracks& next = tracks_of(current.body_list.get());
  const bool interpolates = mix < 1 && current.time >= previous.time;
  for (exporter::MotionSample& sample : samples_) sample.present = false;
  for (std::size_t i = 0; i < here.track_of.size(); i++) {
    const engine::BodyEntry& a = snapshot.body_list->bodies[i];
    if (here.track_of[i] < 0 || snapshot.transient[a.enabled_offset] < 0.5) continue;
    const auto number = static_cast<std::size_t>(here.track_of[i]);
    Track& track = tracks_[number];
    if (!track.writer_number) {
      track.writer_number = samples_.size();
      samples_.emplace_back();
      if (Result<void> added = writer.add_body(track.body); !added) return added;
    }
    const bool continues = interpolates && number < next.body_of.size() && next.body_of[number] >= 0;
    const engine::BodyEntry& b =
        continues ? current.body_list->bodies[static_cast<std::size_t>(next.body_of[number])] : a;
    fill_sample(track, {snapshot, a}, {continues ? current : snapshot, b}, continues ? mix : 0);
    fill_extras(track, continues ? mix : std::floor(mix), samples_[*track.writer_number]);
  }
  return writer.add_frame(time, samples_);
}

void MotionSource::fill_sample(const Track& track, const BodyAt& from, const BodyAt& to, double mix) {
  exporter::MotionSample& sample = samples_[*track.writer_number];
  sample.present = true;
  sample.links.resize(from.body.part_offsets.size());
  sample.values.resize(track.values.size());
  for (std::size_t k = 0; k < sample.links.size(); k++)
    sample.links[k] = interpolate(engine::part_pose(from.snapshot, from.body.part_offsets[k]),
                                  engine::part_pose(to.snapshot, to.body.part_offsets[k]), mix);
  for (std::size_t k = 0; k < track.values.size(); k++) {
    const Value& value = track.values[k];
    const double start = from.snapshot.transient[from.body.joint_offsets[value.joint] + value.offset];
    double difference = to.snapshot.transient[to.body.joint_offsets[value.joint] + value.offset] - start;
    if (value.wraps) difference -= 2 * kPi * std::round(difference / (2 * kPi));
    sample.values[k] = start + difference * mix;
  }
}

}  // namespace limber::app
