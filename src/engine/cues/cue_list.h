// CueList: the cues of a show, and the text format of their file. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"
#include "engine/presets/morph.h"

namespace limber::engine {

/// When a cue that is started runs: at once, or at the next beat or bar of the clock.
enum class CueStart : std::uint8_t { now, beat, bar };
/// Their names in files, in order.
std::span<const std::string_view> cue_starts();

/// A step of a show: recalls a preset, then sends messages.
struct Cue {
  static constexpr std::size_t kMaxMessages = 256;
  static constexpr std::size_t kMaxArguments = 64;    ///< Of a message.
  static constexpr std::size_t kMaxText = 1024;       ///< Bytes of an address, an argument or the note.
  static constexpr double kMaxFollowSeconds = 86400;  ///< s

  std::string name;                ///< Unique.
  std::string preset;              ///< Empty: none.
  double time = 0;                 ///< Duration of the recall, s.
  Easing easing = Easing::smooth;  ///< Of the recall.
  std::vector<Message> messages;
  CueStart at = CueStart::now;
  std::string when;              ///< Address; its message starts this cue if it is the next one. Empty: none.
  std::optional<double> begin;   ///< Of the first cue: it starts by itself at this simulated time (s) of the scene.
  std::optional<double> follow;  ///< Simulated seconds from this cue to the next one; nothing: it waits for GO.
  std::string note;              ///< For people.
};

using CueList = std::vector<Cue>;
inline constexpr std::size_t kMaxCues = 1000;

/// Parses a cue file. Errors name the line, or the cue and its field.
Result<CueList> parse_cues(std::string_view text);

/// Returns the messages of a cue, in order: the recall of its preset, then its messages.
std::vector<Message> messages_of(const Cue& cue);

}  // namespace limber::engine
