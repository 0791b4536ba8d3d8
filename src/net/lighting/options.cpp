// Options of the output to lights: parser and texts.
#include "net/lighting/options.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/text.h"
#include "net/lighting/packets.h"

namespace limber::lighting {

namespace {

constexpr const char* kLightsUsage =
    "write artnet[:ADDRESS[:PORT]], sacn[:ADDRESS[:PORT]] or enttec:DEVICE, such as artnet:10.0.0.5, then ,rate=44 "
    ",priority=100 ,sync=1 ,interface=10.0.0.2 ,name=Limber ,universe=1 ,exit=blackout|hold ,panic=hold|blackout; "
    "or off";

std::optional<double> whole_number(std::string_view text, double low, double high) {
  const std::optional<double> number = parse_number(text);
  return number && *number >= low && *number <= high && std::floor(*number) == *number ? number : std::nullopt;
}

// Sets a setting that is a number. Returns the expected values, or nothing.
std::optional<std::string> set_number(LightTarget& target, std::string_view key, std::string_view value) {
  if (key == "rate") {
    const std::optional<double> rate = parse_number(value);
    if (!rate || !(*rate >= 1 && *rate <= 1000)) return "a number from 1 to 1000";
    target.rate = *rate;
  } else if (key == "priority") {
    const std::optional<double> priority = whole_number(value, 0, 200);
    if (!priority) return "a whole number from 0 to 200";
    target.priority = static_cast<std::uint8_t>(*priority);
  } else if (key == "universe") {
    const std::optional<double> universe = whole_number(value, 1, 63999);
    if (!universe) return "a universe from 1 to 63999";
    target.universe = static_cast<std::uint16_t>(*universe);
  } else {
    const std::optional<double> universe = whole_number(value, 1, 63999);
    if (!universe && value != "off") return "a universe from 1 to 63999, or off";
    target.sync = static_cast<std::uint16_t>(universe.value_or(0));
  }
  return std::nullopt;
}

// The same for a setting that is a text.
std::optional<std::string> set_text(LightTarget& target, std::string_view key, std::string_view value) {
  if (key == "interface") {
    const std::optional<std::uint32_t> ip = system::parse_ipv4(std::string(value));
    if (!ip) return "an IPv4 address of this machine";
    target.interface = *ip;
  } else if (key == "name") {
    if (name_error(value) || value.size() >= kSourceNameBytes) return "1 to 63 bytes of printable text";
    target.name = value;
  } else {
    if (value != "blackout" && value != "hold") return "blackout or hold";
    (key == "exit" ? target.dark_at_end : target.dark_in_panic) = value == "blackout";
  }
  return std::nullopt;
}

// Sets one setting. Returns an error text, or nothing.
std::optional<std::string> set_setting(LightTarget& target, std::string_view key, std::string_view value) {
  static const std::vector<std::string_view> numbers = {"rate", "priority", "sync", "universe"};
  static const std::vector<std::string_view> known = {"rate", "priority", "sync", "interface",
                                                      "name", "universe", "exit", "panic"};
  if (std::ranges::find(known, key) == known.end())
    return fmt::format("unknown setting '{}'{}", printable(key), name_hint(key, known));
  const bool of_sacn = key == "priority" || key == "sync" || key == "name";
  if (of_sacn && target.protocol != Protocol::sacn) return fmt::format("{} is a setting of sacn only", key);
  const bool serial = target.protocol == Protocol::enttec;
  if (key == "universe" && !serial) return "universe is a setting of enttec only";
  if (key == "interface" && serial) return "interface is no setting of enttec";
  const bool is_number = std::ranges::find(numbers, key) != numbers.end();
  const std::optional<std::string> expected = is_number ? set_number(target, key, value) : set_text(target, key, value);
  if (!expected) return std::nullopt;
  return fmt::format("{} must be {}, got '{}'", key, *expected, printable(value));
}

// Sets protocol and address. Returns an error text, or nothing.
std::optional<std::string> set_address(LightTarget& target, std::string_view text) {
  constexpr std::string_view kEnttec = "enttec";
  if (text == kEnttec || text.starts_with("enttec:")) {
    target.protocol = Protocol::enttec;
    target.device = text.substr(std::min(text.size(), kEnttec.size() + 1));
    if (target.device.empty()) return "the device is missing, such as enttec:/dev/ttyUSB0";
    return std::nullopt;
  }
  const std::vector<std::string_view> words = split(text, ':');
  if (words[0] != "artnet" && words[0] != "sacn") {
    static const std::vector<std::string_view> known = {"artnet", "sacn", "enttec", "off"};
    return fmt::format("unknown protocol '{}'{}", printable(words[0]), name_hint(words[0], known));
  }
  const bool art_net = words[0] == "artnet";
  target.protocol = art_net ? Protocol::art_net : Protocol::sacn;
  target.to = {art_net ? 0xffffffffU : 0U, art_net ? kArtNetPort : kSacnPort};
  if (words.size() > 3) return "too many colons";
  if (words.size() > 1) {
    const std::optional<std::uint32_t> ip = system::parse_ipv4(std::string(words[1]));
    if (!ip || *ip == 0) return fmt::format("'{}' is not an IPv4 address", printable(words[1]));
    target.to.ip = *ip;
  }
  if (words.size() > 2) {
    const std::optional<double> port = whole_number(words[2], 1, 65535);
    if (!port) return fmt::format("'{}' is not a port", printable(words[2]));
    target.to.port = static_cast<std::uint16_t>(*port);
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<LightTarget>> parse_lights_out(std::string_view text) {
  if (text == "off") return std::vector<LightTarget>{};
  const std::vector<std::string_view> pieces = split(text, ',');
  LightTarget target;
  std::optional<std::string> fault = set_address(target, pieces[0]);
  for (std::size_t i = 1; i < pieces.size() && !fault; i++) {
    const std::size_t equals = pieces[i].find('=');
    const std::string_view value = equals == std::string_view::npos ? "" : pieces[i].substr(equals + 1);
    fault = set_setting(target, pieces[i].substr(0, equals), value);
  }
  if (fault) return Error{fmt::format("--lights-out '{}': {}; {}", printable(text), *fault, kLightsUsage)};
  return std::vector<LightTarget>{target};
}

std::string target_text(const LightTarget& target) {
  const std::string at = fmt::format("at most {} Hz", number_text(target.rate));
  if (target.protocol == Protocol::enttec)
    return fmt::format("Enttec DMX USB Pro {}, universe {}, {}", printable(target.device), target.universe, at);
  if (target.protocol == Protocol::art_net) return fmt::format("Art-Net {}, {}", system::endpoint_text(target.to), at);
  const std::string to = target.to.ip == 0 ? "multicast" : system::endpoint_text(target.to);
  const std::string sync = target.sync == 0 ? "" : fmt::format(", sync universe {}", target.sync);
  return fmt::format("sACN {}, priority {}, {}{}", to, target.priority, at, sync);
}

}  // namespace limber::lighting
