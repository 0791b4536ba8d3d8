// Skeletons are read from the world whenever somebody came or went, poses from snapshots.
#include "app/motion_source.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/text.h"

namespace limber {

namespace {

struct JointRows {
  std::uint32_t value, angles, offsets, relrot;
};

const JointRows& joint_rows() {
  static const auto at = [](const char* name) { return Joint::table().at(name).offset; };
  static const JointRows rows{at("value"), at("angles"), at("offsets"), at("relrot")};
  return rows;
}

struct NamedRow {
  const char* name;
  std::uint32_t row;
  bool turns;
};

// what is told of a joint
std::vector<NamedRow> told_of(JointType type) {
  const JointRows& rows = joint_rows();
  const std::vector<NamedRow> turned = {
      {"angle_x", rows.relrot, true}, {"angle_y", rows.relrot + 1, true}, {"angle_z", rows.relrot + 2, true}};
  std::vector<NamedRow> shifted = {
      {"shift_x", rows.offsets, false}, {"shift_y", rows.offsets + 1, false}, {"shift_z", rows.offsets + 2, false}};
  switch (type) {
    case JointType::revolute:
    case JointType::continuous:
      return {{"angle", rows.value, false}};
    case JointType::prismatic:
      return {{"shift", rows.value, false}};
    case JointType::planar:
      return {shifted[0], shifted[1], {"angle", rows.angles + 2, false}};
    case JointType::spherical:
      return turned;
    case JointType::floating:
      shifted.insert(shifted.end(), turned.begin(), turned.end());
      return shifted;
    case JointType::fixed:
      break;
  }
  return {};
}

std::vector<std::string> value_names(JointType type) {
  std::vector<std::string> names;
  for (const NamedRow& row : told_of(type)) names.emplace_back(row.name);
  return names;
}

std::uint64_t content_of(const Body& body) { return body.model() == nullptr ? 0 : body.model()->content; }

bool same_parts(const MotionBody& known, const Body& body) {
  const auto parts = body.parts();
  const auto joints = body.joints();
  return known.links.size() == parts.size() && known.joints.size() == joints.size() &&
         std::equal(parts.begin(), parts.end(), known.links.begin(),
                    [](const auto& part, const MotionLink& link) { return part->name() == link.name; }) &&
         std::equal(joints.begin(), joints.end(), known.joints.begin(), [](const auto& joint, const MotionJoint& as) {
           return joint->name() == as.name && value_names(joint->type()) == as.values;
         });
}

Pose pose_in(const Snapshot& snapshot, std::uint32_t part) {
  const double* const block = snapshot.live.data() + part;
  return {vec3_at(block + live_offsets().part_position), quat_at(block + live_offsets().part_rotation)};
}

Pose between(const Pose& a, const Pose& b, double mix) {
  return {glm::mix(a.position, b.position, mix), slerp(a.rotation, b.rotation, mix)};
}

// parents by the first joint that leads to a part and closes no loop, and rest poses along these joints
void hang(MotionBody& motion, const Body& body, const std::vector<Pose>& now) {
  std::map<const Part*, int> number;
  for (std::size_t i = 0; i < body.parts().size(); i++) number[body.parts()[i].get()] = static_cast<int>(i);
  std::vector<const Joint*> by(motion.links.size(), nullptr);
  for (const auto& joint : body.joints()) {
    const int parent = number[&joint->parent()];
    const int child = number[&joint->child()];
    int top = parent;
    while (top >= 0 && top != child) top = motion.links[static_cast<std::size_t>(top)].parent;
    MotionLink& link = motion.links[static_cast<std::size_t>(child)];
    if (top == child || link.parent >= 0) continue;
    link.parent = parent;
    by[static_cast<std::size_t>(child)] = joint.get();
  }
  for (const std::size_t i : link_order(motion).links) {
    MotionLink& link = motion.links[i];
    if (link.parent < 0) {
      link.rest = now.front().inverse() * now[i];
    } else {
      const JointSpec& spec = by[i]->spec();
      link.rest = motion.links[static_cast<std::size_t>(link.parent)].rest * spec.frame_in_parent *
                  spec.frame_in_child.inverse();
    }
  }
}

}  // namespace

bool MotionSource::chosen(const std::string& name) const {
  return patterns_.empty() || std::any_of(patterns_.begin(), patterns_.end(), [&](const std::string& pattern) {
           return pattern == name || pattern_match(pattern, name);
         });
}

MotionSource::Track MotionSource::make_track(const Body& body, const RosterBody& entry, const Snapshot& now) {
  Track track;
  track.content = content_of(body);
  track.body.name = body.name();
  std::map<std::uint32_t, std::vector<DrawnPiece>> pieces;
  for (const DrawnPiece& piece : now.drawing->pieces) {
    if (piece.enabled_at == entry.enabled_at) pieces[piece.part_at].push_back(piece);
  }
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < body.parts().size(); i++) {
    poses.push_back(pose_in(now, entry.parts[i]));
    track.body.links.push_back({body.parts()[i]->name(), -1, {}, surfaces_.of(now, pieces[entry.parts[i]])});
  }
  hang(track.body, body, poses);
  for (std::size_t i = 0; i < body.joints().size(); i++) {
    const Joint& joint = *body.joints()[i];
    track.body.joints.push_back({joint.name(), value_names(joint.type())});
    for (const NamedRow& row : told_of(joint.type())) track.values.push_back({i, row.row, row.turns});
  }
  return track;
}

int MotionSource::find_track(const Body& body, const RosterBody& entry, const Snapshot& now) {
  if (std::find(names_.begin(), names_.end(), body.name()) == names_.end()) names_.push_back(body.name());
  if (body.parts().empty() || !chosen(body.name())) return -1;
  for (std::size_t i = 0; i < tracks_.size(); i++) {
    const Track& track = tracks_[i];
    if (track.body.name == body.name() && track.content == content_of(body) && same_parts(track.body, body))
      return static_cast<int>(i);
  }
  tracks_.push_back(make_track(body, entry, now));
  return static_cast<int>(tracks_.size()) - 1;
}

void MotionSource::learn(const World& world, const Snapshot& now) {
  if (seen_[0].roster == now.roster) return;
  std::swap(seen_[0], seen_[1]);
  Seen& seen = seen_[0];
  seen.roster = now.roster;
  seen.track_of.clear();
  for (std::size_t i = 0; i < now.roster->bodies.size(); i++)
    seen.track_of.push_back(find_track(*world.bodies()[i], now.roster->bodies[i], now));
  seen.body_of.assign(tracks_.size(), -1);
  for (std::size_t i = 0; i < seen.track_of.size(); i++) {
    if (seen.track_of[i] >= 0) seen.body_of[static_cast<std::size_t>(seen.track_of[i])] = static_cast<int>(i);
  }
}

const MotionSource::Seen& MotionSource::seen(const Roster* roster) const {
  return seen_[0].roster.get() == roster ? seen_[0] : seen_[1];
}

Result<void> MotionSource::add_frame(double time, const Snapshot& before, const Snapshot& now, double mix,
                                     MotionWriter& writer) {
  const Snapshot& shown = mix >= 1 ? now : before;
  const Seen& here = seen(shown.roster.get());
  const Seen& next = seen(now.roster.get());
  const bool flows = mix < 1 && now.time >= before.time;
  for (MotionSample& sample : samples_) sample.there = false;
  for (std::size_t i = 0; i < here.track_of.size(); i++) {
    const RosterBody& a = shown.roster->bodies[i];
    if (here.track_of[i] < 0 || shown.live[a.enabled_at] < 0.5) continue;
    const auto number = static_cast<std::size_t>(here.track_of[i]);
    Track& track = tracks_[number];
    if (!track.number) {
      track.number = samples_.size();
      samples_.emplace_back();
      if (Result<void> added = writer.add_body(track.body); !added) return added;
    }
    MotionSample& sample = samples_[*track.number];
    sample.there = true;
    sample.links.resize(a.parts.size());
    sample.values.resize(track.values.size());
    const bool stays = flows && number < next.body_of.size() && next.body_of[number] >= 0;
    const RosterBody& b = stays ? now.roster->bodies[static_cast<std::size_t>(next.body_of[number])] : a;
    const Snapshot& to = stays ? now : shown;
    const double part = stays ? mix : 0;
    for (std::size_t k = 0; k < a.parts.size(); k++)
      sample.links[k] = between(pose_in(shown, a.parts[k]), pose_in(to, b.parts[k]), part);
    for (std::size_t k = 0; k < track.values.size(); k++) {
      const Value& value = track.values[k];
      const double from = shown.live[a.joints[value.joint] + value.row];
      double way = to.live[b.joints[value.joint] + value.row] - from;
      if (value.turns) way -= 2 * kPi * std::round(way / (2 * kPi));
      sample.values[k] = from + way * part;
    }
  }
  return writer.add_frame(time, samples_);
}

}  // namespace limber
