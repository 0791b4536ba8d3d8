// AmplificationLimit: protects against amplification attacks. Senders on this machine, in a directly connected subnet
// or in --osc-allow are not limited. A datagram from another network may have a forged source address, and answers
// would then hit an uninvolved machine. An unverified address therefore gets at most three bytes for each byte received
// from it, until it has returned a token that was sent there (as in QUIC address validation, RFC 9000 section 8).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "net/osc/endpoint.h"
#include "net/osc/options.h"
#include "net/osc/warning_throttle.h"

namespace limber::osc {

/// Limits answers per source address. [net]
class AmplificationLimit {
 public:
  static constexpr std::int64_t kAmplification = 3;
  static constexpr std::int64_t kMaxCredit = 65536;               ///< Maximum credit of a sender in bytes.
  static constexpr std::int64_t kTokenInterval = 1'000'000'000;   ///< ns between two tokens to the same address.
  static constexpr std::int64_t kTokenLifetime = 60'000'000'000;  ///< ns; a token is accepted for one to two lifetimes.
  static constexpr std::int64_t kVerifiedLifetime = 3600'000'000'000;  ///< ns for which a token lifts the limit.
  static constexpr std::int64_t kSubnetsLifetime = 5'000'000'000;      ///< ns for which the list of subnets is cached.
  static constexpr std::size_t kSlots = 1024;  ///< Number of remembered addresses; a power of two.

  using ListSubnets = std::function<std::vector<Cidr>()>;

  /// `list_subnets` returns the directly connected subnets; it is called again for unknown senders. `secret` is the key
  /// of the tokens.
  AmplificationLimit(std::vector<Cidr> allow, ListSubnets list_subnets, std::array<std::uint64_t, 2> secret);

  /// True if the address is not limited, regardless of tokens.
  bool trusted(const IpAddress& ip, std::int64_t now);
  /// True if the address is trusted or has returned its token.
  bool is_unlimited(const IpAddress& ip, std::int64_t now);
  /// Credits the address for a datagram of `bytes` bytes received from it.
  void add_credit(const IpAddress& ip, std::size_t bytes, std::int64_t now);
  /// Charges `bytes` to the address. Returns false if they must not be sent.
  bool try_consume(const IpAddress& ip, std::size_t bytes, std::int64_t now);
  /// As try_consume(); warns about withheld datagrams.
  bool try_send(const Endpoint& to, std::size_t bytes, std::int64_t now);

  /// Returns a token to send to the address now, if a datagram was withheld or the sender is subscribing.
  std::optional<std::string> make_challenge(const IpAddress& ip, bool is_subscribing, std::int64_t now);
  /// Verifies a returned token and lifts the limit. Returns false if the token is wrong or too old.
  bool verify_token(const IpAddress& ip, std::string_view token, std::int64_t now);

  /// Number of datagrams withheld so far.
  std::uint64_t withheld() const { return withheld_; }

 private:
  struct Source {
    IpAddress ip;
    std::int64_t credit = 0;
    std::int64_t token_at = 0;
    bool withheld = false;
  };
  struct Verified {
    IpAddress ip;
    std::int64_t until = 0;
  };
  Source& source(const IpAddress& ip);
  Verified& verified(const IpAddress& ip) { return verified_[slot(ip)]; }
  std::size_t slot(const IpAddress& ip) const;
  std::uint64_t word_of(const IpAddress& ip) const;
  std::string token_of(const IpAddress& ip, std::int64_t epoch) const;

  std::vector<Cidr> allow_;
  ListSubnets list_subnets_;
  std::array<std::uint64_t, 2> secret_;
  std::vector<Cidr> subnets_;
  std::optional<std::int64_t> subnets_at_;
  std::vector<Source> sources_;     // unverified; a forged sender may evict another, which loses its credit
  std::vector<Verified> verified_;  // only addresses that returned their token, so forged senders can't evict them
  std::uint64_t withheld_ = 0;
  WarningThrottle withheld_log_;
};

/// The subnets of the system's interfaces and loopback. [any]
std::vector<Cidr> connected_subnets();

}  // namespace limber::osc
