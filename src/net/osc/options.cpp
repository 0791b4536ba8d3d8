// The parsers' errors name the option, the text that was given and the correct form.
#include "net/osc/options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "net/osc/endpoint.h"

namespace limber::osc {

namespace {

constexpr const char* kOutUsage =
    "write --osc-out HOST:PORT[,rate=60,bundle=1472,streams=pos+rot,bodies=arm*,errors=on], or off";
constexpr const char* kAllowUsage = "write --osc-allow 192.168.1.0/24, or several separated by commas";

std::optional<std::uint16_t> parse_port(std::string_view text) {
  if (text.empty() || text.size() > 5) return std::nullopt;
  unsigned port = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    port = port * 10 + static_cast<unsigned>(c - '0');
  }
  if (port > 65535) return std::nullopt;
  return static_cast<std::uint16_t>(port);
}

std::optional<bool> parse_bool(std::string_view text) {
  if (text == "on" || text == "true" || text == "1") return true;
  if (text == "off" || text == "false" || text == "0") return false;
  return std::nullopt;
}

// Returns an error text with the correct form, or nothing if the value was accepted.
std::optional<std::string> set_streams(StreamTarget& target, std::string_view value) {
  target.pos = target.rot = target.relrot = target.relpos = false;
  if (value == "none") return std::nullopt;
  for (const std::string_view name : split(value, '+')) {
    if (name == "pos") {
      target.pos = true;
    } else if (name == "rot") {
      target.rot = true;
    } else if (name == "relrot") {
      target.relrot = true;
    } else if (name == "relpos") {
      target.relpos = true;
    } else {
      return "streams must be pos, rot, relrot, relpos joined by +, or none";
    }
  }
  return std::nullopt;
}

std::optional<std::string> set_option(StreamTarget& target, std::string_view key, std::string_view value) {
  if (key == "rate") {
    const std::optional<double> rate = parse_number(value);
    if (!rate || *rate < 0.1 || *rate > 1000) return "rate must be 0.1 to 1000 frames per second";
    target.rate = *rate;
  } else if (key == "bundle") {
    constexpr std::pair<std::string_view, int> kSizes[] = {
        {"off", 0}, {"1472", 1472}, {"8192", 8192}, {"65504", 65504}};
    const auto* const size = std::ranges::find(kSizes, value, &std::pair<std::string_view, int>::first);
    if (size == std::end(kSizes)) return "bundle must be off, 1472, 8192 or 65504 bytes";
    target.bundle = size->second;
  } else if (key == "streams") {
    return set_streams(target, value);
  } else if (key == "bodies") {
    if (value.empty()) return "bodies must be a name or a pattern, such as arm*";
    target.bodies = value;
  } else if (key == "errors") {
    const std::optional<bool> on = parse_bool(value);
    if (!on) return "errors must be on or off";
    target.errors = *on;
  } else {
    const std::vector<std::string> keys = {"rate", "bundle", "streams", "bodies", "errors"};
    return fmt::format("unknown setting '{}'{}", printable(key), name_hint(key, keys));
  }
  return std::nullopt;
}

// Splits at commas, except inside the braces of a pattern.
std::vector<std::string_view> split_options(std::string_view text) {
  std::vector<std::string_view> pieces;
  int level = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); i++) {
    if (text[i] == '{') level++;
    if (text[i] == '}') level--;
    if (text[i] != ',' || level > 0) continue;
    pieces.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  pieces.push_back(text.substr(begin));
  return pieces;
}

// Returns the reason why listening at this address is not supported, or null.
const char* unsupported_reason(std::string_view option, std::string_view address) {
  if (address.find(':') != std::string_view::npos || address.starts_with('[')) {
    return "IPv6 is not supported; write an IPv4 address, such as 127.0.0.1:9003 or 0.0.0.0:9003";
  }
  const std::optional<std::uint16_t> first = parse_port(address.substr(0, address.find('.')));
  if (first && *first >= 224 && *first <= 239 && option != "--osc-in")
    return "a multicast group is for --osc-in only; write the address of this machine, or 0.0.0.0";
  return nullptr;
}

}  // namespace

bool Cidr::contains(std::uint32_t address) const {
  const std::uint32_t mask = bits == 0 ? 0 : ~std::uint32_t{0} << (32 - bits);
  return (address & mask) == (ip & mask);
}

bool is_allowed(const std::vector<Cidr>& list, std::uint32_t address) {
  return list.empty() || std::ranges::any_of(list, [&](const Cidr& c) { return c.contains(address); });
}

Result<std::vector<ListenAddress>> parse_osc_in(std::string_view text) { return parse_listen("--osc-in", text); }

Result<std::vector<ListenAddress>> parse_listen(std::string_view option, std::string_view text) {
  std::vector<ListenAddress> addresses;
  if (text == "off") return addresses;
  for (const std::string_view piece : split(text, ',')) {
    ListenAddress address;
    const std::size_t colon = piece.rfind(':');
    const std::string_view port_text = colon == std::string_view::npos ? piece : piece.substr(colon + 1);
    if (colon != std::string_view::npos) address.address = piece.substr(0, colon);
    if (const char* const reason = unsupported_reason(option, address.address)) {
      return Error{fmt::format("{} '{}': {}", option, printable(text), reason)};
    }
    const std::optional<std::uint16_t> port = parse_port(port_text);
    if (!port || address.address.empty()) {
      return Error{
          fmt::format("{0} '{1}': no port in '{2}'; write {0} [ADDR:]PORT, such as 9003 or 0.0.0.0:9003, or off",
                      option, printable(text), printable(piece))};
    }
    address.port = *port;
    addresses.push_back(address);
  }
  return addresses;
}

Result<std::vector<StreamTarget>> parse_osc_out(std::string_view text) {
  if (text == "off") return std::vector<StreamTarget>{};
  const std::vector<std::string_view> pieces = split_options(text);
  StreamTarget target;
  const std::size_t colon = pieces[0].rfind(':');
  const std::optional<std::uint16_t> port =
      colon == std::string_view::npos ? std::nullopt : parse_port(pieces[0].substr(colon + 1));
  if (!port || *port == 0 || colon == 0) {
    return Error{
        fmt::format("--osc-out '{}': '{}' is not HOST:PORT; {}", printable(text), printable(pieces[0]), kOutUsage)};
  }
  target.host = pieces[0].substr(0, colon);
  target.port = *port;
  for (std::size_t i = 1; i < pieces.size(); i++) {
    const std::size_t equals = pieces[i].find('=');
    const std::string_view value = equals == std::string_view::npos ? "" : pieces[i].substr(equals + 1);
    if (const std::optional<std::string> error = set_option(target, pieces[i].substr(0, equals), value)) {
      return Error{fmt::format("--osc-out '{}': {}; {}", printable(text), *error, kOutUsage)};
    }
  }
  return std::vector<StreamTarget>{target};
}

Result<std::vector<Cidr>> parse_osc_allow(std::string_view text) {
  std::vector<Cidr> list;
  for (const std::string_view piece : split(text, ',')) {
    const std::size_t slash = piece.find('/');
    const std::optional<std::uint16_t> bits =
        slash == std::string_view::npos ? std::uint16_t{32} : parse_port(piece.substr(slash + 1));
    // numeric addresses only: a host name may resolve differently later
    const std::optional<std::uint32_t> ip = parse_ipv4(std::string(piece.substr(0, slash)));
    if (!ip || !bits || *bits > 32) {
      return Error{fmt::format("--osc-allow '{}': '{}' is not an address range; {}", printable(text), printable(piece),
                               kAllowUsage)};
    }
    list.push_back({*ip, *bits});
  }
  return list;
}

OscConfig default_osc_config() { return {{ListenAddress{}}, {StreamTarget{}}}; }

OscConfig effective_config(const OscOptions& options, const OscConfig* scene) {
  OscConfig config = default_osc_config();
  if (scene != nullptr && !scene->listen.empty()) config.listen = scene->listen;
  if (scene != nullptr && !scene->targets.empty()) config.targets = scene->targets;
  if (options.in) config.listen = *options.in;
  if (options.out) config.targets = *options.out;
  const bool off = options.in && options.in->empty();
  if (scene != nullptr && !off) {
    for (const ListenAddress& address : scene->trackers) {
      if (std::ranges::find(config.listen, address) == config.listen.end()) config.listen.push_back(address);
    }
  }
  return config;
}

std::string target_text(const StreamTarget& target) {
  std::string text = fmt::format("{}:{}", target.host, target.port);
  std::string streams;
  for (const auto& [on, name] : {std::pair(target.pos, "pos"), std::pair(target.rot, "rot"),
                                 std::pair(target.relrot, "relrot"), std::pair(target.relpos, "relpos")}) {
    if (on) streams += (streams.empty() ? "" : "+") + std::string(name);
  }
  text += fmt::format(" ({} at {} Hz", streams.empty() ? "no streams" : streams, number_text(target.rate));
  if (target.bodies != "*") text += fmt::format(", bodies {}", printable(target.bodies));
  if (target.bundle == 0) text += ", no bundles";
  if (target.bundle > 0) text += fmt::format(", bundles of {} bytes", target.bundle);
  if (target.errors) text += ", errors";
  return text + ")";
}

}  // namespace limber::osc
