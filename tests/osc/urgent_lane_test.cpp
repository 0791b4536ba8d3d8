// Urgent requests overtake the datagrams before them, are executed once, and are accepted only from allowed senders.
#include <gtest/gtest.h>

#include "net/osc/receiver.h"
#include "osc/bad_packets.h"
#include "osc/osc_test_tools.h"

namespace limber::osc {
namespace {

using namespace test;

struct UrgentFixture {
  explicit UrgentFixture(std::vector<Cidr> allow = {}) : receiver(link, std::move(allow), {}, clock) {}

  std::vector<engine::UrgentRequest> lane() {
    std::vector<engine::UrgentRequest> requests;
    link.command_queue.drain_urgent(requests);
    return requests;
  }
  std::vector<engine::Command> commands() {
    std::vector<engine::Command> list;
    link.command_queue.drain(list);
    return list;
  }

  engine::EngineLink link;
  ManualClock manual_clock;
  NetClock clock = manual_clock.clock();
  Receiver receiver;
};

std::string panic() { return Bytes().text("/transport/panic").text(",").str(); }
std::string play() { return Bytes().text("/transport/play").text(",").str(); }

TEST(UrgentLane, PanicOvertakesDecoding) {
  UrgentFixture fixture;
  ASSERT_TRUE(fixture.receiver.listen({{"127.0.0.1", 0}}).empty());
  const Client client;
  for (std::uint32_t i = 0; i < 50; i++) client.send(fixture.receiver.bound().front(), numbered(i));
  client.send(fixture.receiver.bound().front(), panic());
  fixture.receiver.receive(fixture.receiver.descriptors().front());
  EXPECT_TRUE(fixture.commands().empty());
  const std::vector<engine::UrgentRequest> lane = fixture.lane();
  ASSERT_EQ(lane.size(), 1u);
  EXPECT_EQ(lane[0].kind, engine::UrgentKind::panic);
  EXPECT_EQ(lane[0].origin.port, client.end().port);
  while (fixture.receiver.timeout() == 0) fixture.receiver.process_pending();
  const std::vector<engine::Command> commands = fixture.commands();
  EXPECT_EQ(commands.size(), 50u);
  EXPECT_LT(commands.back().arrival, lane[0].arrival);
  EXPECT_TRUE(fixture.lane().empty()) << "once";
  EXPECT_EQ(fixture.link.counters.received, 51u);
}

TEST(UrgentLane, ScheduledPanicKeepsItsTime) {
  UrgentFixture fixture;
  const std::string later = bundle(fixture.manual_clock.ntp + (std::uint64_t{2} << 32), {panic(), numbered(1)});
  EXPECT_FALSE(fixture.receiver.scan(later.data(), later.size(), {CommandSource::osc, 1, 2}).urgent);
  fixture.receiver.process(later.data(), later.size(), Endpoint{1, 2});
  fixture.receiver.process_pending();
  EXPECT_TRUE(fixture.lane().empty());
  // one that arrives meanwhile is not delayed
  const std::string now = panic();
  EXPECT_TRUE(fixture.receiver.scan(now.data(), now.size(), {CommandSource::osc, 1, 2}).urgent);
  EXPECT_EQ(fixture.lane().size(), 1u);
  fixture.manual_clock.advance(2.1);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.lane().size(), 1u);
  EXPECT_EQ(fixture.commands().size(), 1u);
}

TEST(UrgentLane, RejectsDeniedSenders) {
  UrgentFixture fixture({{0x0a000000u, 8}});
  const std::string bytes = panic();
  EXPECT_FALSE(fixture.receiver.scan(bytes.data(), bytes.size(), {CommandSource::osc, 0xc0a80101u, 2}).urgent);
  EXPECT_TRUE(fixture.receiver.scan(bytes.data(), bytes.size(), {CommandSource::osc, 0x0a000001u, 2}).urgent);
}

TEST(UrgentLane, ExecutesScannedBundleOnce) {
  UrgentFixture fixture;
  const std::string bytes = bundle(1, {play(), panic(), numbered(7), play()});
  const Receiver::ScanResult scanned =
      fixture.receiver.scan(bytes.data(), bytes.size(), {CommandSource::oscquery, 1, 2});
  EXPECT_TRUE(scanned.urgent);
  fixture.receiver.process(bytes.data(), bytes.size(), CommandOrigin{CommandSource::oscquery, 1, 2}, scanned);
  EXPECT_EQ(fixture.lane().size(), 1u);
  const std::vector<engine::Command> commands = fixture.commands();
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].messages.size(), 2u) << "the play before the panic is discarded";
  EXPECT_EQ(fixture.link.command_queue.fetch_discarded(), 1u);
}

}  // namespace
}  // namespace limber::osc
