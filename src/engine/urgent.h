// Urgent requests: panic, the end of a panic, pause, and the end of a take. They overtake all other commands.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/command.h"

namespace limber {

enum class UrgentKind : std::uint8_t { panic, panic_end, pause, take_stop };

/// The kind of an urgent request. None: another message, a pattern, the value 0 (a button that is released), or
/// arguments that are to be rejected. [any]
std::optional<UrgentKind> urgent_kind(const Message& message);
/// The same by an address alone. [any]
std::optional<UrgentKind> urgent_address(std::string_view address);
/// Whether a received address is `plain`, ignoring case, underscores and a final slash. Allocates nothing. [any]
bool same_address(std::string_view address, std::string_view plain);

struct UrgentRequest {
  UrgentKind kind = UrgentKind::panic;
  Message message;
  Origin origin;
  std::uint64_t arrival = 0;  ///< As Command::arrival.
};

/// Which requests are discarded because a later urgent request overtook them: executed afterwards, they would undo it.
/// Pause and panic discard play, step and /take/play; panic also discards whatever would end it (reset, rewind, another
/// scene, the start of a take); the end of a take discards the start of one.
class Overtaken {
 public:
  /// An urgent request is executed. [sim]
  void note(const UrgentRequest& request) { newest_[static_cast<std::size_t>(request.kind)] = request.arrival; }
  /// Whether a message that arrived at that time is to be discarded. [sim]
  bool discards(const Message& message, std::uint64_t arrival) const;
  /// The same within one command, whose messages have one time of arrival: `kind` follows the message. [any]
  static bool discards(const Message& message, UrgentKind kind);

 private:
  std::array<std::uint64_t, 4> newest_{};  // by kind
};

}  // namespace limber
