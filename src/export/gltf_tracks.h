// GltfTracks: records the motion of bodies as keyframes for glTF channels, each link relative to its parent.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "export/motion.h"

namespace limber::exporter {

/// The keyframes of one link.
struct GltfLinkKeys {
  std::vector<float> positions;  ///< x y z per key.
  std::vector<float> rotations;  ///< x y z w per key, with the sign nearest to the previous key.
  bool at_rest = true;           ///< All keys are equal, except for rounding.
};

/// The motion of one body.
struct GltfTrack {
  MotionBody body;
  std::size_t first = 0;            ///< Frame of the first key.
  std::size_t last_present = 0;     ///< Last frame in which the body is present; later keys are not written.
  std::vector<GltfLinkKeys> links;  ///< One key per frame from `first` on; repeated while the body is absent.
  std::vector<std::size_t>
      presence_changes;  ///< Frames in which the body alternately appears and disappears; the first one is `first`.

  /// Number of keys to write.
  std::size_t keys() const { return last_present - first + 1; }
};

/// Collects the motion of all bodies, one frame after another. All keys are stored in memory.
class GltfTracks {
 public:
  void add_body(const MotionBody& body);
  void add_frame(double time, std::span<const MotionSample> bodies);
  const std::vector<GltfTrack>& tracks() const { return tracks_; }
  /// Seconds since the first frame.
  const std::vector<float>& times() const { return times_; }
  /// Size of all keys, bytes.
  std::uint64_t bytes() const { return bytes_; }

 private:
  void add_keys(GltfTrack& track, const MotionSample& sample);

  std::vector<GltfTrack> tracks_;
  std::vector<float> times_;
  double begin_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace limber::exporter
