// The receiver: bad datagrams change counters only, allow-list, pings, refused tags, time tags, a full inbox.
#include "osc/receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/log.h"
#include "base/system/process.h"
#include "osc/bad_packets.h"

namespace limber {
namespace {

using namespace osc_test;

constexpr Endpoint kFrom{0xc0a80107u, 5000};  // 192.168.1.7

// a receiver without sockets: datagrams are handed to it
struct ReceiverDesk {
  explicit ReceiverDesk(std::vector<Cidr> allow = {})
      : receiver(
            engine.link, std::move(allow),
            {[this](const Outgoing& out) { errors.push_back(out); }, [this](const Origin& o) { pongs.push_back(o); }},
            clock) {}

  void take(const std::string& bytes, const Endpoint& from = kFrom) {
    const auto exact = std::make_unique<char[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), exact.get());
    receiver.take(exact.get(), bytes.size(), from);
  }
  // the arguments of all messages so far, first of each
  std::vector<double> numbers() {
    engine.collect();
    std::vector<double> list;
    for (const Command& c : engine.commands) {
      for (const Message& m : c.messages) list.push_back(m.args.at(0).number);
    }
    return list;
  }

  FakeEngine engine;
  HandClock hand;
  NetClock clock = hand.clock();
  std::vector<Outgoing> errors;
  std::vector<Origin> pongs;
  Receiver receiver;
};

TEST(Receiver, MalformedOnlyCounts) {
  log_to_stderr(false);
  ReceiverDesk desk;
  std::uint64_t bad = 0;
  for (const BadPacket& packet : bad_packets()) {
    desk.take(packet.bytes);
    bad++;
    // the next good message works
    desk.take(numbered(static_cast<std::uint32_t>(bad)));
    EXPECT_EQ(desk.engine.link.counters.malformed, bad) << packet.what;
    EXPECT_EQ(desk.engine.link.counters.received, bad) << packet.what;
    EXPECT_EQ(desk.numbers().back(), static_cast<double>(bad)) << packet.what;
  }
  EXPECT_EQ(desk.numbers().size(), bad);
  EXPECT_TRUE(desk.errors.empty());
  log_to_stderr(true);
}

TEST(Receiver, KnownBadPacketsOnlyCount) {
  log_to_stderr(false);
  ReceiverDesk desk;
  std::uint64_t files = 0;
  std::uint64_t whole = 0;
  std::error_code none;
  const std::string folder = std::string(LIMBER_SOURCE_DIR) + "/../shared/data/osc_bad";
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::ifstream file(entry.path(), std::ios::binary);
    desk.take({std::istreambuf_iterator<char>(file), {}});
    files++;
    if (entry.path().stem() == "r9_empty_typetags") whole++;
  }
  EXPECT_EQ(desk.engine.link.counters.malformed, files - whole);
  EXPECT_EQ(desk.engine.link.counters.received, whole);
  log_to_stderr(true);
}

// a thousand bad datagrams within a minute are one line in the log; a minute later there is another, with their number
TEST(Receiver, MalformedIsSaidOnceAMinute) {
  log_to_stderr(false);
  ReceiverDesk desk;
  const std::uint64_t before = log_count(LogLevel::warning);
  for (int i = 0; i < 1000; i++) desk.take("x");
  EXPECT_EQ(log_count(LogLevel::warning), before + 1);
  desk.hand.turn(60);
  desk.take("x");
  EXPECT_EQ(log_count(LogLevel::warning), before + 2);
  EXPECT_NE(log_since(0).back().text.find("(and 999 more since the last warning)"), std::string::npos);
  log_to_stderr(true);
}

TEST(Receiver, OneDatagramIsOneCommand) {
  ReceiverDesk desk;
  desk.take(bundle(1, {numbered(1), bundle(1, {numbered(2)}), numbered(3)}));
  desk.take(numbered(4));
  desk.engine.collect();
  ASSERT_EQ(desk.engine.commands.size(), 2u);
  EXPECT_EQ(desk.engine.commands[0].messages.size(), 3u);
  EXPECT_EQ(desk.engine.commands[0].origin.hand, Hand::osc);
  EXPECT_EQ(desk.engine.commands[0].origin.ip, kFrom.ip);
  EXPECT_EQ(desk.engine.commands[0].origin.port, kFrom.port);
  EXPECT_EQ(desk.numbers(), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(desk.engine.link.counters.received, 4u);
}

TEST(Receiver, PingsAreAnsweredHere) {
  ReceiverDesk desk;
  const std::string ping = Bytes().text("/ping").text(",").str();
  desk.take(ping);
  desk.take(bundle(1, {numbered(1), ping, ping}));
  ASSERT_EQ(desk.pongs.size(), 3u);
  EXPECT_EQ(desk.pongs[0].ip, kFrom.ip);
  EXPECT_EQ(desk.pongs[0].port, kFrom.port);
  EXPECT_EQ(desk.numbers(), std::vector<double>{1});
  EXPECT_EQ(desk.engine.link.counters.received, 4u);
}

TEST(Receiver, RefusedTagsAreAnswered) {
  ReceiverDesk desk;
  desk.take(bundle(1, {numbered(1), Bytes().text("/b").text(",b").u32(0).str()}));
  ASSERT_EQ(desk.errors.size(), 1u);
  EXPECT_EQ(desk.errors[0].to, Outgoing::To::error);
  EXPECT_EQ(desk.errors[0].origin.port, kFrom.port);
  EXPECT_EQ(desk.errors[0].message.address, "/error");
  EXPECT_EQ(desk.errors[0].message.args.at(0).text, "/b");
  EXPECT_EQ(desk.errors[0].message.args.at(1).text, "a blob (b) is not taken; send numbers (i h f d T F) or text (s)");
  EXPECT_EQ(desk.engine.link.counters.refused, 1u);
  EXPECT_EQ(desk.numbers(), std::vector<double>{1});
}

TEST(Receiver, AllowListIsAskedBeforeAnythingIsRead) {
  log_to_stderr(false);
  ReceiverDesk desk({{0xc0a80100u, 24}, {0x0a000001u, 32}});
  desk.take(numbered(1), {0xc0a801ffu, 1});
  desk.take(numbered(2), {0xc0a80201u, 1});
  desk.take(numbered(3), {0x0a000001u, 1});
  desk.take(numbered(4), {0x0a000002u, 1});
  desk.take("bad", {0x0a000002u, 1});
  EXPECT_EQ(desk.numbers(), (std::vector<double>{1, 3}));
  EXPECT_EQ(desk.engine.link.counters.denied, 3u);
  EXPECT_EQ(desk.engine.link.counters.malformed, 0u);
  log_to_stderr(true);
}

TEST(Receiver, TimeTagsInOrder) {
  log_to_stderr(false);
  ReceiverDesk desk;
  constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;
  const std::uint64_t now = desk.hand.ntp;
  desk.take(bundle(now + 2 * kSecond, {numbered(4), numbered(5)}));
  desk.take(bundle(now + kSecond, {numbered(3)}));
  desk.take(bundle(0, {numbered(1)}));                   // no time at all: now
  desk.take(bundle(now + 20 * kSecond, {numbered(2)}));  // too far: now
  desk.receiver.release_due();
  EXPECT_EQ(desk.numbers(), (std::vector<double>{1, 2}));
  desk.hand.turn(1);
  desk.receiver.release_due();
  EXPECT_EQ(desk.numbers(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(desk.receiver.wait(), 1'000'000'001);
  desk.hand.turn(5);
  desk.receiver.release_due();
  EXPECT_EQ(desk.numbers(), (std::vector<double>{1, 2, 3, 4, 5}));
  log_to_stderr(true);
}

// the inbox holds so many commands; what comes on top is dropped and counted, in messages
TEST(Receiver, FullInboxCountsWhatItDrops) {
  log_to_stderr(false);
  ReceiverDesk desk;
  for (std::size_t i = 0; i < EngineLink::kMostCommands; i++) desk.take(numbered(1));
  EXPECT_EQ(desk.engine.link.counters.dropped, 0u);
  desk.take(bundle(1, {numbered(2), numbered(2), numbered(2)}));
  EXPECT_EQ(desk.engine.link.counters.dropped, 3u);
  EXPECT_EQ(desk.numbers().size(), EngineLink::kMostCommands);
  desk.take(numbered(7));
  EXPECT_EQ(desk.numbers().back(), 7);
  log_to_stderr(true);
}

TEST(Receiver, KeepsOpenWhatDidNotChange) {
  ReceiverDesk desk;
  const ListenAddress any{"127.0.0.1", 0};
  ASSERT_TRUE(desk.receiver.listen({any}).empty());
  const Endpoint first = desk.receiver.bound().at(0);
  ASSERT_NE(first.port, 0);
  const ListenAddress other{"127.0.0.2", 0};
  ASSERT_TRUE(desk.receiver.listen({any, other}).empty());
  EXPECT_EQ(desk.receiver.bound().at(0), first);
  EXPECT_EQ(desk.receiver.bound().at(1).ip, 0x7f000002u);
  ASSERT_TRUE(desk.receiver.listen({other}).empty());
  EXPECT_EQ(desk.receiver.bound().size(), 1u);
  // the port is free again
  ASSERT_TRUE(desk.receiver.listen({other, {"127.0.0.1", first.port}}).empty());
  EXPECT_EQ(desk.receiver.bound().at(1), first);
}

TEST(Receiver, TakenPortIsSaidWithItsCure) {
  ReceiverDesk desk;
  const Client holder;
  const std::uint16_t port = holder.end().port;
  const auto faults = desk.receiver.listen({{"127.0.0.1", port}});
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0], "OSC can't listen on 127.0.0.1:" + std::to_string(port) +
                           ": Address already in use; choose another with --osc-in ADDR:PORT, or play without with "
                           "--osc-optional");
  const auto nowhere = desk.receiver.listen({{"192.0.2.1", 9003}});
  ASSERT_EQ(nowhere.size(), 1u);
  EXPECT_NE(nowhere[0].find("192.0.2.1:9003: Cannot assign requested address"), std::string::npos) << nowhere[0];
}

TEST(Receiver, KnowsBySocketWhoAsked) {
  ReceiverDesk desk;
  ASSERT_TRUE(desk.receiver.listen({{"127.0.0.1", 0}, {"127.0.0.2", 0}}).empty());
  const std::vector<int> fds = desk.receiver.descriptors();
  const Client client;
  client.send(desk.receiver.bound().at(1), numbered(1));
  // loopback delivers before sendto returns
  desk.receiver.receive(fds[0]);
  desk.receiver.receive(fds[1]);
  desk.receiver.release_due();
  EXPECT_EQ(desk.numbers(), std::vector<double>{1});
  EXPECT_EQ(desk.receiver.socket_of(client.end()), fds[1]);
  EXPECT_EQ(desk.receiver.socket_of({0x7f000001u, 1}), -1);
  desk.receiver.listen({{"127.0.0.1", 0}});
  EXPECT_EQ(desk.receiver.socket_of(client.end()), -1) << "its socket is closed";
}

// the kernel drops what does not fit into the socket's buffer, and we count as many as were lost
TEST(Receiver, KernelDropsAreCounted) {
  log_to_stderr(false);
  ReceiverDesk desk;
  ASSERT_TRUE(desk.receiver.listen({{"127.0.0.1", 0}}).empty());
  const int fd = desk.receiver.descriptors().at(0);
  const int small = 4096;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  const Client client;
  for (std::uint32_t i = 0; i < 500; i++) client.send(desk.receiver.bound().at(0), numbered(i));
  desk.receiver.receive(fd);
  // the count travels with the next datagram that gets in
  client.send(desk.receiver.bound().at(0), numbered(500));
  desk.receiver.receive(fd);
  while (desk.receiver.wait() == 0) desk.receiver.release_due();
  const std::uint64_t lost = desk.engine.link.counters.dropped_kernel;
  log_to_stderr(true);
  if (system::is_portable()) {
    EXPECT_LT(desk.numbers().size(), 501u);
    EXPECT_EQ(lost, 0u) << "POSIX does not count them";
    return;
  }
  EXPECT_GT(lost, 0u);
  EXPECT_EQ(desk.numbers().size() + lost, 501u);
}

}  // namespace
}  // namespace limber
