// When packets are sent, and whether they may be.
#include "net/lighting/stream.h"

#include <gtest/gtest.h>

#include <vector>

#include "lighting/decoder.h"

namespace limber::lighting::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

sim::DmxFrame frame_of(std::uint8_t first, std::vector<std::uint16_t> universes = {1}) {
  sim::DmxFrame frame;
  for (const std::uint16_t number : universes) {
    sim::DmxUniverse& universe = frame.universes.emplace_back();
    universe.number = number;
    universe.length = 4;
    universe.values = {first, 2, 3, 4};
    universe.dark = {0, 2, 3, 4};
  }
  return frame;
}

struct Receiver {
  struct Packet {
    std::int64_t time;
    system::Endpoint to;
    std::string bytes;
  };
  explicit Receiver(const char* options)
      : stream(parse_lights_out(options).value().front(), Cid{1},
               [this](const system::Endpoint& to, const std::string& bytes) {
                 packets.push_back({now, to, bytes});
               }) {}
  void run(const sim::DmxFrame& frame, std::int64_t until, std::int64_t step = kMs) {
    for (; now < until; now += step) (void)stream.update(frame, now);
  }
  std::int64_t now = 0;
  std::vector<Packet> packets;
  LightStream stream;
};

TEST(LightStream, SendsChangesAtItsRateAndRestEverySecond) {
  Receiver r("artnet:127.0.0.1,rate=40");
  for (int i = 0; i < 1000; i++) r.run(frame_of(static_cast<std::uint8_t>(i)), r.now + kMs);
  EXPECT_EQ(r.packets.size(), 40u) << "values that change every millisecond, for one second";
  for (std::size_t i = 1; i < r.packets.size(); i++) EXPECT_GE(r.packets[i].time - r.packets[i - 1].time, 25 * kMs);
  const auto last = decode_art_dmx(r.packets.back().bytes);
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->sequence, 40);
  r.packets.clear();
  r.run(frame_of(99), 11'000 * kMs);
  EXPECT_EQ(decode_art_dmx(r.packets.front().bytes)->values.front(), 99);
  ASSERT_GE(r.packets.size(), 13u);
  EXPECT_LE(r.packets.size(), 16u) << "4 at the rate, then one every 0.9 s";
  for (std::size_t i = 1; i < r.packets.size(); i++) EXPECT_LE(r.packets[i].time - r.packets[i - 1].time, 1000 * kMs);
}

TEST(LightStream, ReturnsTheTimeOfTheNextPacket) {
  Receiver r("artnet:127.0.0.1,rate=40");
  EXPECT_EQ(r.stream.update(frame_of(1), 0), 25 * kMs);
  EXPECT_EQ(r.stream.update(frame_of(2), 10 * kMs), 25 * kMs) << "too early";
  for (const int i : {1, 2, 3, 4}) (void)r.stream.update(frame_of(2), i * 25 * kMs);
  EXPECT_EQ(r.packets.size(), 5u);
  EXPECT_EQ(r.stream.update(frame_of(2), 101 * kMs), 100 * kMs + LightStream::kKeepAlive);
}

TEST(LightStream, SequenceNumbersAreThoseOfTheProtocol) {
  Receiver art("artnet:127.0.0.1,rate=1000");
  Receiver sacn("sacn:127.0.0.1,rate=1000");
  for (int i = 0; i < 300; i++) {
    art.run(frame_of(static_cast<std::uint8_t>(i)), art.now + kMs);
    sacn.run(frame_of(static_cast<std::uint8_t>(i)), sacn.now + kMs);
  }
  ASSERT_EQ(art.packets.size(), 300u);
  ASSERT_EQ(sacn.packets.size(), 300u);
  for (int i = 0; i < 300; i++) {
    EXPECT_EQ(decode_art_dmx(art.packets[static_cast<std::size_t>(i)].bytes)->sequence, i % 255 + 1) << "never 0";
    EXPECT_EQ(decode_sacn(sacn.packets[static_cast<std::size_t>(i)].bytes)->sequence, i % 256);
  }
}

TEST(LightStream, SacnMulticastsEachUniverseAndSynchronizes) {
  Receiver r("sacn,sync=7,priority=130");
  r.run(frame_of(1, {1, 258}), 1);
  ASSERT_EQ(r.packets.size(), 3u);
  EXPECT_EQ(system::endpoint_text(r.packets[0].to), "239.255.0.1:5568");
  EXPECT_EQ(system::endpoint_text(r.packets[1].to), "239.255.1.2:5568");
  EXPECT_EQ(system::endpoint_text(r.packets[2].to), "239.255.0.7:5568");
  const auto data = decode_sacn(r.packets[1].bytes);
  const auto sync = decode_sacn(r.packets[2].bytes);
  ASSERT_TRUE(data && sync);
  EXPECT_EQ(data->universe, 258);
  EXPECT_EQ(data->priority, 130);
  EXPECT_EQ(data->sync_universe, 7);
  EXPECT_EQ(data->values, padded({1, 2, 3, 4}));
  EXPECT_TRUE(sync->sync);
  EXPECT_EQ(sync->sync_universe, 7);
}

TEST(LightStream, EndsDarkOrHoldsAsTheOptionsSay) {
  Receiver dark("sacn:127.0.0.1");
  dark.run(frame_of(200), 1);
  dark.stream.end();
  ASSERT_EQ(dark.packets.size(), 5u) << "the values, dark ones, and three that end the universe";
  for (std::size_t i = 1; i < 5; i++) {
    const auto packet = decode_sacn(dark.packets[i].bytes);
    ASSERT_TRUE(packet.has_value());
    EXPECT_EQ(packet->values, padded({0, 2, 3, 4})) << "the head stays where it is";
    EXPECT_EQ(packet->options, i == 1 ? 0 : 0x40);
    EXPECT_EQ(packet->sequence, static_cast<int>(i));
  }
  dark.run(frame_of(200), dark.now + 1);
  EXPECT_EQ(decode_sacn(dark.packets.back().bytes)->sequence, 5) << "continues, so that receivers do not discard it";
  Receiver hold("sacn:127.0.0.1,exit=hold");
  hold.run(frame_of(200), 1);
  hold.stream.end();
  EXPECT_EQ(hold.packets.size(), 1u);
}

TEST(LightStream, AUniverseWithoutFixturesEndsDark) {
  Receiver r("artnet:127.0.0.1");
  r.run(frame_of(200, {1, 2}), 1);
  (void)r.stream.update(frame_of(200, {1}), 30 * kMs);
  ASSERT_EQ(r.packets.size(), 4u);
  const auto last = decode_art_dmx(r.packets.back().bytes);
  EXPECT_EQ(last->universe, 2);
  EXPECT_EQ(last->values, (std::vector<int>{0, 2, 3, 4}));
}

TEST(LightStream, PanicHoldsUnlessBlackoutIsSet) {
  sim::DmxFrame frame = frame_of(200);
  frame.panicked = true;
  Receiver hold("artnet:127.0.0.1");
  hold.run(frame, 1);
  EXPECT_EQ(decode_art_dmx(hold.packets.front().bytes)->values.front(), 200);
  Receiver dark("artnet:127.0.0.1,panic=blackout");
  dark.run(frame, 1);
  EXPECT_EQ(decode_art_dmx(dark.packets.front().bytes)->values.front(), 0);
}

TEST(ArmLatch, NeedsAnArmingWhileTheShowPlays) {
  ArmLatch latch(false, true);
  EXPECT_FALSE(latch.update(true, false, 0)) << "armed by a file";
  EXPECT_FALSE(latch.update(true, false, 1));
  EXPECT_FALSE(latch.update(false, false, 2));
  EXPECT_TRUE(latch.update(true, false, 3));
  EXPECT_TRUE(latch.update(true, false, 4));
  EXPECT_FALSE(latch.update(false, false, 5));
}

TEST(ArmLatch, RewindsAndResetsNeverStartLights) {
  ArmLatch latch(false, true);
  (void)latch.update(false, false, 0);
  EXPECT_TRUE(latch.update(true, false, 100));
  EXPECT_TRUE(latch.update(true, false, 50)) << "a rewind to an armed moment goes on";
  EXPECT_FALSE(latch.update(false, false, 60));
  EXPECT_FALSE(latch.update(true, false, 40)) << "a rewind from a disarmed moment to an armed one";
  EXPECT_FALSE(latch.update(true, false, 41));
}

TEST(ArmLatch, TakesSendOnlyWithTheOption) {
  ArmLatch without(false, true);
  (void)without.update(false, false, 0);
  EXPECT_TRUE(without.update(true, false, 1));
  EXPECT_FALSE(without.update(true, true, 2)) << "a take starts in the show";
  EXPECT_FALSE(without.update(true, false, 3)) << "and ends";
  EXPECT_FALSE(without.update(true, false, 4));
  EXPECT_FALSE(without.update(false, false, 5));
  EXPECT_TRUE(without.update(true, false, 6));
  ArmLatch with(true, true);
  EXPECT_TRUE(with.update(false, true, 0)) << "a replay with --lights";
  ArmLatch fast(false, false);
  (void)fast.update(false, false, 0);
  EXPECT_FALSE(fast.update(true, false, 1));
  ArmLatch fast_with(true, false);
  EXPECT_TRUE(fast_with.update(true, false, 1));
}

}  // namespace
}  // namespace limber::lighting::test
