// SourceLimit: what may be sent to whom. Senders on this machine, in a directly connected subnet and in --osc-allow are
// served in full. An address of another network may be forged, and answers would then hit a stranger: it gets at most
// three bytes for each byte that came from it, until it has returned a token that was sent there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "osc/options.h"

namespace limber {

/// [net]
class SourceLimit {
 public:
  static constexpr std::int64_t kFactor = 3;
  static constexpr std::int64_t kMostCredit = 65536;                ///< Bytes that are kept for a sender.
  static constexpr std::int64_t kTokenEvery = 1'000'000'000;        ///< ns between two tokens to one address.
  static constexpr std::int64_t kTokenLasts = 60'000'000'000;       ///< ns; it is accepted for one to two of these.
  static constexpr std::int64_t kVerifiedLasts = 3600'000'000'000;  ///< ns after the token has come back.
  static constexpr std::int64_t kSubnetsLast = 5'000'000'000;       ///< ns
  static constexpr std::size_t kSources = 1024;                     ///< Addresses that are remembered; a power of two.

  using Subnets = std::function<std::vector<Cidr>()>;

  /// `connected`: the directly connected subnets; read again when an unknown sender comes. The secret makes tokens.
  SourceLimit(std::vector<Cidr> allow, Subnets connected, std::array<std::uint64_t, 2> secret);

  /// Whether that address is served in full, without a token.
  bool trusted(std::uint32_t ip, std::int64_t now);
  /// A datagram of so many bytes has come from there.
  void received(std::uint32_t ip, std::size_t bytes, std::int64_t now);
  /// Whether so many bytes may be sent there; counts them when so.
  bool allows(std::uint32_t ip, std::size_t bytes, std::int64_t now);

  /// A token that is to be sent to an address now, because something was withheld or it wants more than answers
  /// (`wants_more`).
  std::optional<std::string> token(std::uint32_t ip, bool wants_more, std::int64_t now);
  /// A token has come back. False: it is wrong, or too old.
  bool accept(std::uint32_t ip, std::string_view token, std::int64_t now);

  /// Datagrams that were withheld so far.
  std::uint64_t withheld() const { return withheld_; }

 private:
  struct Source {
    std::uint32_t ip = 0;
    std::int64_t credit = 0;
    std::int64_t token_at = 0;
    bool withheld = false;
  };
  struct Verified {
    std::uint32_t ip = 0;
    std::int64_t until = 0;
  };
  Source& source(std::uint32_t ip);
  Verified& verified(std::uint32_t ip) { return verified_[slot(ip)]; }
  std::size_t slot(std::uint32_t ip) const;
  std::string token_of(std::uint32_t ip, std::int64_t epoch) const;

  std::vector<Cidr> allow_;
  Subnets connected_;
  std::array<std::uint64_t, 2> secret_;
  std::vector<Cidr> subnets_;
  std::optional<std::int64_t> subnets_at_;
  std::vector<Source> sources_;  // those without a token; a forged sender may push another out, which costs that credit
  std::vector<Verified> verified_;  // only who can read what is sent to an address gets in here
  std::uint64_t withheld_ = 0;
};

/// SipHash-2-4 (Aumasson, Bernstein 2012) of two words. [any]
std::uint64_t sip_hash(const std::array<std::uint64_t, 2>& key, std::uint64_t first, std::uint64_t second);

/// The system's, with loopback. [any]
std::vector<Cidr> connected_subnets();

}  // namespace limber
