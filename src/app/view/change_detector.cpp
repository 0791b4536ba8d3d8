// Comparing snapshots by what they show.
#include "app/view/change_detector.h"

#include <algorithm>

namespace limber::app {

namespace {

// true if both have the same poses, shapes and values
bool looks_alike(const engine::Snapshot& a, const engine::Snapshot& b) {
  if (a.tick != b.tick || a.render_scene != b.render_scene || a.visuals_version != b.visuals_version ||
      a.transient.size() != b.transient.size() || a.overlay.size() != b.overlay.size())
    return false;
  const engine::TransientOffsets& at = engine::transient_offsets();
  for (const engine::BodyEntry& body : b.body_list->bodies) {
    if (a.transient[body.enabled_offset] != b.transient[body.enabled_offset]) return false;
    for (const std::uint32_t part : body.part_offsets) {
      const auto same = [&](std::uint32_t offset, std::size_t width) {
        const auto* const first = a.transient.data() + part + offset;
        return std::equal(first, first + width, b.transient.data() + part + offset);
      };
      if (!same(at.part_position, 3) || !same(at.part_rotation, 4)) return false;
    }
  }
  return true;
}

}  // namespace

bool ChangeDetector::changed(const std::shared_ptr<const engine::Snapshot>& newest, int width, int height, bool input) {
  const bool moved = newest != nullptr && (last_ == nullptr || !newest->paused || !looks_alike(*last_, *newest));
  if (!moved && !input && width == width_ && height == height_) return false;
  last_ = newest;
  width_ = width;
  height_ = height;
  return true;
}

}  // namespace limber::app
