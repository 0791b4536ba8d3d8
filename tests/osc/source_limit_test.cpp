// Which senders are served in full, and how much others get: addresses are data here.
#include "osc/source_limit.h"

#include <gtest/gtest.h>

#include "base/system/socket.h"

namespace limber::osc_test {
namespace {

std::uint32_t ip(const char* text) { return system::parse_ipv4(text).value(); }

constexpr std::int64_t kSecond = 1'000'000'000;

struct Sources {
  std::vector<Cidr> connected = {{0x7f000000, 8}, {0xc0a80105, 24}};  // loopback, 192.168.1.5/24
  int asked = 0;
  std::int64_t now = 5 * kSecond;
  SourceLimit limit = make({});

  SourceLimit make(std::vector<Cidr> allow) {
    return SourceLimit(std::move(allow),
                       [this] {
                         asked++;
                         return connected;
                       },
                       {1, 2});
  }
  // how many of those datagrams may be sent
  int sent(const char* to, std::size_t bytes, int count) {
    int sent = 0;
    for (int i = 0; i < count; i++) sent += limit.allows(ip(to), bytes, now) ? 1 : 0;
    return sent;
  }
};

TEST(SourceLimit, ThisMachineAndConnectedSubnetsAreServedInFull) {
  Sources sources;
  for (const char* near : {"127.0.0.1", "127.9.9.9", "192.168.1.5", "192.168.1.77", "192.168.1.255"}) {
    EXPECT_EQ(sources.sent(near, 1'000'000, 100), 100) << near;
    EXPECT_FALSE(sources.limit.token(ip(near), true, sources.now)) << near;
  }
  EXPECT_EQ(sources.limit.withheld(), 0u);
}

TEST(SourceLimit, OthersGetThreeBytesForEachOfTheirs) {
  for (const char* far : {"192.168.2.5", "10.0.0.1", "203.0.113.9", "8.8.8.8"}) {
    Sources sources;
    EXPECT_EQ(sources.sent(far, 1, 10), 0) << far << " has sent nothing";
    std::size_t received = 0;
    int sent = 0;
    for (const std::size_t bytes : {20, 28, 1, 200}) {
      sources.limit.received(ip(far), bytes, sources.now);
      received += bytes;
      sent += sources.sent(far, 8, 1000);
      EXPECT_LE(sent * 8, static_cast<int>(3 * received));
      EXPECT_GT(sent * 8, static_cast<int>(3 * received) - 8);
    }
    EXPECT_GT(sources.limit.withheld(), 0u);
  }
}

TEST(SourceLimit, CreditIsBounded) {
  Sources sources;
  for (int i = 0; i < 1000; i++) sources.limit.received(ip("10.0.0.1"), 60'000, sources.now);
  EXPECT_EQ(sources.sent("10.0.0.1", 1024, 1000), SourceLimit::kMostCredit / 1024);
}

TEST(SourceLimit, WhoReturnsTheTokenIsServedInFull) {
  Sources sources;
  const std::uint32_t far = ip("10.0.0.1");
  sources.limit.received(far, 28, sources.now);
  EXPECT_FALSE(sources.limit.token(far, false, sources.now)) << "nothing was withheld";
  const std::optional<std::string> token = sources.limit.token(far, true, sources.now);
  ASSERT_TRUE(token);
  EXPECT_FALSE(sources.limit.token(far, true, sources.now + kSecond / 2)) << "one a second";
  EXPECT_FALSE(sources.limit.accept(far, "0123456789abcdef", sources.now));
  EXPECT_FALSE(sources.limit.accept(ip("10.0.0.2"), *token, sources.now)) << "it is another address's";
  EXPECT_EQ(sources.sent("10.0.0.1", 1000, 10), 0);
  EXPECT_TRUE(sources.limit.accept(far, *token, sources.now + SourceLimit::kTokenLasts));
  sources.now += SourceLimit::kTokenLasts;
  EXPECT_EQ(sources.sent("10.0.0.1", 1000, 10), 10);
  EXPECT_EQ(sources.sent("10.0.0.2", 1000, 10), 0);
  EXPECT_FALSE(sources.limit.token(far, true, sources.now));
  sources.now += SourceLimit::kVerifiedLasts;
  EXPECT_EQ(sources.sent("10.0.0.1", 1000, 10), 0) << "an address may have another owner by now";
  EXPECT_TRUE(sources.limit.token(far, false, sources.now)) << "something was withheld";
}

TEST(SourceLimit, TokensOfOldAreWorthless) {
  Sources sources;
  const std::uint32_t far = ip("10.0.0.1");
  const std::optional<std::string> token = sources.limit.token(far, true, sources.now);
  ASSERT_TRUE(token);
  EXPECT_FALSE(sources.limit.accept(far, *token, sources.now + 2 * SourceLimit::kTokenLasts));
}

TEST(SourceLimit, ForgedSendersDoNotPushOutWhoHasReturnedTheToken) {
  Sources sources;
  const std::uint32_t far = ip("10.0.0.1");
  ASSERT_TRUE(sources.limit.accept(far, *sources.limit.token(far, true, sources.now), sources.now));
  for (std::uint32_t i = 0; i < 100'000; i++) {
    sources.limit.received(ip("20.0.0.0") + i, 100, sources.now);
    (void)sources.limit.allows(ip("20.0.0.0") + i, 1000, sources.now);
  }
  EXPECT_EQ(sources.sent("10.0.0.1", 1000, 10), 10);
}

TEST(SourceLimit, AllowedRangesAreServedInFull) {
  Sources sources;
  sources.limit = sources.make(*parse_osc_allow("203.0.113.9,10.1.0.0/16"));
  EXPECT_EQ(sources.sent("203.0.113.9", 1000, 10), 10);
  EXPECT_EQ(sources.sent("10.1.200.3", 1000, 10), 10);
  EXPECT_EQ(sources.sent("203.0.113.10", 1000, 10), 0);
  EXPECT_EQ(sources.sent("10.2.0.1", 1000, 10), 0);
}

TEST(SourceLimit, NetworksThatComeLaterAreSeenSoonAndNotAskedForAllTheTime) {
  Sources sources;
  EXPECT_EQ(sources.sent("10.0.0.7", 100, 1000), 0);
  EXPECT_EQ(sources.asked, 1);
  sources.connected.push_back({ip("10.0.0.0"), 24});
  sources.now += SourceLimit::kSubnetsLast;
  EXPECT_EQ(sources.sent("10.0.0.7", 100, 1000), 1000);
  EXPECT_EQ(sources.asked, 2);
}

// the reference's vector of 16 bytes, 00 to 0f, with the key 00 to 0f
TEST(SipHash, AgreesWithTheReference) {
  EXPECT_EQ(sip_hash({0x0706050403020100, 0x0f0e0d0c0b0a0908}, 0x0706050403020100, 0x0f0e0d0c0b0a0908),
            0x3f2acc7f57c29bdbU);
}

TEST(ConnectedSubnets, LoopbackIsOne) {
  bool loopback = false;
  for (const Cidr& subnet : connected_subnets()) {
    loopback = loopback || subnet.holds(0x7f000001);
    EXPECT_GT(subnet.bits, 0);
    EXPECT_LE(subnet.bits, 32);
  }
  EXPECT_TRUE(loopback);
}

}  // namespace
}  // namespace limber::osc_test
