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

constexpr const char* kOutForm = "HOST:PORT[,rate=60,bundle=1472,streams=pos+rot,bodies=arm*,errors=on]";
constexpr const char* kAllowUsage = "write --osc-allow 192.168.1.0/24 or fd00::/8, or several separated by commas";

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

// Returns the reason why this address can't be used, or an empty text.
std::string address_fault(std::string_view option, const system::HostPort& address) {
  if (address.bracketed && !system::is_ip_address(address.host)) return "there must be an IPv6 address in brackets";
  if (!address.bracketed && address.host.find(':') != std::string_view::npos)
    return "an IPv6 address is written in brackets, such as [::1]:9003";
  if (std::string fault = system::missing_zone(address.host); !fault.empty()) return fault;
  const std::optional<IpAddress> ip = parse_ip(address.host.substr(0, address.host.find('%')));
  if (ip && ip->is_multicast() && option != "--osc-in" && option != "--osc-out")
    return "a multicast group is for --osc-in only; write the address of this machine, or 0.0.0.0";
  return {};
}

}  // namespace

bool Cidr::contains(const IpAddress& address) const {
  if (address.is_v6 != ip.is_v6 || (ip.zone != 0 && address.zone != ip.zone)) return false;
  const auto mask = [](int count) {
    return count <= 0 ? std::uint64_t{0} : ~std::uint64_t{0} << (64 - std::min(count, 64));
  };
  const std::uint64_t high = ip.is_v6 ? mask(bits) : 0;
  const std::uint64_t low = ip.is_v6 ? mask(bits - 64) : mask(bits + 32);
  return ((address.high ^ ip.high) & high) == 0 && ((address.low ^ ip.low) & low) == 0;
}

bool is_allowed(const std::vector<Cidr>& list, const IpAddress& address) {
  return list.empty() || std::ranges::any_of(list, [&](const Cidr& c) { return c.contains(address); });
}

Result<std::vector<ListenAddress>> parse_osc_in(std::string_view text) { return parse_listen("--osc-in", text); }

Result<std::vector<ListenAddress>> parse_listen(std::string_view option, std::string_view text) {
  std::vector<ListenAddress> addresses;
  if (text == "off") return addresses;
  for (const std::string_view piece : split(text, ',')) {
    ListenAddress address;
    const system::HostPort parts = system::split_host_port(piece);
    const std::string fault = address_fault(option, parts);
    if (!fault.empty()) return Error{fmt::format("{} '{}': {}", option, printable(text), fault)};
    const std::optional<std::uint16_t> port = parse_port(parts.port);
    if (!port || (parts.host.empty() && parts.port.size() != piece.size())) {
      return Error{
          fmt::format("{0} '{1}': no port in '{2}'; write {0} [ADDR:]PORT, such as 9003 or 0.0.0.0:9003, or off",
                      option, printable(text), printable(piece))};
    }
    if (!parts.host.empty()) address.address = parts.host;
    address.port = *port;
    addresses.push_back(address);
  }
  return addresses;
}

namespace {

// Error texts have no prefix.
Result<StreamTarget> parse_target_text(std::string_view text, const std::vector<StreamTarget>& known) {
  const std::vector<std::string_view> pieces = split_options(text);
  StreamTarget target;
  const system::HostPort address = system::split_host_port(pieces[0]);
  if (const std::string fault = address_fault("--osc-out", address); !fault.empty()) return Error{fault};
  const std::optional<std::uint16_t> port = parse_port(address.port);
  if (!port || *port == 0 || !system::is_host_text(address.host)) {
    return Error{fmt::format("'{}' is not HOST:PORT", printable(pieces[0]))};
  }
  target.host = address.host;
  target.port = *port;
  const auto same = std::ranges::find_if(
      known, [&](const StreamTarget& each) { return each.host == target.host && each.port == target.port; });
  if (same != known.end()) target = *same;
  for (std::size_t i = 1; i < pieces.size(); i++) {
    const std::size_t equals = pieces[i].find('=');
    const std::string_view value = equals == std::string_view::npos ? "" : pieces[i].substr(equals + 1);
    if (const std::optional<std::string> error = set_option(target, pieces[i].substr(0, equals), value)) {
      return Error{*error};
    }
  }
  return target;
}

}  // namespace

Result<std::vector<StreamTarget>> parse_osc_out(std::string_view text) {
  if (text == "off") return std::vector<StreamTarget>{};
  Result<StreamTarget> target = parse_target_text(text, {});
  if (!target)
    return Error{
        fmt::format("--osc-out '{}': {}; write --osc-out {}, or off", printable(text), target.error(), kOutForm)};
  return std::vector<StreamTarget>{std::move(*target)};
}

Result<StreamTarget> parse_target(std::string_view text, const std::vector<StreamTarget>& known) {
  Result<StreamTarget> target = parse_target_text(text, known);
  if (!target) return Error{fmt::format("'{}': {}; write {}", printable(text), target.error(), kOutForm)};
  return target;
}

Result<std::vector<Cidr>> parse_osc_allow(std::string_view text) {
  std::vector<Cidr> list;
  for (const std::string_view piece : split(text, ',')) {
    const std::size_t slash = piece.find('/');
    // numeric addresses only: a host name may resolve differently later
    std::string_view address = piece.substr(0, slash);
    if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
    const std::optional<IpAddress> ip = parse_ip(address);
    const int max_bits = ip && ip->is_v6 ? 128 : 32;
    const std::optional<std::uint16_t> bits =
        slash == std::string_view::npos ? static_cast<std::uint16_t>(max_bits) : parse_port(piece.substr(slash + 1));
    if (!ip || !bits || *bits > max_bits) {
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
  for (ListenAddress& address : config.listen) address.shared = options.shared;
  return config;
}

bool is_ipv6_only(const OscConfig& config) {
  return !config.listen.empty() && std::ranges::all_of(config.listen, [](const ListenAddress& address) {
    return address.address.find(':') != std::string::npos;
  });
}

std::string target_text(const StreamTarget& target) {
  std::string text = host_port_text(target.host, target.port);
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
