// Packets byte for byte, and the options of the output.
#include "net/lighting/packets.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "lighting/decoder.h"
#include "net/lighting/options.h"

namespace limber::lighting::test {
namespace {

std::string text_of_bytes(std::initializer_list<int> bytes) {
  std::string text;
  for (const int each : bytes) text.push_back(static_cast<char>(each));
  return text;
}

TEST(LightingPackets, ArtDmxHasTheSpecifiedBytes) {
  std::string packet;
  const std::array<std::uint8_t, 3> values{1, 255, 7};
  write_art_dmx(0x1234, 9, values, packet);
  EXPECT_EQ(packet, text_of_bytes({'A', 'r', 't', '-',  'N',  'e', 't', 0, 0x00, 0x50, 0,
                                   14,  9,   0,   0x34, 0x12, 0,   4,   1, 255,  7,    0}))
      << "an odd number of values is padded";
  const std::vector<std::uint8_t> full(512, 200);
  write_art_dmx(32767, 255, full, packet);
  const auto decoded = decode_art_dmx(packet);
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->universe, 32767);
  EXPECT_EQ(decoded->values, std::vector<int>(512, 200));
}

TEST(LightingPackets, SacnDataHasTheSpecifiedBytes) {
  Cid cid;
  for (std::size_t i = 0; i < cid.size(); i++) cid[i] = static_cast<std::uint8_t>(0xa0 + i);
  std::string packet;
  const std::array<std::uint8_t, 2> values{3, 4};
  write_sacn_data({cid, "Show", 0x0102, 150, 0x0304, 77, true}, values, packet);
  std::string expected =
      text_of_bytes({0, 0x10, 0, 0, 'A', 'S', 'C', '-', 'E', '1', '.', '1', '7', 0, 0, 0, 0x70, 0x70, 0, 0, 0, 4});
  for (int i = 0; i < 16; i++) expected.push_back(static_cast<char>(0xa0 + i));
  expected += text_of_bytes({0x70, 0x5a, 0, 0, 0, 2, 'S', 'h', 'o', 'w'}) + std::string(60, '\0');
  expected += text_of_bytes({150, 3, 4, 77, 0x40, 1, 2, 0x70, 0x0d, 2, 0xa1, 0, 0, 0, 1, 0, 3, 0, 3, 4});
  EXPECT_EQ(packet, expected);
  const std::vector<std::uint8_t> full(512, 9);
  write_sacn_data({cid, std::string(100, 'x'), 1, 100, 0, 0, false}, full, packet);
  EXPECT_EQ(packet.size(), 638u);
  const auto decoded = decode_sacn(packet);
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->source, std::string(63, 'x'));
  EXPECT_EQ(decoded->options, 0);
}

TEST(LightingPackets, SacnSyncHasTheSpecifiedBytes) {
  std::string packet;
  write_sacn_sync({}, 0x0305, 200, packet);
  const std::string expected =
      text_of_bytes({0, 0x10, 0, 0, 'A', 'S', 'C', '-', 'E', '1', '.', '1', '7', 0, 0, 0, 0x70, 0x21, 0, 0, 0, 8}) +
      std::string(16, '\0') + text_of_bytes({0x70, 0x0b, 0, 0, 0, 1, 200, 3, 5, 0, 0});
  EXPECT_EQ(packet, expected);
  EXPECT_EQ(sacn_multicast(0x0203), 0xefff0203U) << "239.255.2.3";
}

// "Output Only Send DMX Packet Request" of Enttec's API: label 6, length with the start code, 25 to 513 bytes.
TEST(LightingPackets, EnttecHasAtLeast24Values) {
  std::string packet;
  write_enttec(std::vector<std::uint8_t>{1, 2, 3}, packet);
  EXPECT_EQ(packet, text_of_bytes({0x7e, 6, 25, 0, 0, 1, 2, 3}) + std::string(21, '\0') + text_of_bytes({0xe7}));
  write_enttec(std::vector<std::uint8_t>(512, 9), packet);
  EXPECT_EQ(packet, text_of_bytes({0x7e, 6, 0x01, 0x02, 0}) + std::string(512, '\x09') + text_of_bytes({0xe7}));
}

TEST(LightingOptions, AreParsedAndDescribed) {
  const auto text = [](const char* option) {
    const auto targets = parse_lights_out(option);
    return targets ? (targets->empty() ? "off" : target_text(targets->front())) : targets.error();
  };
  EXPECT_EQ(text("off"), "off");
  EXPECT_EQ(text("sacn"), "sACN multicast, priority 100, at most 44 Hz");
  EXPECT_EQ(text("sacn:10.0.0.7,priority=120,sync=9,rate=30"),
            "sACN 10.0.0.7:5568, priority 120, at most 30 Hz, sync universe 9");
  EXPECT_EQ(text("artnet"), "Art-Net 255.255.255.255:6454, at most 44 Hz");
  EXPECT_EQ(text("artnet:2.0.0.5:7000"), "Art-Net 2.0.0.5:7000, at most 44 Hz");
  EXPECT_EQ(text("enttec:/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0,universe=3,rate=30"),
            "Enttec DMX USB Pro /dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0, universe 3, at most 30 Hz");
  const auto settings = parse_lights_out("sacn,exit=hold,panic=blackout,name=Left desk,interface=10.0.0.2");
  ASSERT_TRUE(settings.ok());
  EXPECT_FALSE(settings->front().dark_at_end);
  EXPECT_TRUE(settings->front().dark_in_panic);
  EXPECT_EQ(settings->front().name, "Left desk");
  EXPECT_EQ(settings->front().interface, 0x0a000002U);
}

TEST(LightingOptions, ErrorsNameTheSettingAndTheFix) {
  const auto fault = [](const char* option) {
    const auto targets = parse_lights_out(option);
    return targets ? "valid" : targets.error().substr(0, targets.error().find("; write"));
  };
  EXPECT_EQ(fault("artnett"), "--lights-out 'artnett': unknown protocol 'artnett'; did you mean 'artnet'?");
  EXPECT_EQ(fault("artnet:desk"), "--lights-out 'artnet:desk': 'desk' is not an IPv4 address");
  EXPECT_EQ(fault("artnet:1.2.3.4:0"), "--lights-out 'artnet:1.2.3.4:0': '0' is not a port");
  EXPECT_EQ(fault("artnet,priority=5"), "--lights-out 'artnet,priority=5': priority is a setting of sacn only");
  EXPECT_EQ(fault("enttec"), "--lights-out 'enttec': the device is missing, such as enttec:/dev/ttyUSB0");
  EXPECT_EQ(fault("enttec:/dev/a,interface=10.0.0.1"),
            "--lights-out 'enttec:/dev/a,interface=10.0.0.1': interface is no setting of enttec");
  EXPECT_EQ(fault("sacn,universe=2"), "--lights-out 'sacn,universe=2': universe is a setting of enttec only");
  EXPECT_EQ(fault("enttec:/dev/a,universe=0"),
            "--lights-out 'enttec:/dev/a,universe=0': universe must be a universe from 1 to 63999, got '0'");
  EXPECT_EQ(fault("sacn,priority=201"),
            "--lights-out 'sacn,priority=201': priority must be a whole number from 0 to 200, got '201'");
  EXPECT_EQ(fault("sacn,rate=0"), "--lights-out 'sacn,rate=0': rate must be a number from 1 to 1000, got '0'");
  EXPECT_EQ(fault("sacn,exit=off"), "--lights-out 'sacn,exit=off': exit must be blackout or hold, got 'off'");
  EXPECT_EQ(fault("sacn,prio=3"),
            "--lights-out 'sacn,prio=3': unknown setting 'prio'; there are: rate, priority, sync, "
            "interface, name, universe, exit, panic");
}

}  // namespace
}  // namespace limber::lighting::test
