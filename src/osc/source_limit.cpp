// Tables of fixed size, in which an address has one place: nothing grows with the number of senders.
#include "osc/source_limit.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/system/interfaces.h"

namespace limber {

namespace {

constexpr Cidr kLoopback{0x7f000000, 8};

}  // namespace

// the words are hashed as 16 bytes in little-endian order, and their length as the reference does
std::uint64_t sip_hash(const std::array<std::uint64_t, 2>& key, std::uint64_t first, std::uint64_t second) {
  std::uint64_t v0 = key[0] ^ 0x736f6d6570736575u;
  std::uint64_t v1 = key[1] ^ 0x646f72616e646f6du;
  std::uint64_t v2 = key[0] ^ 0x6c7967656e657261u;
  std::uint64_t v3 = key[1] ^ 0x7465646279746573u;
  const auto rounds = [&](int count) {
    for (int i = 0; i < count; i++) {
      v0 += v1, v1 = std::rotl(v1, 13) ^ v0, v0 = std::rotl(v0, 32);
      v2 += v3, v3 = std::rotl(v3, 16) ^ v2;
      v0 += v3, v3 = std::rotl(v3, 21) ^ v0;
      v2 += v1, v1 = std::rotl(v1, 17) ^ v2, v2 = std::rotl(v2, 32);
    }
  };
  for (const std::uint64_t word : {first, second, std::uint64_t{16} << 56}) {
    v3 ^= word;
    rounds(2);
    v0 ^= word;
  }
  v2 ^= 0xff;
  rounds(4);
  return v0 ^ v1 ^ v2 ^ v3;
}

std::vector<Cidr> connected_subnets() {
  std::vector<Cidr> list = {kLoopback};
  for (const system::Subnet& subnet : system::connected_subnets()) {
    // a link that reaches everything, such as a tunnel, says nothing about who is at its other end
    if (subnet.bits > 0) list.push_back({subnet.ip, subnet.bits});
  }
  return list;
}

SourceLimit::SourceLimit(std::vector<Cidr> allow, Subnets connected, std::array<std::uint64_t, 2> secret)
    : allow_(std::move(allow)),
      connected_(std::move(connected)),
      secret_(secret),
      sources_(kSources),
      verified_(kSources) {}

std::size_t SourceLimit::slot(std::uint32_t ip) const { return sip_hash(secret_, ip, 0) % kSources; }

SourceLimit::Source& SourceLimit::source(std::uint32_t ip) {
  Source& source = sources_[slot(ip)];
  if (source.ip != ip) source = {ip, 0, 0, false};
  return source;
}

bool SourceLimit::trusted(std::uint32_t ip, std::int64_t now) {
  const auto in = [ip](const Cidr& range) { return range.holds(ip); };
  if (std::ranges::any_of(allow_, in) || std::ranges::any_of(subnets_, in)) return true;
  // networks come and go
  if (subnets_at_ && now - *subnets_at_ < kSubnetsLast) return false;
  subnets_at_ = now;
  subnets_ = connected_();
  return std::ranges::any_of(subnets_, in);
}

void SourceLimit::received(std::uint32_t ip, std::size_t bytes, std::int64_t now) {
  if (trusted(ip, now)) return;
  Source& from = source(ip);
  from.credit = std::min(from.credit + kFactor * static_cast<std::int64_t>(bytes), kMostCredit);
}

bool SourceLimit::allows(std::uint32_t ip, std::size_t bytes, std::int64_t now) {
  if (trusted(ip, now)) return true;
  const Verified& known = verified(ip);
  if (known.ip == ip && now < known.until) return true;
  Source& to = source(ip);
  if (to.credit >= static_cast<std::int64_t>(bytes)) {
    to.credit -= static_cast<std::int64_t>(bytes);
    return true;
  }
  to.withheld = true;
  withheld_++;
  return false;
}

std::optional<std::string> SourceLimit::token(std::uint32_t ip, bool wants_more, std::int64_t now) {
  if (trusted(ip, now)) return std::nullopt;
  const Verified& known = verified(ip);
  if (known.ip == ip && now < known.until) return std::nullopt;
  Source& to = source(ip);
  if (!wants_more && !to.withheld) return std::nullopt;
  if (to.token_at != 0 && now - to.token_at < kTokenEvery) return std::nullopt;
  to.token_at = now;
  to.withheld = false;
  return token_of(ip, now / kTokenLasts);
}

bool SourceLimit::accept(std::uint32_t ip, std::string_view token, std::int64_t now) {
  const std::int64_t epoch = now / kTokenLasts;
  if (token != token_of(ip, epoch) && token != token_of(ip, epoch - 1)) return false;
  verified(ip) = {ip, now + kVerifiedLasts};
  return true;
}

std::string SourceLimit::token_of(std::uint32_t ip, std::int64_t epoch) const {
  return fmt::format("{:016x}", sip_hash(secret_, ip, static_cast<std::uint64_t>(epoch) + 1));
}

}  // namespace limber
