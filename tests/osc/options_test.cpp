// OSC command line options: values, errors with their corrections, precedence.
#include "net/osc/options.h"

#include <gtest/gtest.h>

namespace limber::osc {
namespace {

TEST(OscIn, ParsesValues) {
  EXPECT_EQ(*parse_osc_in("9100"), (std::vector<ListenAddress>{{"127.0.0.1", 9100}}));
  EXPECT_EQ(*parse_osc_in("0.0.0.0:9003"), (std::vector<ListenAddress>{{"0.0.0.0", 9003}}));
  EXPECT_EQ(*parse_osc_in("9100,0.0.0.0:0"), (std::vector<ListenAddress>{{"127.0.0.1", 9100}, {"0.0.0.0", 0}}));
  EXPECT_TRUE(parse_osc_in("off")->empty());
}

TEST(OscIn, RejectsWithCorrection) {
  for (const char* text : {"", ":", "port", "127.0.0.1", "127.0.0.1:", ":9003", "65536", "-1", "9003 ", "9003,"}) {
    const auto r = parse_osc_in(text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_NE(r.error().find("write --osc-in [ADDR:]PORT"), std::string::npos) << r.error();
  }
  EXPECT_EQ(parse_osc_in("nine").error(),
            "--osc-in 'nine': no port in 'nine'; write --osc-in [ADDR:]PORT, such as 9003 or 0.0.0.0:9003, or off");
}

TEST(OscIn, ParsesIPv6) {
  EXPECT_EQ(*parse_osc_in("[::]:9003"), (std::vector<ListenAddress>{{"::", 9003}}));
  EXPECT_EQ(*parse_osc_in("9003,[fe80::1%eth0]:9004,[ff05::7]:9005"),
            (std::vector<ListenAddress>{{"127.0.0.1", 9003}, {"fe80::1%eth0", 9004}, {"ff05::7", 9005}}));
  EXPECT_EQ(*parse_listen("--osc-tcp", "[::1]:0"), (std::vector<ListenAddress>{{"::1", 0}}));
}

TEST(OscIn, ReportsMulticastAndIPv6) {
  for (const char* text : {"224.0.0.1:9003", "239.255.0.1:9003", "9003,239.1.2.3:9004", "[ff02::1%eth0]:9"}) {
    EXPECT_TRUE(parse_osc_in(text).ok()) << text;
    const auto r = parse_listen("--osc-tcp", text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_NE(r.error().find("a multicast group is for --osc-in only"), std::string::npos) << r.error();
  }
  const std::pair<const char*, const char*> cases[] = {
      {"::1", "an IPv6 address is written in brackets, such as [::1]:9003"},
      {"fe80::1:9003", "an IPv6 address is written in brackets"},
      {"::", "an IPv6 address is written in brackets"},
      {"[::1]", "no port in '[::1]'"},
      {"[::1]:", "no port in '[::1]:'"},
      {"[::1]:65536", "no port in"},
      {"[localhost]:9003", "there must be an IPv6 address in brackets"},
      {"[]:9003", "there must be an IPv6 address in brackets"},
      {"[::1%lo]:9003", "there must be an IPv6 address in brackets"},
      {"[fe80::1]:9003", "fe80::1 is valid on one network only; add its interface, such as [fe80::1%eth0]"},
      {"[ff02::1]:9003", "ff02::1 is valid on one network only"},
  };
  for (const auto& [text, expected] : cases) {
    const auto r = parse_osc_in(text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_NE(r.error().find(expected), std::string::npos) << r.error();
  }
  EXPECT_TRUE(parse_osc_in("223.255.255.255:9003").ok());
  EXPECT_TRUE(parse_osc_in("240.0.0.1:9003").ok()) << "the system reports the error";
  EXPECT_TRUE(parse_osc_in("localhost:9003").ok());
}

TEST(OscOut, ParsesValues) {
  EXPECT_EQ(*parse_osc_out("10.0.0.5:9005"), std::vector<StreamTarget>{StreamTarget{.host = "10.0.0.5"}});
  const auto all = parse_osc_out("pi.local:7000,rate=30.5,bundle=8192,streams=pos+relpos,bodies=arm{1,2}*,errors=on");
  ASSERT_TRUE(all.ok());
  StreamTarget expected{.host = "pi.local", .port = 7000, .rate = 30.5};
  expected.bundle = 8192;
  expected.rot = expected.relrot = false;
  expected.relpos = true;
  expected.bodies = "arm{1,2}*";
  expected.errors = true;
  EXPECT_EQ(all->at(0), expected);
  const auto none = parse_osc_out("h:1,streams=none,bundle=off,errors=off");
  ASSERT_TRUE(none.ok());
  EXPECT_FALSE(none->at(0).pos || none->at(0).rot || none->at(0).relrot || none->at(0).relpos);
  EXPECT_EQ(none->at(0).bundle, 0);
  EXPECT_TRUE(parse_osc_out("off")->empty());
}

TEST(OscOut, ParsesIPv6) {
  EXPECT_EQ(*parse_osc_out("[fd00::7]:9005"), std::vector<StreamTarget>{StreamTarget{.host = "fd00::7"}});
  const auto all = parse_osc_out("[ff02::1%eth0]:7000,rate=30");
  ASSERT_TRUE(all.ok()) << all.error();
  EXPECT_EQ(target_text(all->at(0)), "[ff02::1%eth0]:7000 (pos+rot+relrot at 30 Hz)");
}

TEST(OscOut, RejectsWithCorrection) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "is not HOST:PORT"},
      {"9005", "is not HOST:PORT"},
      {":9005", "is not HOST:PORT"},
      {"h:0", "is not HOST:PORT"},
      {"h:9005,rate=0", "rate must be 0.1 to 1000 frames per second"},
      {"h:9005,rate=nan", "rate must be 0.1 to 1000 frames per second"},
      {"h:9005,rate", "rate must be 0.1 to 1000 frames per second"},
      {"h:9005,bundle=1500", "bundle must be off, 1472, 8192 or 65504 bytes"},
      {"h:9005,streams=pos+size", "streams must be pos, rot, relrot, relpos joined by +, or none"},
      {"h:9005,streams=", "streams must be pos, rot, relrot, relpos joined by +, or none"},
      {"h:9005,bodies=", "bodies must be a name or a pattern, such as arm*"},
      {"h:9005,errors=maybe", "errors must be on or off"},
      {"h:9005,rates=1", "unknown setting 'rates'; did you mean 'rate'?"},
      {"h:9005,", "unknown setting ''"},
      {"[::1]", "is not HOST:PORT"},
      {"::1:9005", "an IPv6 address is written in brackets"},
      {"[fe80::1]:9005", "add its interface"},
  };
  for (const auto& [text, expected] : cases) {
    const auto r = parse_osc_out(text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_NE(r.error().find(expected), std::string::npos) << r.error();
    EXPECT_NE(r.error().find("write --osc-out HOST:PORT"), std::string::npos) << r.error();
  }
}

TEST(OscAllow, ParsesRanges) {
  const auto list = parse_osc_allow("192.168.1.0/24,10.0.0.1,0.0.0.0/0");
  ASSERT_TRUE(list.ok());
  const std::vector<Cidr>& c = *list;
  ASSERT_EQ(c.size(), 3u);
  EXPECT_TRUE(c[0].contains(0xc0a80100u));
  EXPECT_TRUE(c[0].contains(0xc0a801ffu));
  EXPECT_FALSE(c[0].contains(0xc0a80200u));
  EXPECT_FALSE(c[0].contains(0xc0a800ffu));
  EXPECT_TRUE(c[1].contains(0x0a000001u));
  EXPECT_FALSE(c[1].contains(0x0a000000u));
  EXPECT_TRUE(c[2].contains(0xffffffffu));
  // bits beyond the mask are ignored
  EXPECT_TRUE(parse_osc_allow("192.168.1.77/24")->at(0).contains(0xc0a80101u));
}

TEST(OscAllow, ParsesIPv6) {
  const auto list = parse_osc_allow("fd00::/8,2001:db8:0:1::/64,::1,::/0");
  ASSERT_TRUE(list.ok()) << list.error();
  const std::vector<Cidr>& c = *list;
  const auto ip = [](const char* text) { return parse_ip(text).value(); };
  EXPECT_TRUE(c[0].contains(ip("fdff::1")));
  EXPECT_FALSE(c[0].contains(ip("fc00::1")));
  EXPECT_TRUE(c[1].contains(ip("2001:db8:0:1:ffff::1")));
  EXPECT_FALSE(c[1].contains(ip("2001:db8:0:2::1")));
  EXPECT_TRUE(c[2].contains(ip("::1")));
  EXPECT_FALSE(c[2].contains(ip("::2")));
  EXPECT_TRUE(c[3].contains(ip("ff02::1")));
  EXPECT_FALSE(c[3].contains(ip("10.0.0.1"))) << "IPv4 has ranges of its own";
  EXPECT_FALSE(parse_osc_allow("0.0.0.0/0")->at(0).contains(ip("::1")));
  EXPECT_TRUE(parse_osc_allow("[fd00::7]/128")->at(0).contains(ip("fd00::7")));
  // a link-local range of one network, and one of all networks
  const IpAddress on_two(0xfe80ULL << 48U, 1, 2);
  EXPECT_TRUE((Cidr{IpAddress(0xfe80ULL << 48U, 9, 2), 64}.contains(on_two)));
  EXPECT_FALSE((Cidr{IpAddress(0xfe80ULL << 48U, 9, 3), 64}.contains(on_two)));
  EXPECT_TRUE(parse_osc_allow("fe80::/10")->at(0).contains(on_two));
}

TEST(OscAllow, RejectsWithCorrection) {
  for (const char* text : {"", "localhost", "10.0.0", "10.0.0.1/33", "10.0.0.1/", "10.0.0.1/x", "10.0.0.256",
                           "1.2.3.4,", "::1/129", "::g"}) {
    const auto r = parse_osc_allow(text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_NE(r.error().find("write --osc-allow 192.168.1.0/24"), std::string::npos) << r.error();
  }
}

TEST(OscConfigs, CommandLineOverridesSceneOverridesDefault) {
  const OscConfig defaults = {{{"127.0.0.1", 9003}}, {StreamTarget{.host = "127.0.0.1", .port = 9005}}};
  EXPECT_EQ(effective_config({}, nullptr), defaults);
  const OscConfig silent;
  EXPECT_EQ(effective_config({}, &silent), defaults);
  // each list is resolved separately
  const OscConfig scene = {{{"127.0.0.1", 7001}, {"127.0.0.1", 7002}}, {}};
  EXPECT_EQ(effective_config({}, &scene), (OscConfig{scene.listen, defaults.targets}));
  OscOptions line;
  line.in = *parse_osc_in("off");
  line.out = *parse_osc_out("h:1");
  const OscConfig both = effective_config(line, &scene);
  EXPECT_TRUE(both.listen.empty());
  EXPECT_EQ(both.targets, *line.out);
}

TEST(OscConfigs, TrackersAreAddedUnlessInputIsOff) {
  OscConfig scene;
  scene.trackers = {{"236.10.10.10", 56565, true}, {"236.10.10.10", 56565, true}};
  const std::vector<ListenAddress> added{{"127.0.0.1", 9003}, {"236.10.10.10", 56565, true}};
  EXPECT_EQ(effective_config({}, &scene).listen, added);
  OscOptions line;
  line.in = *parse_osc_in("9003");
  EXPECT_EQ(effective_config(line, &scene).listen, added);
  line.in = *parse_osc_in("off");
  EXPECT_TRUE(effective_config(line, &scene).listen.empty());
}

TEST(OscConfigs, SharesEveryInput) {
  OscOptions line;
  line.shared = true;
  for (const ListenAddress& address : effective_config(line, nullptr).listen) EXPECT_TRUE(address.shared);
  EXPECT_FALSE(effective_config({}, nullptr).listen.at(0).shared);
}

TEST(OscConfigs, FormatsTarget) {
  EXPECT_EQ(target_text({}), "127.0.0.1:9005 (pos+rot+relrot at 60 Hz)");
  EXPECT_EQ(target_text(parse_osc_out("h:7,rate=30,bundle=off,streams=none,bodies=a*,errors=on")->at(0)),
            "h:7 (no streams at 30 Hz, bodies a*, no bundles, errors)");
}

}  // namespace
}  // namespace limber::osc
