// PictureHand: a mouse in the picture: it chooses a part with a click, follows it with two, drags it with a spring, and
// with Ctrl pushes it. Knows no window.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "engine/image.h"
#include "gui/input.h"
#include "view/pick.h"

namespace limber {

/// What the hand sees: the picture of that size in pixels.
struct HandView {
  const Snapshot& now;
  const Image& image;  ///< Of the same show; where it is older, nothing is found.
  Lens lens;
  int width = 1;
  int height = 1;
  double clock = 0;  ///< s

  const Tree& tree() const { return *image.tree; }
};

class PictureHand {
 public:
  static constexpr double kStill = 4;      ///< Pixels that a click may move.
  static constexpr double kTwice = 0.4;    ///< s between the two of a double click.
  static constexpr double kPushSpeed = 2;  ///< m/s that a push gives a part that is free.

  /// A press, a release or a move that is not the panel's.
  void event(const InputEvent& event, const HandView& view);
  /// Once a picture: where what is held is pulled to.
  void frame(const HandView& view);

  /// It has hold of a part: a drag does not turn the view.
  bool holds() const { return held_.has_value(); }
  /// Messages since the last call.
  std::vector<Message> take_messages() { return std::exchange(messages_, {}); }
  /// Address of the part that a click has chosen since the last call; empty: none.
  std::string take_chosen() { return std::exchange(chosen_, {}); }
  /// The part to follow; nothing: none.
  const std::optional<std::uint32_t>& followed() const { return followed_; }
  void follow_nothing() { followed_.reset(); }

  /// What is dragged and where to, pixels, for a mark in the picture.
  struct Mark {
    double x = 0, y = 0, to_x = 0, to_y = 0;
    std::string name;
  };
  std::optional<Mark> mark(const HandView& view) const;

 private:
  struct Held {
    std::uint32_t part_at = 0;
    std::string body, part, path;
    Vec3 point{0};     // in the part's frame
    double depth = 0;  // along the view, m
    double x = 0, y = 0;
    bool moved = false;
  };

  void press(const InputEvent& event, const HandView& view);
  void release(const HandView& view);
  Vec3 target(const HandView& view) const;

  std::optional<Held> held_;
  std::optional<std::uint32_t> followed_;
  double x_ = 0, y_ = 0;  // of the mouse
  std::string last_path_;
  double last_click_ = -1;
  std::string chosen_;
  std::vector<Message> messages_;
};

}  // namespace limber
