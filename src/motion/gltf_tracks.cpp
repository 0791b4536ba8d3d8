// From world poses to keys.
#include "motion/gltf_tracks.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

// what the simulation's rounding does to a thing that stands: a micrometre, a microradian
constexpr float kStill = 1e-6F;

// puts numbers at the end; whether they are the first ones
template <std::size_t N>
bool add_key(std::vector<float>& keys, const std::array<double, N>& values) {
  for (const double value : values) keys.push_back(static_cast<float>(value));
  return std::equal(keys.end() - N, keys.end(), keys.begin(),
                    [](float a, float b) { return std::abs(a - b) <= kStill; });
}

template <std::size_t N>
void repeat_key(std::vector<float>& keys) {
  for (std::size_t i = 0; i < N; i++) keys.push_back(keys[keys.size() - N]);
}

double dot_with_last(const std::vector<float>& turns, const Quat& q) {
  if (turns.empty()) return 1;
  const float* const last = turns.data() + turns.size() - 4;
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
    const Pose own = parent < 0 ? world : sample.links[static_cast<std::size_t>(parent)].inverse() * world;
    GltfLinkKeys& keys = track.links[i];
    Quat q = glm::normalize(own.rotation);
    if (dot_with_last(keys.turns, q) < 0) q = -q;
    const Vec3& p = own.position;
    const bool stays = add_key<3>(keys.places, {p.x, p.y, p.z});
    keys.still = add_key<4>(keys.turns, {q.x, q.y, q.z, q.w}) && stays && keys.still;
  }
}

void GltfTracks::add_frame(double time, std::span<const MotionSample> bodies) {
  const std::size_t frame = times_.size();
  if (frame == 0) begin_ = time;
  times_.push_back(static_cast<float>(time - begin_));
  for (std::size_t i = 0; i < bodies.size(); i++) {
    GltfTrack& track = tracks_[i];
    const bool was_there = track.switches.size() % 2 == 1;
    if (bodies[i].there != was_there) track.switches.push_back(frame);
    if (bodies[i].there) {
      add_keys(track, bodies[i]);
      track.last_there = frame;
    } else {
      for (GltfLinkKeys& keys : track.links) {
        repeat_key<3>(keys.places);
        repeat_key<4>(keys.turns);
      }
    }
    bytes_ += 28 * track.links.size();
  }
}

}  // namespace limber
