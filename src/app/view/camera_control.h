// CameraControl: moves the scene's camera with the mouse, follows a part, frames objects, and returns to the default
// view. Its functions return the messages that set the camera.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/view/window.h"
#include "base/message.h"
#include "engine/output/render_scene.h"
#include "engine/output/snapshot.h"
#include "sim/visuals/framing.h"
#include "ui/render/camera.h"

namespace limber::app {

/// [main]
class CameraControl {
 public:
  /// Uses the view of the first snapshot as the default one.
  void set_default_view(const engine::Snapshot& first);
  std::vector<Message> default_view() const;

  /// Follows the part at this offset of Snapshot::transient. The camera keeps its direction and distance.
  std::vector<Message> follow(const engine::Snapshot& snapshot, std::uint32_t part);
  void stop_following() { followed_.reset(); }

  /// Views these spheres, from the same direction as now. `aspect`: of the part of the window that shows the view.
  /// Returns nothing if there are no spheres.
  static std::vector<Message> frame(const engine::CameraSettings& camera, std::span<const sim::FramedSphere> spheres,
                                    double aspect);

  /// `height`: of the part of the window that shows the view, pixels. `now` in s.
  std::vector<Message> move(const MouseMovement& mouse, const engine::CameraSettings& camera, double height,
                            double now);

 private:
  render::Orbit default_view_;
  render::Orbit orbit_;                    // used while the mouse moves the camera
  double moved_at_ = -1;                   // time of the last movement, s
  Vec3 follow_offset_{0};                  // position of the eye relative to the followed part
  std::optional<std::uint32_t> followed_;  // the part that follow_offset_ belongs to
};

}  // namespace limber::app
