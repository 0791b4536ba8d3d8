// Text of addresses with inet_pton() and inet_ntop(); names of interfaces with if_nametoindex().
#include "base/system/net/ip_address.h"

#include <arpa/inet.h>
#include <net/if.h>

#include <array>
#include <charconv>

#include <fmt/format.h>

namespace limber::system {

namespace {

constexpr std::uint64_t kMappedPrefix = 0xffff;  // ::ffff:0:0/96

std::uint64_t word_at(const std::array<unsigned char, 16>& bytes, std::size_t at) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < 8; i++) word = word << 8U | bytes[at + i];
  return word;
}

std::optional<IpAddress> parse_ipv6(const std::string& text) {
  std::array<unsigned char, 16> bytes{};
  if (inet_pton(AF_INET6, text.c_str(), bytes.data()) != 1) return std::nullopt;
  const IpAddress ip(word_at(bytes, 0), word_at(bytes, 8));
  if (ip.high == 0 && ip.low >> 32U == kMappedPrefix) return IpAddress(static_cast<std::uint32_t>(ip.low));
  return ip;
}

// An index, or the name of an interface of this machine.
std::optional<std::uint32_t> parse_zone(std::string_view text) {
  std::uint32_t index = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (fault == std::errc() && end == text.data() + text.size() && index != 0) return index;
  index = if_nametoindex(std::string(text).c_str());
  return index == 0 ? std::nullopt : std::optional(index);
}

}  // namespace

std::string ip_text(const IpAddress& ip) {
  if (!ip.is_v6)
    return fmt::format("{}.{}.{}.{}", ip.low >> 24 & 255u, ip.low >> 16 & 255u, ip.low >> 8 & 255u, ip.low & 255u);
  std::array<unsigned char, 16> bytes;
  for (std::size_t i = 0; i < 8; i++) {
    bytes[i] = static_cast<unsigned char>(ip.high >> (56 - 8 * i));
    bytes[8 + i] = static_cast<unsigned char>(ip.low >> (56 - 8 * i));
  }
  std::array<char, INET6_ADDRSTRLEN> buffer{};
  std::string text = inet_ntop(AF_INET6, bytes.data(), buffer.data(), buffer.size());
  if (ip.zone == 0) return text;
  std::array<char, IF_NAMESIZE> name{};
  const bool known = if_indextoname(ip.zone, name.data()) != nullptr;
  return text + '%' + (known ? std::string(name.data()) : fmt::format("{}", ip.zone));
}

std::optional<IpAddress> parse_ip(std::string_view text) {
  if (const std::optional<std::uint32_t> ipv4 = parse_ipv4(std::string(text))) return IpAddress(*ipv4);
  const std::size_t percent = text.find('%');
  std::optional<IpAddress> ip = parse_ipv6(std::string(text.substr(0, percent)));
  if (!ip || percent == std::string_view::npos) return ip;
  const std::optional<std::uint32_t> zone = parse_zone(text.substr(percent + 1));
  if (!zone || !ip->is_link_local()) return std::nullopt;
  ip->zone = *zone;
  return ip;
}

std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr number{};
  if (inet_pton(AF_INET, text.c_str(), &number) != 1) return std::nullopt;
  return ntohl(number.s_addr);
}

bool is_ip_address(std::string_view text) {
  const std::size_t percent = text.find('%');
  const std::optional<IpAddress> ip = parse_ip(text.substr(0, percent));
  return ip && (percent == std::string_view::npos || ip->is_link_local());
}

std::string missing_zone(std::string_view text) {
  const std::optional<IpAddress> ip = parse_ip(text);
  if (!ip || !ip->is_link_local() || ip->zone != 0) return {};
  return fmt::format("{0} is valid on one network only; add its interface, such as [{0}%eth0]", text);
}

std::string host_port_text(std::string_view host, std::uint16_t port) {
  return host.find(':') == std::string_view::npos ? fmt::format("{}:{}", host, port)
                                                  : fmt::format("[{}]:{}", host, port);
}

HostPort split_host_port(std::string_view text) {
  const std::size_t end = text.rfind(']');
  const std::size_t colon = text.rfind(':');
  if (text.starts_with('[') && end != std::string_view::npos && colon == end + 1)
    return {text.substr(1, end - 1), text.substr(colon + 1), true};
  if (colon == std::string_view::npos || (end != std::string_view::npos && colon < end)) return {{}, text, false};
  return {text.substr(0, colon), text.substr(colon + 1), false};
}

}  // namespace limber::system
