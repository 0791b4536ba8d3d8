// Fuzzes the reader of BVH files.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "model/mocap/bvh.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = limber::model::parse_bvh(text, "fuzz.bvh");
  if (!read) {
    limber::must(read.error().find("fuzz.bvh, line ") == 0);
    return 0;
  }
  const limber::model::BvhClip& clip = **read;
  limber::must(!clip.joints.empty() && clip.joints.size() <= limber::model::BvhClip::kMaxJoints);
  limber::must(clip.frames > 0 && clip.values.size() == clip.frames * clip.channels);
  limber::must(std::isfinite(clip.duration()));
  for (std::size_t i = 0; i < clip.joints.size(); i++) {
    limber::must(clip.joints[i].parent < static_cast<int>(i));
    limber::must(clip.joints[i].first_channel + clip.joints[i].channel_count <= clip.channels);
    for (const double time : {-1.0, 0.0, clip.duration() * 0.37, clip.duration(), 1e9}) {
      const limber::Pose pose = clip.local_pose_at(i, time);
      limber::must(limber::is_finite(pose.position) && limber::is_finite(pose.rotation));
    }
  }
  return 0;
}
