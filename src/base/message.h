// Message: an OSC address with arguments. All external input (OSC, command line, console, panel) reaches the simulation
// as messages, and a take records them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/system/net/ip_address.h"

namespace limber {

/// One argument: a number, a boolean, text, or nil. All OSC number types are converted to double.
struct Arg {
  enum class Kind : std::uint8_t { number, boolean, text, nil };
  Kind kind = Kind::nil;
  double number = 0;  ///< The value of a number; 1 or 0 of a boolean.
  std::string text;

  static Arg of(double v) { return {Kind::number, v, {}}; }
  static Arg of(bool v) { return {Kind::boolean, v ? 1.0 : 0.0, {}}; }
  static Arg of(std::string_view v) { return {Kind::text, 0, std::string(v)}; }
  static Arg of(const char* v) { return of(std::string_view(v)); }

  bool is_numeric() const { return kind == Kind::number || kind == Kind::boolean; }
  bool is_text() const { return kind == Kind::text; }
};

struct Message {
  std::string address;  ///< Starts with '/'; may contain OSC patterns in incoming messages.
  std::vector<Arg> args;
};

/// The kind of controller that sent a message.
enum class CommandSource : std::uint8_t { osc, oscquery, command_line, console, panel, script, midi };

/// The sender of a message, and where a reply goes.
struct CommandOrigin {
  CommandSource source = CommandSource::osc;
  system::IpAddress ip = {};   ///< 0.0.0.0: none.
  std::uint16_t port = 0;      ///< Without an address: number of the gesture (such as a mouse drag) that it belongs to.
  bool is_subscriber = false;  ///< It receives changes; its own changes are recorded to avoid echoing them.

  /// Compares everything except the subscription.
  bool operator==(const CommandOrigin& other) const {
    return source == other.source && ip == other.ip && port == other.port;
  }
};

/// Returns the sender as text: "192.168.1.5:57120" or "[fe80::1%eth0]:57120", or the kind of source if there is no
/// address: "console". [any]
std::string sender_text(const CommandOrigin& origin);

}  // namespace limber
