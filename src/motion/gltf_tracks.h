// GltfTracks: what bodies did, as keys of glTF's channels: each link in its parent's frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "motion/motion.h"

namespace limber {

struct GltfLinkKeys {
  std::vector<float> places;  ///< Three a key.
  std::vector<float> turns;   ///< Four a key, x y z w, never further than half a turn from the one before.
  bool still = true;          ///< All keys are the same but for rounding.
};

struct GltfTrack {
  MotionBody body;
  std::size_t first = 0;              ///< The frame of the first key.
  std::size_t last_there = 0;         ///< The last frame in which it is there: keys end with it.
  std::vector<GltfLinkKeys> links;    ///< A key a frame from `first` on; what is gone stays as it was.
  std::vector<std::size_t> switches;  ///< Frames in which it came, went, came again …; the first is `first`.

  std::size_t keys() const { return last_there - first + 1; }
};

class GltfTracks {
 public:
  void add_body(const MotionBody& body);
  void add_frame(double time, std::span<const MotionSample> bodies);
  const std::vector<GltfTrack>& tracks() const { return tracks_; }
  /// Seconds since the first frame.
  const std::vector<float>& times() const { return times_; }
  /// Of all keys.
  std::uint64_t bytes() const { return bytes_; }

 private:
  void add_keys(GltfTrack& track, const MotionSample& sample);

  std::vector<GltfTrack> tracks_;
  std::vector<float> times_;
  double begin_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace limber
