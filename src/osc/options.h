// What the command line says about OSC, read from its text; and who wins where it, the scene and the default differ.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/command.h"

namespace limber {

/// A range of IPv4 addresses.
struct Cidr {
  std::uint32_t ip = 0;
  int bits = 32;  ///< Leading bits that count, 0 .. 32.

  bool holds(std::uint32_t address) const;
};

/// Whether one of them holds it; an empty list lets everyone in. [any]
bool holds(const std::vector<Cidr>& list, std::uint32_t address);

/// The command line's part. An empty list that is given means off.
struct OscOptions {
  std::optional<std::vector<ListenAddress>> in;  ///< `--osc-in`; nothing: the scene or the default decides.
  std::optional<std::vector<StreamTarget>> out;  ///< `--osc-out`.
  std::vector<Cidr> allow;                       ///< `--osc-allow`; empty: everyone.
  bool optional = false;                         ///< `--osc-optional`: play on when a port can't be had.
  /// The directly connected subnets, whose senders are served in full; nothing: the system's.
  std::function<std::vector<Cidr>()> connected = {};
};

/// `[ADDR:]PORT` or `off`; several, separated by commas. Port 0 lets the system choose. [any]
Result<std::vector<ListenAddress>> parse_osc_in(std::string_view text);
/// The same for another option that says where to listen: `--query [ADDR:]PORT|off`. [any]
Result<std::vector<ListenAddress>> parse_listen(std::string_view option, std::string_view text);

/// `HOST:PORT[,rate=60,bundle=off|1472|8192|65504,streams=pos+rot+relrot+relpos|none,bodies=arm*,errors=on|off]`, or
/// `off`, which gives no target. Each `--osc-out` on the command line is one call. [any]
Result<std::vector<StreamTarget>> parse_osc_out(std::string_view text);

/// `CIDR,…`: `192.168.1.0/24`, or one address. [any]
Result<std::vector<Cidr>> parse_osc_allow(std::string_view text);

/// The seed's two ports.
OscPlan default_osc_plan();

/// Listen addresses and targets each from the first that says something: command line, scene, default. [any]
OscPlan effective_plan(const OscOptions& options, const OscPlan* scene);

/// "127.0.0.1:9005" and what differs from the default, for the lines at start.
std::string target_text(const StreamTarget& target);

}  // namespace limber
