// OSC command line options: parsing, and their precedence over the scene's configuration and the default.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/commands/command.h"
#include "net/osc/endpoint.h"

namespace limber::osc {

/// A range of addresses.
struct Cidr {
  IpAddress ip = {};
  int bits = 32;  ///< Number of leading bits that count, 0 .. 32, or 128 for IPv6.

  /// A link-local address must also have the same zone, unless this one has none.
  bool contains(const IpAddress& address) const;
};

/// True if one of the ranges contains the address, or if the list is empty. [any]
bool is_allowed(const std::vector<Cidr>& list, const IpAddress& address);

/// The OSC options of the command line. `in` and `out`: nullopt if the option is not given; an empty list means off.
struct OscOptions {
  std::optional<std::vector<ListenAddress>> in;  ///< `--osc-in`; nullopt: the scene or the default decides.
  std::optional<std::vector<StreamTarget>> out;  ///< `--osc-out`.
  std::vector<Cidr> allow;                       ///< `--osc-allow`; empty: every sender is allowed.
  bool optional = false;                         ///< `--osc-optional`: continue if a port can't be opened.
  /// Returns the directly connected subnets; senders in them are not limited. Empty: asks the system.
  std::function<std::vector<Cidr>()> connected = {};
  std::vector<ListenAddress> tcp = {};  ///< `--osc-tcp`; empty: none.
  bool shared = false;                  ///< `--osc-share`: other programs may open the UDP ports, too.
};

/// Parses `[ADDR:]PORT` (IPv6: `[ADDR]:PORT`) or `off`; several addresses are separated by commas. Port 0 lets the
/// system choose. [any]
Result<std::vector<ListenAddress>> parse_osc_in(std::string_view text);
/// As parse_osc_in() for another option with listen addresses: `--query [ADDR:]PORT|off`. [any]
Result<std::vector<ListenAddress>> parse_listen(std::string_view option, std::string_view text);

/// Parses
/// `HOST:PORT[,rate=60,bundle=off|1472|8192|65504,streams=pos+rot+relrot+relpos|none,bodies=arm*,errors=on|off]`, or
/// `off`, which gives an empty list. Call it once per `--osc-out` option. [any]
Result<std::vector<StreamTarget>> parse_osc_out(std::string_view text);

/// Parses the same text, except `off`. Settings that it does not name are those of the target in `known` with this host
/// and port, or the defaults. [any]
Result<StreamTarget> parse_target(std::string_view text, const std::vector<StreamTarget>& known);

/// Parses `CIDR,…`, such as `192.168.1.0/24`, `fd00::/8` or a single address. [any]
Result<std::vector<Cidr>> parse_osc_allow(std::string_view text);

/// The configuration with the two default ports, which are those of ofxDabPhysics.
OscConfig default_osc_config();

/// True if there are listen addresses and all are of IPv6, so that names of targets prefer it. [any]
bool is_ipv6_only(const OscConfig& config);

/// Returns the listen addresses and targets, each from the first source that sets them: command line, scene, default.
/// The scene's inputs of motion capture are added to the former, unless these are off. [any]
OscConfig effective_config(const OscOptions& options, const OscConfig* scene);

/// "127.0.0.1:9005 (pos+rot at 60 Hz)" with the settings that differ from the default, for the log.
std::string target_text(const StreamTarget& target);

}  // namespace limber::osc
