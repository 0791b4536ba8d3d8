// Urgent requests: panic, the end of a panic, pause, and the end of a take. They overtake all other commands.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/commands/command.h"

namespace limber::engine {

enum class UrgentKind : std::uint8_t { panic, panic_end, pause, take_stop };

/// Returns the kind of an urgent request; none for other messages, patterns, the value 0 (a released button) and
/// invalid arguments. [any]
std::optional<UrgentKind> urgent_kind(const Message& message);
/// Returns the kind of urgent request that an address belongs to, regardless of the arguments of the message. [any]
std::optional<UrgentKind> urgent_kind_of_address(std::string_view address);

struct UrgentRequest {
  UrgentKind kind = UrgentKind::panic;
  Message message;
  CommandOrigin origin;
  std::uint64_t arrival = 0;  ///< As Command::arrival.
};

/// Decides which requests are discarded because a later urgent request has overtaken them: executed afterwards, they
/// would undo it. Pause and panic discard play, step and /take/play; panic also discards everything that would end it
/// (reset, rewind, another scene, the start of a take); the end of a take discards the start of one.
class UrgentPrecedence {
 public:
  /// Call it for each executed urgent request. [sim]
  void record(const UrgentRequest& request) { newest_[static_cast<std::size_t>(request.kind)] = request.arrival; }
  /// True if a message with this arrival number must be discarded. [sim]
  bool discards(const Message& message, std::uint64_t arrival) const;
  /// True if a message must be discarded because an urgent request of `kind` follows it in the same command, where all
  /// messages have the same arrival number. [any]
  static bool discards(const Message& message, UrgentKind kind);

 private:
  std::array<std::uint64_t, 4> newest_{};  // by kind
};

}  // namespace limber::engine
