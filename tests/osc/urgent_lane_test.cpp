// Urgent requests reach the engine ahead of the datagrams before them, once, and from allowed senders alone.
#include <gtest/gtest.h>

#include "osc/bad_packets.h"
#include "osc/osc_test_tools.h"
#include "osc/receiver.h"

namespace limber {
namespace {

using namespace osc_test;

struct UrgentDesk {
  explicit UrgentDesk(std::vector<Cidr> allow = {}) : receiver(link, std::move(allow), {}, clock) {}

  std::vector<UrgentRequest> lane() {
    std::vector<UrgentRequest> requests;
    link.inbox.drain_urgent(requests);
    return requests;
  }
  std::vector<Command> commands() {
    std::vector<Command> list;
    link.inbox.drain(list);
    return list;
  }

  EngineLink link;
  HandClock hand;
  NetClock clock = hand.clock();
  Receiver receiver;
};

std::string panic() { return Bytes().text("/transport/panic").text(",").str(); }
std::string play() { return Bytes().text("/transport/play").text(",").str(); }

TEST(UrgentLane, APanicIsReadAheadOfDecoding) {
  UrgentDesk desk;
  ASSERT_TRUE(desk.receiver.listen({{"127.0.0.1", 0}}).empty());
  const Client client;
  for (std::uint32_t i = 0; i < 50; i++) client.send(desk.receiver.bound().front(), numbered(i));
  client.send(desk.receiver.bound().front(), panic());
  desk.receiver.receive(desk.receiver.descriptors().front());
  EXPECT_TRUE(desk.commands().empty());
  const std::vector<UrgentRequest> lane = desk.lane();
  ASSERT_EQ(lane.size(), 1u);
  EXPECT_EQ(lane[0].kind, UrgentKind::panic);
  EXPECT_EQ(lane[0].origin.port, client.end().port);
  while (desk.receiver.wait() == 0) desk.receiver.release_due();
  const std::vector<Command> commands = desk.commands();
  EXPECT_EQ(commands.size(), 50u);
  EXPECT_LT(commands.back().arrival, lane[0].arrival);
  EXPECT_TRUE(desk.lane().empty()) << "once";
  EXPECT_EQ(desk.link.counters.received, 51u);
}

TEST(UrgentLane, AScheduledPanicKeepsItsTime) {
  UrgentDesk desk;
  const std::string later = bundle(desk.hand.ntp + (std::uint64_t{2} << 32), {panic(), numbered(1)});
  EXPECT_FALSE(desk.receiver.scan(later.data(), later.size(), {Hand::osc, 1, 2}).urgent);
  desk.receiver.take(later.data(), later.size(), Endpoint{1, 2});
  desk.receiver.release_due();
  EXPECT_TRUE(desk.lane().empty());
  // one that comes meanwhile does not wait for it
  const std::string now = panic();
  EXPECT_TRUE(desk.receiver.scan(now.data(), now.size(), {Hand::osc, 1, 2}).urgent);
  EXPECT_EQ(desk.lane().size(), 1u);
  desk.hand.turn(2.1);
  desk.receiver.release_due();
  EXPECT_EQ(desk.lane().size(), 1u);
  EXPECT_EQ(desk.commands().size(), 1u);
}

TEST(UrgentLane, WhoIsNotAllowedHasNone) {
  UrgentDesk desk({{0x0a000000u, 8}});
  const std::string bytes = panic();
  EXPECT_FALSE(desk.receiver.scan(bytes.data(), bytes.size(), {Hand::osc, 0xc0a80101u, 2}).urgent);
  EXPECT_TRUE(desk.receiver.scan(bytes.data(), bytes.size(), {Hand::osc, 0x0a000001u, 2}).urgent);
}

TEST(UrgentLane, ABundleThatWasScannedIsNotCarriedOutTwice) {
  UrgentDesk desk;
  const std::string bytes = bundle(1, {play(), panic(), numbered(7), play()});
  const Receiver::Scanned scanned = desk.receiver.scan(bytes.data(), bytes.size(), {Hand::query, 1, 2});
  EXPECT_TRUE(scanned.urgent);
  desk.receiver.take(bytes.data(), bytes.size(), Origin{Hand::query, 1, 2}, scanned);
  EXPECT_EQ(desk.lane().size(), 1u);
  const std::vector<Command> commands = desk.commands();
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].messages.size(), 2u) << "the play before the panic is discarded";
  EXPECT_EQ(desk.link.inbox.fetch_discarded(), 1u);
}

}  // namespace
}  // namespace limber
