// Message: an address with arguments. Everything that comes from outside (OSC, command line, console, panel) reaches
// the simulation in this one form, and a take records it so.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

/// One argument: a number, a boolean, text, or nothing. Numbers of every width are doubles here.
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
  std::string address;  ///< Starts with '/'; may hold OSC patterns when it comes in.
  std::vector<Arg> args;
};

/// Which hand sent a message, and where an answer goes.
enum class Hand : std::uint8_t { osc, query, command_line, console, panel, script };

struct Origin {
  Hand hand = Hand::osc;
  std::uint32_t ip = 0;    ///< IPv4 in host order; 0: no address to answer to.
  std::uint16_t port = 0;  ///< Without an address: which of the hand's gestures this belongs to, such as a drag.
  bool follows = false;    ///< It is told of changes: what it sets is noted, so that it is not told that.

  /// The same hand, whatever it follows.
  bool operator==(const Origin& other) const { return hand == other.hand && ip == other.ip && port == other.port; }
};

/// "192.168.1.5:57120"; without an address the hand: "console". [any]
std::string sender_text(const Origin& origin);

}  // namespace limber
