// Conversion of world poses to keyframes.
#include "export/gltf_tracks.h"

#include <algorithm>
#include <cmath>

namespace limber::exporter {

namespace {

// tolerance for the simulation's rounding of a body at rest: a micrometer, a microradian
constexpr float kRestTolerance = 1e-6F;

// appends a key; true if it equals the first key
template <std::size_t N>
bool add_key(std::vector<float>& keys, const std::array<double, N>& values) {
  for (const double value : values) keys.push_back(static_cast<float>(value));
  return std::equal(keys.end() - N, keys.end(), keys.begin(),
                    [](float a, float b) { return std::abs(a - b) <= kRestTolerance; });
}

template <std::size_t N>
void repeat_key(std::vector<float>& keys) {
  for (std::size_t i = 0; i < N; i++) keys.push_back(keys[keys.size() - N]);
}

double dot_with_last(const std::vector<float>& rotations, const Quat& q) {
  if (rotations.empty()) return 1;
  const float* const last = rotations.data() + rotations.size() - 4;
  return last[0] * q.x + last[1] * q.y + last[2] * q.z + last[3] * q.w;
}

}  // namespace

void GltfTracks::add_body(const MotionBody& body) {
  GltfTrack& track = tracks_.emplace_back();
  track.body = body;
  track.first = times_.size();
  track.links.resize(body.links.size());
}

void GltfTracks::add_keys(GltfTrack& track, const MotionSample& sample) {
  for (std::size_t i = 0; i < track.links.size(); i++) {
    const int parent = track.body.links[i].parent;
    const Pose& world = sample.links[i];
    const Pose local_pose = parent < 0 ? world : sample.links[static_cast<std::size_t>(parent)].inverse() * world;
    GltfLinkKeys& keys = track.links[i];
    Quat q = glm::normalize(local_pose.rotation);
    if (dot_with_last(keys.rotations, q) < 0) q = -q;
    const Vec3& p = local_pose.position;
    const bool position_at_rest = add_key<3>(keys.positions, {p.x, p.y, p.z});
    keys.at_rest = add_key<4>(keys.rotations, {q.x, q.y, q.z, q.w}) && position_at_rest && keys.at_rest;
  }
}

void GltfTracks::add_frame(double time, std::span<const MotionSample> bodies) {
  const std::size_t frame = times_.size();
  if (frame == 0) begin_ = time;
  times_.push_back(static_cast<float>(time - begin_));
  for (std::size_t i = 0; i < bodies.size(); i++) {
    GltfTrack& track = tracks_[i];
    const bool was_present = track.presence_changes.size() % 2 == 1;
    if (bodies[i].present != was_present) track.presence_changes.push_back(frame);
    if (bodies[i].present) {
      add_keys(track, bodies[i]);
      track.last_present = frame;
    } else {
      for (GltfLinkKeys& keys : track.links) {
        repeat_key<3>(keys.positions);
        repeat_key<4>(keys.rotations);
      }
    }
    bytes_ += 28 * track.links.size();
  }
}

}  // namespace limber::exporter
