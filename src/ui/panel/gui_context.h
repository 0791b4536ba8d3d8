// GuiContext: the data and functions that all panels share: the latest value snapshot and physics snapshot, sending
// messages, and the state of the user interface. It holds no simulation state.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/engine_link.h"
#include "ui/panel/command_sender.h"
#include "ui/panel/imgui/fonts.h"
#include "ui/panel/pending_values.h"
#include "ui/panel/settings.h"
#include "ui/panel/spring_marker.h"
#include "ui/panel/widgets/widget_names.h"

namespace limber::panel {

/// A property in the snapshot's tree and its address.
struct PropertyHandle {
  TreePropertyRef ref;
  std::string path;
};

struct GuiOptions;

/// The take that is being recorded or replayed, from the value snapshot.
struct TakeState {
  std::string name;        ///< Empty: no take is active.
  bool replaying = false;  ///< A take is replayed; messages are rejected.
  bool in_show = false;    ///< The take plays in a running show, which continues at /take/stop.
  double seconds = 0;      ///< Recorded duration, or position of a replay.
  double duration = 0;     ///< Total duration of a replayed take.
  bool recording() const { return !name.empty() && !replaying; }
};

/// A text that is shown for some seconds.
struct TimedText {
  std::string text;
  double until = 0;  ///< s
  bool visible(double now) const { return now < until; }
};

/// A question that is asked before a message is sent, or an action is called.
struct Confirmation {
  std::string question;
  std::string verb;  ///< Label of the button that confirms.
  Message message;
  std::function<void()> action = {};  ///< Called instead of sending the message, if set.
};

/// Requests to panels. The panel that carries one out resets it.
struct PanelRequests {
  std::string reveal_path;    ///< Address of an object that the tree scrolls to in the next frame; empty: none.
  bool focus_search = false;  ///< Moves the keyboard focus to the search field in the next frame.
  std::string route_from;     ///< Address of a property for the source of a new route; empty: none.
  std::string route_to;       ///< The same for its target.
  int move_behavior = 0;      ///< Moves the selected behavior: -1 earlier, 1 later.
  std::optional<Confirmation> confirmation;  ///< The question that the user is asked.
};

/// Duration of one rewind, s.
inline constexpr double kRewindSeconds = 2;

/// [main]
class GuiContext {
 public:
  explicit GuiContext(engine::EngineLink& engine_link) : link(engine_link), commands_(engine_link) {}

  engine::EngineLink& link;
  std::shared_ptr<const engine::ValueSnapshot> value_snapshot;  ///< Value snapshot; null until the first one arrives.
  std::shared_ptr<const engine::Snapshot>
      snapshot;  ///< Newer than the value snapshot; null until the first one arrives.
  Fonts fonts;
  double scale = 1;  ///< Pixels per unit, where a unit is a pixel at text size 16.
  double clock = 0;  ///< Time of the frame in s, for animations.
  WidgetNames names;
  GuiSettings settings;
  const GuiOptions* options = nullptr;  ///< The application's options.

  // State shared by panels
  std::string selected;  ///< Address of the selected object; empty: none.
  PanelRequests requests;
  std::vector<std::string> plots;  ///< Addresses of plotted properties.
  bool show_help = false;          ///< Shows the help (F2).
  TimedText notice;                ///< For example about copied text.
  TimedText rejection;             ///< The panel's last rejected message, with the reason.
  std::optional<SpringMarker> spring_marker;
  std::uint64_t errors = 0;  ///< Number of current errors, for the status indicator.

  /// Copies text to the clipboard: the window's, or a test's own.
  std::function<void(const std::string&)> copy = [](const std::string&) {};

  /// Sends a message to the simulation for its next tick. Returns the number of the request for a value snapshot that
  /// follows it.
  std::uint64_t send(Message message);
  std::uint64_t send(std::string address, std::vector<Arg> args = {});
  /// Sets a property. `dragging`: the user is still dragging, so that a single undo reverts the whole drag.
  void set(const PropertyHandle& handle, const PendingValues::Values& values, bool dragging);
  /// Reads the displayed value of a property: the pending value if there is one, otherwise the snapshot's. Returns
  /// false for actions and texts.
  bool values(const PropertyHandle& handle, PendingValues::Values& values) const;
  /// Returns the text of a property of type text.
  std::string_view text(const TreePropertyRef& ref) const;
  /// Returns the property with this address, or the first match of a pattern.
  std::optional<PropertyHandle> find(std::string_view path) const;
  /// Returns one number of a property by address, or `fallback` if there is none.
  double number(std::string_view path, double fallback = 0) const;

  /// Sets all properties that match the pattern. pending_value() returns the value until a snapshot contains it.
  void set_all(const std::string& pattern, double value);
  std::optional<double> pending_value(const std::string& pattern) const;
  /// Ends the current drag: the next set value is a separate undo step.
  void end_drag() { commands_.end_drag(); }

  /// Selects the object with this address and reveals it in the tree.
  void select(std::string path);
  /// Toggles a property that is true or false, by address.
  void toggle(const char* path);
  /// Recalls a preset by its number from 1, with the configured morph time.
  void recall(double number);

  // Transport
  bool panicked() const { return number("/physics/sim/panicked") != 0; }
  void panic() { send("/transport/panic"); }
  void step_time(int ticks) { send("/transport/step", {Arg::of(static_cast<double>(ticks))}); }
  void rewind(double seconds) { send("/transport/rewind", {Arg::of(seconds)}); }
  TakeState take_state() const;
  /// Starts or stops recording a take.
  void toggle_recording() { send(take_state().recording() ? "/take/stop" : "/take/record"); }
  /// Stops the take that plays, or asks whether the latest one shall replace the running show.
  void toggle_take_playback();

  /// Undoes the latest edit, from any source.
  void undo();
  /// Redoes it.
  void redo();
  void show_notice(std::string text);
  void copy_with_notice(const std::string& text);

  /// Begins a frame: reads the latest snapshots and replies, and requests a value snapshot if it is time.
  void begin_frame(double clock_now);

 private:
  void handle_replies();
  void restore_style();
  void undo_or_redo(const char* action, const char* description_path, const char* nothing_text);

  CommandSender commands_;
  PendingValues pending_;
};

}  // namespace limber::panel
