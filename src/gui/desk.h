// Desk: what lies before a panel: what is (an image, the newest snapshot), what hands may do (messages), and what the
// panels share among themselves. Nothing of the world is kept here.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/link.h"
#include "gui/fonts.h"
#include "gui/hand_values.h"
#include "gui/settings.h"
#include "gui/widget_names.h"

namespace limber {

/// A row's place in the image's tree, with its address.
struct PlacedRow {
  TreePlace place;
  std::string path;
};

struct GuiOptions;

/// The take that is recorded or replayed, as the image has it.
struct TakeState {
  std::string name;  ///< Empty: there is none.
  bool replays = false;
  bool plays = false;  ///< In the place of a show: /take/stop brings the hands back.
  double seconds = 0;  ///< So far; of a replay: where it is.
  double whole = 0;    ///< Of a replay: how long the take is.
  bool recorded() const { return !name.empty() && !replays; }
};

/// How far back one press goes, s.
inline constexpr double kRewindSeconds = 2;

class Desk {
 public:
  explicit Desk(EngineLink& engine_link) : link(engine_link) {}

  EngineLink& link;
  std::shared_ptr<const Image> image;   ///< Null until the first has come.
  std::shared_ptr<const Snapshot> now;  ///< Newer than the image; null until the first.
  Fonts fonts;
  double scale = 1;  ///< Pixels for what is a pixel at text of 16.
  double clock = 0;  ///< s, of the frame; for what blinks or fades.
  WidgetNames names;
  PanelSettings settings;
  const GuiOptions* options = nullptr;  ///< What the app has handed over.

  // what panels tell each other
  std::string selected;            ///< Address of the chosen thing; empty: none.
  std::string reveal;              ///< The tree shows this thing once.
  std::vector<std::string> plots;  ///< Addresses of rows that are plotted.
  bool focus_search = false;       ///< The next frame's search field takes the keyboard.
  bool help = false;               ///< F2.
  int move_behavior = 0;           ///< The chosen behaviour is to act earlier (-1) or later (1).
  std::string notice;              ///< A line that is shown for a while, such as what was copied.
  double notice_until = 0;         ///< s
  std::string refusal;             ///< The newest message of the panel's that was refused, and why.
  double refusal_until = 0;        ///< s
  /// What a hand drags in the picture, and where to, pixels.
  struct Mark {
    double x = 0, y = 0, to_x = 0, to_y = 0;
    std::string name;
  };
  std::optional<Mark> mark;
  std::uint64_t errors = 0;  ///< Faults that stand, for lamps.

  /// The clipboard; the window's, in tests one of their own.
  std::function<void(const std::string&)> copy = [](const std::string&) {};

  /// To the simulation, in its next tick. Returns the number of the ask for an image behind it.
  std::uint64_t send(Message message);
  std::uint64_t send(std::string address, std::vector<Arg> args = {});
  /// Sets a row as the hand wishes; `held`: the hand goes on, so that undo takes all of it back at once.
  void set(const PlacedRow& at, const HandValues::Values& values, bool held);
  /// What the panel shows of a row: the hand's, else the image's. False: it is an action or a text.
  bool values(const PlacedRow& at, HandValues::Values& values) const;
  std::string_view text(const TreePlace& place) const;
  /// The row of that address in the image, of a pattern the first; or nothing.
  std::optional<PlacedRow> find(std::string_view path) const;
  /// One number of a row, by address; what `otherwise` says where there is none.
  double number(std::string_view path, double otherwise = 0) const;

  /// The same for what a pattern reaches at once; `shown` then says what the hand said, until it is heard.
  void set_all(const std::string& pattern, double value);
  std::optional<double> shown(const std::string& pattern) const;
  /// No hand holds anything: the next value that is set is an edit of its own.
  void let_go() { holding_ = false; }

  /// The thing of that address is chosen, and shown in the tree.
  void choose(std::string path);
  /// The debug picture, on and off.
  void toggle_overlay();
  /// The camera's view, kept by a number from 1 to 9 as long as the window is open, and taken again.
  void keep_view(std::size_t number);
  void go_to_view(std::size_t number);
  /// A preset by its number from 1, in the time that is set.
  void recall(double number);

  // what the transport does
  bool panicked() const { return number("/physics/sim/panicked") != 0; }
  void panic() { send("/transport/panic"); }
  void step_time(int ticks) { send("/transport/step", {Arg::of(static_cast<double>(ticks))}); }
  void rewind(double seconds) { send("/transport/rewind", {Arg::of(seconds)}); }
  TakeState take() const;
  /// A take begins, or ends.
  void record() { send(take().recorded() ? "/take/stop" : "/take/record"); }
  /// The newest take plays in the place of the show, or ends.
  void play_take() { send(take().plays ? "/take/stop" : "/take/play"); }

  /// Takes back what a hand has set last, whichever it was, and does it again.
  void undo();
  void redo();
  void say(std::string text);
  void copied(const std::string& text);

  /// A frame begins: the newest of everything, and an image is asked for when its time has come.
  void look(double clock_now);

 private:
  void hear_answers();
  void prefer_style();
  void step_back(const char* action, const char* what, const char* none);

  /// Rows of the camera; each of the two keeps the other where it is.
  struct View {
    HandValues::Values eye{}, target{};
  };
  std::array<std::optional<View>, 9> views_;
  HandValues hand_;
  bool holding_ = false;
  std::uint16_t gesture_ = 0;
  std::uint64_t asked_ = 0;
  double asked_at_ = 0;
  std::vector<Outgoing> answers_;  // scratch
};

/// Names of the ways in which morphs go.
std::vector<std::string> easings();

/// The message that sets a row to these values.
Message set_message(const std::string& path, const Row& row, const HandValues::Values& values);

}  // namespace limber
