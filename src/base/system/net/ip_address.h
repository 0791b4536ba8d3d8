// IPv4 and IPv6 addresses and their text. [any]
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace limber::system {

/// An IPv4 or IPv6 address.
struct IpAddress {
  std::uint64_t high = 0;  ///< First half of an IPv6 address, in host byte order; 0 for IPv4.
  std::uint64_t low = 0;   ///< Second half, or the IPv4 address.
  std::uint32_t zone = 0;  ///< Index of the network interface of a link-local IPv6 address; 0: none.
  bool is_v6 = false;

  /// The address 0.0.0.0, which also means "none".
  constexpr IpAddress() = default;
  constexpr IpAddress(std::uint32_t ipv4) : low(ipv4) {}  // NOLINT(google-explicit-constructor): both are addresses
  constexpr IpAddress(std::uint64_t first, std::uint64_t second, std::uint32_t interface = 0)
      : high(first), low(second), zone(interface), is_v6(true) {}

  auto operator<=>(const IpAddress&) const = default;  // NOLINT(modernize-use-nullptr): a false alarm of clang-tidy 14

  /// True for 0.0.0.0 and [::].
  constexpr bool is_any() const { return high == 0 && low == 0; }
  constexpr bool is_loopback() const { return is_v6 ? high == 0 && low == 1 : low >> 24U == 127; }
  /// True for 224.0.0.0 to 239.255.255.255 and ff00::/8.
  constexpr bool is_multicast() const { return is_v6 ? high >> 56U == 0xff : low >> 28U == 0xe; }
  /// True for IPv6 addresses that are valid on one network only, and therefore need its interface: fe80::/10, ff01::/16
  /// and ff02::/16.
  constexpr bool is_link_local() const {
    return is_v6 && (high >> 54U == 0x3fa || high >> 48U == 0xff01 || high >> 48U == 0xff02);
  }
};

/// Returns "127.0.0.1", "::1" or "fe80::1%eth0".
std::string ip_text(const IpAddress& ip);

/// Parses an address of either kind, without brackets. A link-local one may end with %, followed by the name or the
/// index of an interface of this machine. An IPv4-mapped address (::ffff:1.2.3.4) gives the IPv4 address.
std::optional<IpAddress> parse_ip(std::string_view text);
/// Parses an address such as "192.168.1.7", to host byte order; nullopt if it is invalid.
std::optional<std::uint32_t> parse_ipv4(const std::string& text);
/// True for an IPv4 or IPv6 address without brackets or port. The interface after a % need not exist.
bool is_ip_address(std::string_view text);
/// Returns the reason why the address can't be used without the name of an interface, or an empty text.
std::string missing_zone(std::string_view text);

/// Returns "host:port", or "[host]:port" for an IPv6 address.
std::string host_port_text(std::string_view host, std::uint16_t port);

/// The parts of "HOST:PORT" or "[IPv6]:PORT".
struct HostPort {
  std::string_view host;  ///< Without brackets; empty if there is no colon.
  std::string_view port;
  bool bracketed = false;
};
/// Splits at the last colon, or after brackets. Text after a bracket that isn't a port becomes part of the host.
HostPort split_host_port(std::string_view text);

}  // namespace limber::system
