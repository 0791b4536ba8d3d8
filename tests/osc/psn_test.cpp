// PosiStageNet: packets become messages of motion capture; damaged ones change counters only.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/log/log.h"
#include "net/osc/psn/psn_input.h"
#include "net/osc/receiver.h"
#include "osc/osc_test_tools.h"
#include "osc/psn_packets.h"
#include "sim/mocap/mocap_list.h"
#include "sim/world/world.h"

namespace limber::osc {
namespace {

using namespace test;

constexpr std::uint32_t kIp = 0xc0a80107;
constexpr double kPi = std::numbers::pi;

std::vector<double> numbers_of(const Message& message) {
  std::vector<double> numbers;
  for (std::size_t i = 1; i < message.args.size(); i++) numbers.push_back(message.args[i].number);
  return numbers;
}

TEST(PsnPacket, HasPlacesTurnsAndNames) {
  const std::string data = psn_data(1234567890123, psn_data_tracker(7, {1, 2, -3}, {0, 0.5F, 0}, 0.25F) +
                                                       psn_chunk(9, psn_chunk(99, "later versions"), true));
  ASSERT_TRUE(is_psn(data));
  const Result<PsnPacket> packet = parse_psn(data);
  ASSERT_TRUE(packet) << packet.error();
  EXPECT_EQ(packet->kind, PsnPacket::Kind::data);
  EXPECT_EQ(packet->timestamp, 1234567890123u);
  ASSERT_EQ(packet->trackers.size(), 2u);
  EXPECT_EQ(packet->trackers[0].id, 7);
  EXPECT_EQ(packet->trackers[0].position, Vec3(1, 2, -3));
  EXPECT_EQ(packet->trackers[0].rotation, Vec3(0, 0.5, 0));
  EXPECT_EQ(packet->trackers[0].validity, 0.25F);
  EXPECT_FALSE(packet->trackers[1].position);
  const std::string info = psn_info(psn_info_tracker(7, std::string_view("hat\0\0", 5)) + psn_info_tracker(65535, ""));
  const Result<PsnPacket> names = parse_psn(info);
  ASSERT_TRUE(names) << names.error();
  EXPECT_EQ(names->kind, PsnPacket::Kind::info);
  ASSERT_EQ(names->trackers.size(), 2u);
  EXPECT_EQ(names->trackers[0].name, "hat");
  EXPECT_EQ(names->trackers[1].id, 65535);
}

TEST(PsnPacket, DamagedOnesAreErrors) {
  const std::string good = psn_data(5, psn_data_tracker(1, {1, 2, 3}, {0, 0, 0}));
  ASSERT_TRUE(parse_psn(good));
  for (std::size_t size = 0; size < good.size(); size++)
    EXPECT_FALSE(parse_psn(std::string_view(good).substr(0, size))) << size;
  const auto error_of = [](const std::string& bytes) { return parse_psn(bytes).error(); };
  EXPECT_EQ(error_of(good + "x"), "the header of a chunk is incomplete");
  EXPECT_EQ(error_of(good + good), "there are bytes after the packet");
  EXPECT_EQ(error_of(psn_chunk(0x6755, psn_chunk(1, psn_data_tracker(1, {1, 2, 3}, {0, 0, 0})))),
            "its header is missing");
  EXPECT_EQ(error_of(psn_chunk(0x6755, psn_header(1, 1))), "it has version 1, expected 2");
  EXPECT_EQ(error_of(psn_data(1, psn_chunk(1, psn_chunk(0, floats({1, 2}))))), "a chunk is shorter than its values");
  EXPECT_EQ(error_of(psn_data(1, psn_chunk(1, psn_chunk(0, floats({1, 2, 3})).substr(0, 12)))),
            "a chunk has 12 bytes, but 8 are left in the packet");
  EXPECT_FALSE(is_psn("/psn"));
  EXPECT_FALSE(is_psn("#bundle"));
  EXPECT_FALSE(is_psn("\x55\x67"));
}

class PsnTranslation : public testing::Test {
 protected:
  std::vector<Message> send(const std::string& bytes, double seconds = 0, std::uint32_t ip = kIp) {
    now_ += static_cast<std::int64_t>(seconds * 1e9);
    Result<std::vector<Message>> messages = input_.translate(bytes, ip, now_);
    EXPECT_TRUE(messages) << messages.error();
    return messages ? *messages : std::vector<Message>();
  }
  PsnInput input_;

 private:
  std::int64_t now_ = 1'000'000'000;
};

TEST_F(PsnTranslation, TurnsBecomeQuaternions) {
  EXPECT_TRUE(send(psn_info(psn_info_tracker(3, "left hand"))).empty());
  const auto turn = static_cast<float>(2 * kPi / 3);
  const std::vector<Message> messages = send(psn_data(1, psn_data_tracker(3, {1, 2, 3}, {0, turn, 0}, 0.5F)));
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].address, "/psn/tracker");
  EXPECT_EQ(messages[0].args[0].text, "left hand");
  const std::vector<double> expected{1, 2, 3, 0.5, 0, std::sqrt(0.75), 0, 0.5};
  const std::vector<double> numbers = numbers_of(messages[0]);
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); i++) EXPECT_NEAR(numbers[i], expected[i], 1e-6) << i;
}

TEST_F(PsnTranslation, TrackersThatAreNotSeenHaveNoPlace) {
  send(psn_info(psn_info_tracker(3, "hat")));
  const std::vector<Message> lost = send(psn_data(1, psn_data_tracker(3, {0, 0, 0}, {0, 0, 0}, 0)));
  ASSERT_EQ(lost.size(), 1u);
  const std::vector<double> numbers = numbers_of(lost[0]);
  for (int i = 0; i < 4; i++) EXPECT_TRUE(std::isnan(numbers[static_cast<std::size_t>(i)])) << i;
  EXPECT_EQ(numbers[7], 0);
  EXPECT_TRUE(send(psn_data(2, psn_chunk(3, "", true))).empty()) << "it has no values at all";
}

TEST_F(PsnTranslation, NamesAreUnique) {
  const auto names_of = [&](std::uint64_t timestamp) {
    std::string names;
    std::string trackers;
    for (unsigned id = 1; id <= 3; id++) trackers += psn_data_tracker(id, {1, 2, 3}, {0, 0, 0});
    for (const Message& message : send(psn_data(timestamp, trackers))) names += message.args[0].text + " ";
    return names;
  };
  const std::string info =
      psn_info(psn_info_tracker(1, "hat_3") + psn_info_tracker(2, "hat") + psn_info_tracker(3, "hat"));
  send(info);
  EXPECT_EQ(names_of(1), "hat_3 hat hat_3_3 ");
  send(info);
  EXPECT_EQ(names_of(2), "hat_3 hat hat_3_3 ") << "they stay";
  send(psn_info(psn_info_tracker(2, "glove") + psn_info_tracker(3, "hat")));
  EXPECT_EQ(names_of(3), "hat_3 glove hat ") << "a name becomes free";
}

TEST_F(PsnTranslation, DataWaitForNamesAtMostTwoSeconds) {
  const std::string data = psn_data(1, psn_data_tracker(4, {1, 2, 3}, {0, 0, 0}));
  EXPECT_TRUE(send(data).empty());
  EXPECT_TRUE(send(data, 1.9).empty());
  ASSERT_EQ(send(data, 0.2).size(), 1u);
  EXPECT_EQ(send(data)[0].args[0].text, "tracker_4");
  // two trackers of one name, and a name that can't be printed
  send(psn_info(psn_info_tracker(4, "hat") + psn_info_tracker(5, "hat") + psn_info_tracker(6, "a\x01")));
  const std::vector<Message> named =
      send(psn_data(2, psn_data_tracker(4, {1, 2, 3}, {0, 0, 0}) + psn_data_tracker(5, {1, 2, 3}, {0, 0, 0}) +
                           psn_data_tracker(6, {1, 2, 3}, {0, 0, 0})));
  ASSERT_EQ(named.size(), 3u);
  EXPECT_EQ(named[0].args[0].text, "hat");
  EXPECT_EQ(named[1].args[0].text, "hat_5");
  EXPECT_EQ(named[2].args[0].text, "tracker_6");
}

TEST_F(PsnTranslation, LatePacketsAreDroppedAndRestartsAreNot) {
  send(psn_info(psn_info_tracker(4, "hat")));
  const auto accepted = [&](std::uint64_t timestamp) {
    return send(psn_data(timestamp, psn_data_tracker(4, {1, 2, 3}, {0, 0, 0}))).size();
  };
  EXPECT_EQ(accepted(10'000'000), 1u);
  EXPECT_EQ(accepted(10'016'000), 1u);
  EXPECT_EQ(accepted(10'000'000), 0u) << "reordered";
  EXPECT_EQ(accepted(10'016'000), 1u) << "the second packet of a frame";
  EXPECT_EQ(accepted(1000), 1u) << "the sender has started again";
  EXPECT_EQ(accepted(17'000), 1u);
}

TEST_F(PsnTranslation, MemoryIsBounded) {
  for (std::uint32_t ip = 1; ip < 100; ip++) {
    send(psn_info(psn_info_tracker(1, "name")), 0.1, ip);
  }
  // the oldest senders are forgotten, so their data wait for names again
  EXPECT_TRUE(send(psn_data(1, psn_data_tracker(1, {1, 2, 3}, {0, 0, 0})), 0, 1).empty());
  EXPECT_EQ(send(psn_data(1, psn_data_tracker(1, {1, 2, 3}, {0, 0, 0})), 0, 99).size(), 1u);
}

// A source "psn" in its default axes: x to the right, y up, z into the depth becomes x, z, y; a left-handed turn about
// "up" turns clockwise seen from above.
TEST(Psn, PacketsMoveTheJointsOfASource) {
  FakeEngine engine;
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  Receiver receiver(engine.link, {}, {}, clock);
  const std::string info = psn_info(psn_info_tracker(3, "hat"));
  const std::string data = psn_data(9, psn_data_tracker(3, {1, 1.75F, 4}, {0, static_cast<float>(kPi / 2), 0}));
  for (const std::string& packet : {info, data}) receiver.process(packet.data(), packet.size(), Endpoint{kIp, 5000});
  engine.collect();
  ASSERT_EQ(engine.commands.size(), 1u);
  EXPECT_EQ(engine.commands[0].origin.ip, kIp);
  EXPECT_EQ(engine.link.counters.received, 1u);

  Store store;
  sim::World world(store);
  sim::MocapSetup setup;
  ASSERT_TRUE(sim::set_mocap_dialect(setup, "psn", "", true).ok());
  setup.axes = {sim::MocapAxes::Up::y, true, 1};
  sim::MocapList& list = world.sensing().mocap();
  const auto source = list.add("stage", std::make_shared<const sim::MocapSetup>(setup));
  ASSERT_TRUE(source) << source.error();
  const std::optional<Result<void>> accepted = list.accept(engine.commands[0].messages.at(0));
  ASSERT_TRUE(accepted && *accepted);
  list.step(1.0 / 60);
  const sim::MocapJoint* const hat = (*source)->find("hat");
  ASSERT_NE(hat, nullptr);
  EXPECT_LT(glm::length(hat->pose().position - Vec3(1, 4, 1.75)), 1e-6);
  const Vec3 turned = hat->pose().rotation * Vec3(0, 1, 0);
  EXPECT_LT(glm::length(turned - Vec3(1, 0, 0)), 1e-6) << turned.x << " " << turned.y << " " << turned.z;
}

TEST(Psn, DamagedPacketsChangeCountersOnly) {
  log_to_stderr(false);
  FakeEngine engine;
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  Receiver receiver(engine.link, {}, {}, clock);
  const std::uint64_t newest = log_newest();
  for (int i = 0; i < 5; i++) {
    const std::string packet = psn_chunk(0x6755, psn_header(1, 1));
    receiver.process(packet.data(), packet.size(), Endpoint{kIp, 5000});
  }
  engine.collect();
  EXPECT_TRUE(engine.commands.empty());
  EXPECT_EQ(engine.link.counters.malformed, 5u);
  const std::vector<LogLine> lines = log_since(newest);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "a packet of PosiStageNet from 192.168.1.7:5000 is ignored: it has version 1, expected 2");
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::osc
