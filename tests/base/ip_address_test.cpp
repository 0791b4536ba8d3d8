// Addresses: text, kinds, splitting of host and port.
#include "base/system/net/ip_address.h"

#include <gtest/gtest.h>

#include "base/message.h"
#include "base/system/net/socket_address.h"

namespace limber::system {
namespace {

TEST(IpAddress, ParsesAndFormats) {
  for (const char* text : {"127.0.0.1", "0.0.0.0", "255.255.255.255", "::", "::1", "fe80::1",
                           "2001:db8::8:800:200c:417a", "ff02::fb", "fd00:1:2:3:4:5:6:7"}) {
    const std::optional<IpAddress> ip = parse_ip(text);
    ASSERT_TRUE(ip) << text;
    EXPECT_EQ(ip_text(*ip), text);
    EXPECT_EQ(SocketAddress(Endpoint{*ip, 9003}).endpoint(), (Endpoint{*ip, 9003})) << text;
    EXPECT_TRUE(is_ip_address(text)) << text;
  }
  for (const char* text :
       {"", ":", "1", "127.0.0", "127.0.0.256", "::g", "[::1]", "::1 ", "localhost", "1:2:3:4:5:6:7:8:9"})
    EXPECT_FALSE(parse_ip(text) || is_ip_address(text)) << text;
  EXPECT_EQ(parse_ip("::ffff:192.168.1.7"), IpAddress(0xc0a80107U)) << "an IPv4-mapped address is IPv4";
  EXPECT_NE(parse_ip("::"), parse_ip("0.0.0.0"));
}

TEST(IpAddress, HasKinds) {
  const auto ip = [](const char* text) { return parse_ip(text).value(); };
  for (const char* text : {"224.0.0.1", "239.255.255.255", "ff02::1", "ff0e::1"})
    EXPECT_TRUE(ip(text).is_multicast()) << text;
  for (const char* text : {"223.0.0.1", "240.0.0.1", "fe80::1", "::1"}) EXPECT_FALSE(ip(text).is_multicast()) << text;
  for (const char* text : {"127.0.0.1", "127.9.9.9", "::1"}) EXPECT_TRUE(ip(text).is_loopback()) << text;
  for (const char* text : {"128.0.0.1", "::2", "::7f00:1"}) EXPECT_FALSE(ip(text).is_loopback()) << text;
  for (const char* text : {"fe80::1", "febf::1", "ff02::1", "ff01::1"}) EXPECT_TRUE(ip(text).is_link_local()) << text;
  for (const char* text : {"fec0::1", "ff05::1", "169.254.0.1", "::1"}) EXPECT_FALSE(ip(text).is_link_local()) << text;
}

TEST(IpAddress, HasAZone) {
  const std::optional<IpAddress> loopback = parse_ip("fe80::1%lo");
  if (loopback) {
    EXPECT_NE(loopback->zone, 0U);
    EXPECT_EQ(ip_text(*loopback), "fe80::1%lo");
    EXPECT_EQ(parse_ip("fe80::1%" + std::to_string(loopback->zone)), loopback);
    EXPECT_EQ(SocketAddress(Endpoint{*loopback, 1}).endpoint().ip, *loopback);
  }
  EXPECT_FALSE(parse_ip("fe80::1%no-such-interface"));
  EXPECT_TRUE(is_ip_address("fe80::1%no-such-interface"));
  EXPECT_FALSE(is_ip_address("2001:db8::1%lo")) << "valid on every network";
  EXPECT_EQ(ip_text(IpAddress(0xfe80ULL << 48U, 1, 4000000)), "fe80::1%4000000") << "the interface is gone";
  EXPECT_EQ(missing_zone("ff02::1"), "ff02::1 is valid on one network only; add its interface, such as [ff02::1%eth0]");
  EXPECT_EQ(missing_zone("::1"), "");
  EXPECT_EQ(resolve("fe80::1%no-such-interface", 1).error(), "there is no network interface 'no-such-interface'");
}

TEST(IpAddress, HostsHaveNoBlanks) {
  for (const char* text : {"stage", "a-b.example", "10.0.0.1", "fe80::1%lo", "bühne.example"})
    EXPECT_TRUE(is_host_text(text)) << text;
  for (const char* text : {"", "two words", "new\nline", "tab\t", "\x1b[2J", "\xff"})
    EXPECT_FALSE(is_host_text(text)) << text;
}

TEST(IpAddress, SplitsHostAndPort) {
  const auto parts = [](std::string_view text) {
    const HostPort p = split_host_port(text);
    return std::string(p.host) + "|" + std::string(p.port) + (p.bracketed ? "|b" : "");
  };
  EXPECT_EQ(parts("9003"), "|9003");
  EXPECT_EQ(parts("localhost:9003"), "localhost|9003");
  EXPECT_EQ(parts("[::1]:9003"), "::1|9003|b");
  EXPECT_EQ(parts("[::1]"), "|[::1]");
  EXPECT_EQ(parts("[::1]x:9003"), "[::1]x|9003");
  EXPECT_EQ(parts("::1"), ":|1");
  EXPECT_EQ(parts(""), "|");
  EXPECT_EQ(parts("[]:1"), "|1|b");
  EXPECT_EQ(host_port_text("::1", 9), "[::1]:9");
  EXPECT_EQ(host_port_text("pi.local", 9), "pi.local:9");
  EXPECT_EQ(endpoint_text({IpAddress(0, 1), 9003}), "[::1]:9003");
  EXPECT_EQ(sender_text({CommandSource::osc, IpAddress(0, 1), 9003}), "[::1]:9003");
}

}  // namespace
}  // namespace limber::system
