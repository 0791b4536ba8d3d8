// Stores the addresses in direct-mapped hash tables of fixed size, so that memory does not grow with the number of
// senders.
#include "net/osc/amplification_limit.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/sip_hash.h"
#include "base/system/net/interfaces.h"

namespace limber::osc {

namespace {

constexpr Cidr kLoopback{0x7f000000, 8};
constexpr Cidr kLoopback6{IpAddress(0, 1), 128};

}  // namespace

std::vector<Cidr> connected_subnets() {
  std::vector<Cidr> list = {kLoopback, kLoopback6};
  for (const system::Subnet& subnet : system::connected_subnets()) {
    // an interface that routes everything, such as a tunnel, does not prove that a sender is near
    if (subnet.bits > 0) list.push_back({subnet.ip, subnet.bits});
  }
  return list;
}

AmplificationLimit::AmplificationLimit(std::vector<Cidr> allow, ListSubnets list_subnets,
                                       std::array<std::uint64_t, 2> secret)
    : allow_(std::move(allow)),
      list_subnets_(std::move(list_subnets)),
      secret_(secret),
      sources_(kSlots),
      verified_(kSlots) {}

std::size_t AmplificationLimit::slot(const IpAddress& ip) const { return sip_hash(secret_, word_of(ip), 0) % kSlots; }

// An IPv4 address, or a hash of an IPv6 address.
std::uint64_t AmplificationLimit::word_of(const IpAddress& ip) const {
  return ip.is_v6 ? sip_hash(secret_, ip.high, ip.low) ^ ip.zone : ip.low;
}

AmplificationLimit::Source& AmplificationLimit::source(const IpAddress& ip) {
  Source& source = sources_[slot(ip)];
  if (source.ip != ip) source = {ip, 0, 0, false};
  return source;
}

bool AmplificationLimit::trusted(const IpAddress& ip, std::int64_t now) {
  const auto in = [&ip](const Cidr& range) { return range.contains(ip); };
  if (std::ranges::any_of(allow_, in) || std::ranges::any_of(subnets_, in)) return true;
  // interfaces may have changed
  if (subnets_at_ && now - *subnets_at_ < kSubnetsLifetime) return false;
  subnets_at_ = now;
  subnets_ = list_subnets_();
  return std::ranges::any_of(subnets_, in);
}

bool AmplificationLimit::is_unlimited(const IpAddress& ip, std::int64_t now) {
  const Verified& known = verified(ip);
  return (known.ip == ip && now < known.until) || trusted(ip, now);
}

void AmplificationLimit::add_credit(const IpAddress& ip, std::size_t bytes, std::int64_t now) {
  if (trusted(ip, now)) return;
  Source& from = source(ip);
  from.credit = std::min(from.credit + kAmplification * static_cast<std::int64_t>(bytes), kMaxCredit);
}

bool AmplificationLimit::try_consume(const IpAddress& ip, std::size_t bytes, std::int64_t now) {
  if (is_unlimited(ip, now)) return true;
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
        "--osc-allow {} removes the limit{}",
        endpoint_text(to), ip_text(to.ip), *more);
  }
  return false;
}

std::optional<std::string> AmplificationLimit::make_challenge(const IpAddress& ip, bool is_subscribing,
                                                              std::int64_t now) {
  if (is_unlimited(ip, now)) return std::nullopt;
  Source& to = source(ip);
  if (!is_subscribing && !to.withheld) return std::nullopt;
  if (to.token_at != 0 && now - to.token_at < kTokenInterval) return std::nullopt;
  to.token_at = now;
  to.withheld = false;
  return token_of(ip, now / kTokenLifetime);
}

bool AmplificationLimit::verify_token(const IpAddress& ip, std::string_view token, std::int64_t now) {
  const std::int64_t epoch = now / kTokenLifetime;
  if (token != token_of(ip, epoch) && token != token_of(ip, epoch - 1)) return false;
  verified(ip) = {ip, now + kVerifiedLifetime};
  return true;
}

std::string AmplificationLimit::token_of(const IpAddress& ip, std::int64_t epoch) const {
  return fmt::format("{:016x}", sip_hash(secret_, word_of(ip), static_cast<std::uint64_t>(epoch) + 1));
}

}  // namespace limber::osc
