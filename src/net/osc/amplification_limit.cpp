// Fixed-size hash tables with one slot per address, so memory does not grow with the number of senders.
#include "net/osc/amplification_limit.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/net/interfaces.h"

namespace limber {

namespace {

constexpr Cidr kLoopback{0x7f000000, 8};

}  // namespace

// The two words are hashed as 16 little-endian bytes and their length, like in the reference implementation.
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
    // an interface that routes everything, such as a tunnel, does not prove that a sender is near
    if (subnet.bits > 0) list.push_back({subnet.ip, subnet.bits});
  }
  return list;
}

AmplificationLimit::AmplificationLimit(std::vector<Cidr> allow, Subnets connected, std::array<std::uint64_t, 2> secret)
    : allow_(std::move(allow)),
      connected_(std::move(connected)),
      secret_(secret),
      sources_(kSlots),
      verified_(kSlots) {}

std::size_t AmplificationLimit::slot(std::uint32_t ip) const { return sip_hash(secret_, ip, 0) % kSlots; }

AmplificationLimit::Source& AmplificationLimit::source(std::uint32_t ip) {
  Source& source = sources_[slot(ip)];
  if (source.ip != ip) source = {ip, 0, 0, false};
  return source;
}

bool AmplificationLimit::trusted(std::uint32_t ip, std::int64_t now) {
  const auto in = [ip](const Cidr& range) { return range.contains(ip); };
  if (std::ranges::any_of(allow_, in) || std::ranges::any_of(subnets_, in)) return true;
  // interfaces may have changed
  if (subnets_at_ && now - *subnets_at_ < kSubnetsLifetime) return false;
  subnets_at_ = now;
  subnets_ = connected_();
  return std::ranges::any_of(subnets_, in);
}

void AmplificationLimit::add_credit(std::uint32_t ip, std::size_t bytes, std::int64_t now) {
  if (trusted(ip, now)) return;
  Source& from = source(ip);
  from.credit = std::min(from.credit + kAmplification * static_cast<std::int64_t>(bytes), kMaxCredit);
}

bool AmplificationLimit::try_consume(std::uint32_t ip, std::size_t bytes, std::int64_t now) {
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

bool AmplificationLimit::try_send(const Endpoint& to, std::size_t bytes, std::int64_t now) {
  if (try_consume(to.ip, bytes, now)) return true;
  if (const auto more = withheld_log_.admit(now)) {
    log_warning(
        "OSC out: {} is in another network and limited to three bytes for each byte received until it returns /token. "
        "--osc-allow {}/32 removes the limit{}",
        endpoint_text(to), system::endpoint_text({to.ip, 0}), *more);
  }
  return false;
}

std::optional<std::string> AmplificationLimit::make_challenge(std::uint32_t ip, bool wants_more, std::int64_t now) {
  if (trusted(ip, now)) return std::nullopt;
  const Verified& known = verified(ip);
  if (known.ip == ip && now < known.until) return std::nullopt;
  Source& to = source(ip);
  if (!wants_more && !to.withheld) return std::nullopt;
  if (to.token_at != 0 && now - to.token_at < kTokenInterval) return std::nullopt;
  to.token_at = now;
  to.withheld = false;
  return token_of(ip, now / kTokenLifetime);
}

bool AmplificationLimit::verify_token(std::uint32_t ip, std::string_view token, std::int64_t now) {
  const std::int64_t epoch = now / kTokenLifetime;
  if (token != token_of(ip, epoch) && token != token_of(ip, epoch - 1)) return false;
  verified(ip) = {ip, now + kVerifiedLifetime};
  return true;
}

std::string AmplificationLimit::token_of(std::uint32_t ip, std::int64_t epoch) const {
  return fmt::format("{:016x}", sip_hash(secret_, ip, static_cast<std::uint64_t>(epoch) + 1));
}

}  // namespace limber
