// ViewportMouse: mouse input in the 3D view: a click selects a part, a double click follows it, a drag pulls it with a
// spring, and Ctrl+click pushes it. Independent of the window system.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "engine/output/value_snapshot.h"
#include "ui/panel/imgui/input.h"
#include "ui/panel/spring_marker.h"
#include "ui/render/pick.h"

namespace limber::app {

/// The view at the time of an event; sizes in pixels.
struct ViewState {
  const engine::Snapshot& now;
  const engine::ValueSnapshot&
      values;  ///< Values of the same show; if its structure is older than `now`, no part is found.
  render::CameraMatrices camera;
  int width = 1;
  int height = 1;
  double clock = 0;  ///< s

  const TreeSnapshot& tree() const { return *values.tree; }
};

/// [main]
class ViewportMouse {
 public:
  static constexpr double kClickTolerance = 4;     ///< Pixels that the mouse may move during a click.
  static constexpr double kDoubleClickTime = 0.4;  ///< s between the two clicks of a double click.
  static constexpr double kPushSpeed = 2;          ///< m/s that a push gives a free part.

  /// Handles a press, release or move that the panel does not use.
  void event(const panel::InputEvent& event, const ViewState& view);
  /// Called once per frame: updates the target of the part that is being dragged.
  void frame(const ViewState& view);

  /// True while a part is being dragged: then a drag must not orbit the camera.
  bool has_grab() const { return grab_.has_value(); }
  /// Returns the messages since the last call.
  std::vector<Message> consume_messages() { return std::exchange(messages_, {}); }
  /// Returns the address of the part selected since the last call; empty: none.
  std::string consume_selection() { return std::exchange(selected_, {}); }
  /// The part that the camera follows, by its offset; nullopt: none.
  const std::optional<std::uint32_t>& followed() const { return followed_; }
  void stop_following() { followed_.reset(); }

  /// Returns the marker of the current drag.
  std::optional<panel::SpringMarker> spring_marker(const ViewState& view) const;

 private:
  struct Grab {
    std::uint32_t part_offset = 0;
    std::string body, part, path;
    Vec3 point{0};     // in the part's frame
    double depth = 0;  // along the view, m
    double x = 0, y = 0;
    bool moved = false;
  };

  void press(const panel::InputEvent& event, const ViewState& view);
  void release(const ViewState& view);
  Vec3 target(const ViewState& view) const;

  std::optional<Grab> grab_;
  std::optional<std::uint32_t> followed_;
  double x_ = 0, y_ = 0;  // position of the mouse
  std::string last_path_;
  double last_click_ = -1;
  std::string selected_;
  std::vector<Message> messages_;
};

}  // namespace limber::app
