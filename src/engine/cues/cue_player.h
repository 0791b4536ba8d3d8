// CuePlayer: the cues that are loaded, and which of them has run last. A take contains the changes of its state and the
// messages that cues send, so a replay doesn't read the cue file. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cues/cue_list.h"

namespace limber::engine {

/// A request of a controller.
struct CueRequest {
  enum class Kind : std::uint8_t { go, back, pause, jump };
  Kind kind = Kind::go;
  Arg value = {};  ///< Of `jump`: the name or the number of a cue. Of `pause`: on or off; nil: the other one.
};

/// The part of the state that is an input of the simulation: recorded in takes, restored by rewinds.
struct CueState {
  std::uint32_t number = 0;            ///< Of the cue that has run last, from 1; 0: none.
  std::string name;                    ///< Its name.
  std::optional<std::uint32_t> ticks;  ///< Ticks until the next cue starts by itself; nothing: it waits for GO.
  bool paused = false;                 ///< `ticks` doesn't count.
  std::uint32_t waiting = 0;           ///< Number of the cue that waits for its beat, from 1; 0: none.
  bool operator==(const CueState&) const = default;
};

class CuePlayer {
 public:
  CuePlayer() = default;

  const std::shared_ptr<const CueList>& list() const { return list_; }
  /// Names, one per line.
  std::string_view names() const { return names_; }
  /// One line per cue, with tabs between name, preset, time, easing, at, when, follow and note.
  std::string_view fields() const { return fields_; }
  /// Replaces the cues. `file`: their file, for messages.
  void set_list(std::shared_ptr<const CueList> list, std::string file);

  const CueState& state() const { return state_; }
  void set_state(CueState state) { state_ = std::move(state); }
  /// Number of the cue that has run last in the present list, which may have been edited since; 0: none.
  std::uint32_t position() const;
  /// Name of the cue that waits for its beat; empty: none.
  std::string waiting_name() const;

  /// Returns the index of the cue that a request starts. Not for `pause`.
  Result<std::size_t> target(const CueRequest& request) const;
  /// True if the next cue starts by itself now.
  bool due() const { return state_.ticks == 0U && !state_.paused && position() < list_->size(); }
  /// True if the first cue starts by itself at this time of the scene.
  bool begins(double time) const {
    return state_ == CueState{} && !list_->empty() && list_->front().begin && time + 1e-9 >= *list_->front().begin;
  }
  /// Counts one tick.
  void advance() {
    if (!state_.paused && state_.ticks && *state_.ticks > 0) --*state_.ticks;
  }

 private:
  Result<std::size_t> find(const Arg& cue) const;

  std::shared_ptr<const CueList> list_ = std::make_shared<const CueList>();
  std::string names_, fields_;
  std::string file_;
  CueState state_;
};

/// Encodes a state as an input of a pass: a message with an empty address.
Message message_of(const CueState& state);
/// Decodes it. Returns nothing if `message` is another one.
std::optional<CueState> cue_state_of(const Message& message);

}  // namespace limber::engine
