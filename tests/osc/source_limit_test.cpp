// Limits per source address: trusted senders and the amount that others get. Addresses are only data here.
#include "base/sip_hash.h"
#include "net/osc/amplification_limit.h"

#include <gtest/gtest.h>

#include "base/system/net/socket.h"

namespace limber::osc::test {
namespace {

std::uint32_t ip(const char* text) { return system::parse_ipv4(text).value(); }

constexpr std::int64_t kSecond = 1'000'000'000;

struct LimitFixture {
  std::vector<Cidr> connected = {{0x7f000000, 8}, {0xc0a80105, 24}};  // loopback, 192.168.1.5/24
  int subnet_reads = 0;
  std::int64_t now = 5 * kSecond;
  AmplificationLimit limit = make({});

  AmplificationLimit make(std::vector<Cidr> allow) {
    return AmplificationLimit(std::move(allow),
                              [this] {
                                subnet_reads++;
                                return connected;
                              },
                              {1, 2});
  }
  // Returns the number of these datagrams that may be sent.
  int count_allowed(const char* to, std::size_t bytes, int count) {
    int sent = 0;
    for (int i = 0; i < count; i++) sent += limit.try_consume(ip(to), bytes, now) ? 1 : 0;
    return sent;
  }
};

TEST(AmplificationLimit, TrustsConnectedSubnets) {
  LimitFixture sources;
  for (const char* near : {"127.0.0.1", "127.9.9.9", "192.168.1.5", "192.168.1.77", "192.168.1.255"}) {
    EXPECT_EQ(sources.count_allowed(near, 1'000'000, 100), 100) << near;
    EXPECT_FALSE(sources.limit.make_challenge(ip(near), true, sources.now)) << near;
  }
  EXPECT_EQ(sources.limit.withheld(), 0u);
}

TEST(AmplificationLimit, AllowsThreeBytesPerByte) {
  for (const char* far : {"192.168.2.5", "10.0.0.1", "203.0.113.9", "8.8.8.8"}) {
    LimitFixture sources;
    EXPECT_EQ(sources.count_allowed(far, 1, 10), 0) << far << " has sent nothing";
    std::size_t received = 0;
    int sent = 0;
    for (const std::size_t bytes : {20, 28, 1, 200}) {
      sources.limit.add_credit(ip(far), bytes, sources.now);
      received += bytes;
      sent += sources.count_allowed(far, 8, 1000);
      EXPECT_LE(sent * 8, static_cast<int>(3 * received));
      EXPECT_GT(sent * 8, static_cast<int>(3 * received) - 8);
    }
    EXPECT_GT(sources.limit.withheld(), 0u);
  }
}

TEST(AmplificationLimit, LimitsCredit) {
  LimitFixture sources;
  for (int i = 0; i < 1000; i++) sources.limit.add_credit(ip("10.0.0.1"), 60'000, sources.now);
  EXPECT_EQ(sources.count_allowed("10.0.0.1", 1024, 1000), AmplificationLimit::kMaxCredit / 1024);
}

TEST(AmplificationLimit, ReturnedTokenLiftsLimit) {
  LimitFixture sources;
  const std::uint32_t far = ip("10.0.0.1");
  sources.limit.add_credit(far, 28, sources.now);
  EXPECT_FALSE(sources.limit.make_challenge(far, false, sources.now)) << "nothing was withheld";
  const std::optional<std::string> token = sources.limit.make_challenge(far, true, sources.now);
  ASSERT_TRUE(token);
  EXPECT_FALSE(sources.limit.make_challenge(far, true, sources.now + kSecond / 2)) << "one a second";
  EXPECT_FALSE(sources.limit.verify_token(far, "0123456789abcdef", sources.now));
  EXPECT_FALSE(sources.limit.verify_token(ip("10.0.0.2"), *token, sources.now)) << "it is another address's";
  EXPECT_EQ(sources.count_allowed("10.0.0.1", 1000, 10), 0);
  EXPECT_TRUE(sources.limit.verify_token(far, *token, sources.now + AmplificationLimit::kTokenLifetime));
  sources.now += AmplificationLimit::kTokenLifetime;
  EXPECT_EQ(sources.count_allowed("10.0.0.1", 1000, 10), 10);
  EXPECT_EQ(sources.count_allowed("10.0.0.2", 1000, 10), 0);
  EXPECT_FALSE(sources.limit.make_challenge(far, true, sources.now));
  sources.now += AmplificationLimit::kVerifiedLifetime;
  EXPECT_EQ(sources.count_allowed("10.0.0.1", 1000, 10), 0) << "an address may have another owner by now";
  EXPECT_TRUE(sources.limit.make_challenge(far, false, sources.now)) << "something was withheld";
}

TEST(AmplificationLimit, RejectsExpiredTokens) {
  LimitFixture sources;
  const std::uint32_t far = ip("10.0.0.1");
  const std::optional<std::string> token = sources.limit.make_challenge(far, true, sources.now);
  ASSERT_TRUE(token);
  EXPECT_FALSE(sources.limit.verify_token(far, *token, sources.now + 2 * AmplificationLimit::kTokenLifetime));
}

TEST(AmplificationLimit, ForgedSendersDoNotEvictVerifiedOnes) {
  LimitFixture sources;
  const std::uint32_t far = ip("10.0.0.1");
  ASSERT_TRUE(sources.limit.verify_token(far, *sources.limit.make_challenge(far, true, sources.now), sources.now));
  for (std::uint32_t i = 0; i < 100'000; i++) {
    sources.limit.add_credit(ip("20.0.0.0") + i, 100, sources.now);
    (void)sources.limit.try_consume(ip("20.0.0.0") + i, 1000, sources.now);
  }
  EXPECT_EQ(sources.count_allowed("10.0.0.1", 1000, 10), 10);
}

TEST(AmplificationLimit, TrustsAllowedRanges) {
  LimitFixture sources;
  sources.limit = sources.make(*parse_osc_allow("203.0.113.9,10.1.0.0/16"));
  EXPECT_EQ(sources.count_allowed("203.0.113.9", 1000, 10), 10);
  EXPECT_EQ(sources.count_allowed("10.1.200.3", 1000, 10), 10);
  EXPECT_EQ(sources.count_allowed("203.0.113.10", 1000, 10), 0);
  EXPECT_EQ(sources.count_allowed("10.2.0.1", 1000, 10), 0);
}

TEST(AmplificationLimit, CachesSubnets) {
  LimitFixture sources;
  EXPECT_EQ(sources.count_allowed("10.0.0.7", 100, 1000), 0);
  EXPECT_EQ(sources.subnet_reads, 1);
  sources.connected.push_back({ip("10.0.0.0"), 24});
  sources.now += AmplificationLimit::kSubnetsLifetime;
  EXPECT_EQ(sources.count_allowed("10.0.0.7", 100, 1000), 1000);
  EXPECT_EQ(sources.subnet_reads, 2);
}

// Test vector of the reference implementation: 16 bytes, 00 to 0f, with the key 00 to 0f.
TEST(SipHash, MatchesReference) {
  EXPECT_EQ(sip_hash({0x0706050403020100, 0x0f0e0d0c0b0a0908}, 0x0706050403020100, 0x0f0e0d0c0b0a0908),
            0x3f2acc7f57c29bdbU);
}

TEST(ConnectedSubnets, IncludeLoopback) {
  bool loopback = false;
  for (const Cidr& subnet : connected_subnets()) {
    loopback = loopback || subnet.contains(0x7f000001);
    EXPECT_GT(subnet.bits, 0);
    EXPECT_LE(subnet.bits, subnet.ip.is_v6 ? 128 : 32);
  }
  EXPECT_TRUE(loopback);
}

}  // namespace
}  // namespace limber::osc::test
