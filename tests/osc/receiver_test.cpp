// The receiver: malformed datagrams change only counters; allow list, pings, rejected types, time tags, a full command
// queue.
#include "net/osc/receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/log/log.h"
#include "base/system/process.h"
#include "osc/bad_packets.h"

namespace limber::osc {
namespace {

using namespace test;

constexpr Endpoint kFrom{0xc0a80107u, 5000};  // 192.168.1.7

// A receiver without sockets: tests pass datagrams to it directly.
struct ReceiverFixture {
  explicit ReceiverFixture(std::vector<Cidr> allow = {})
      : receiver(engine.link, std::move(allow),
                 {[this](const engine::Outgoing& out) { errors.push_back(out); },
                  [this](const CommandOrigin& o) { pongs.push_back(o); }},
                 clock) {}

  void process(const std::string& bytes, const Endpoint& from = kFrom) {
    const auto exact = std::make_unique<char[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), exact.get());
    receiver.process(exact.get(), bytes.size(), from);
  }
  // Returns the first argument of each message received so far.
  std::vector<double> numbers() {
    engine.collect();
    std::vector<double> list;
    for (const engine::Command& c : engine.commands) {
      for (const Message& m : c.messages) list.push_back(m.args.at(0).number);
    }
    return list;
  }

  FakeEngine engine;
  ManualClock manual_clock;
  NetClock clock = manual_clock.clock();
  std::vector<engine::Outgoing> errors;
  std::vector<CommandOrigin> pongs;
  Receiver receiver;
};

TEST(Receiver, MalformedOnlyChangesCounters) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  std::uint64_t bad = 0;
  for (const BadPacket& packet : bad_packets()) {
    fixture.process(packet.bytes);
    bad++;
    // the next valid message is accepted
    fixture.process(numbered(static_cast<std::uint32_t>(bad)));
    EXPECT_EQ(fixture.engine.link.counters.malformed, bad) << packet.description;
    EXPECT_EQ(fixture.engine.link.counters.received, bad) << packet.description;
    EXPECT_EQ(fixture.numbers().back(), static_cast<double>(bad)) << packet.description;
  }
  EXPECT_EQ(fixture.numbers().size(), bad);
  EXPECT_TRUE(fixture.errors.empty());
  log_to_stderr(true);
}

TEST(Receiver, KnownBadPacketsOnlyChangeCounters) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  std::uint64_t files = 0;
  std::uint64_t whole = 0;
  std::error_code none;
  const std::string folder = std::string(LIMBER_SOURCE_DIR) + "/../shared/data/osc_bad";
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::ifstream file(entry.path(), std::ios::binary);
    fixture.process({std::istreambuf_iterator<char>(file), {}});
    files++;
    if (entry.path().stem() == "r9_empty_typetags") whole++;
  }
  EXPECT_EQ(fixture.engine.link.counters.malformed, files - whole);
  EXPECT_EQ(fixture.engine.link.counters.received, whole);
  log_to_stderr(true);
}

// A thousand malformed datagrams within a minute cause one log line; a minute later another one reports their number.
TEST(Receiver, LogsMalformedOncePerMinute) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  const std::uint64_t before = log_count(LogLevel::warning);
  for (int i = 0; i < 1000; i++) fixture.process("x");
  EXPECT_EQ(log_count(LogLevel::warning), before + 1);
  fixture.manual_clock.advance(60);
  fixture.process("x");
  EXPECT_EQ(log_count(LogLevel::warning), before + 2);
  EXPECT_NE(log_since(0).back().text.find("(and 999 more since the last warning)"), std::string::npos);
  log_to_stderr(true);
}

TEST(Receiver, DatagramBecomesOneCommand) {
  ReceiverFixture fixture;
  fixture.process(bundle(1, {numbered(1), bundle(1, {numbered(2)}), numbered(3)}));
  fixture.process(numbered(4));
  fixture.engine.collect();
  ASSERT_EQ(fixture.engine.commands.size(), 2u);
  EXPECT_EQ(fixture.engine.commands[0].messages.size(), 3u);
  EXPECT_EQ(fixture.engine.commands[0].origin.source, CommandSource::osc);
  EXPECT_EQ(fixture.engine.commands[0].origin.ip, kFrom.ip);
  EXPECT_EQ(fixture.engine.commands[0].origin.port, kFrom.port);
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(fixture.engine.link.counters.received, 4u);
}

TEST(Receiver, AnswersPings) {
  ReceiverFixture fixture;
  const std::string ping = Bytes().text("/ping").text(",").str();
  fixture.process(ping);
  fixture.process(bundle(1, {numbered(1), ping, ping}));
  ASSERT_EQ(fixture.pongs.size(), 3u);
  EXPECT_EQ(fixture.pongs[0].ip, kFrom.ip);
  EXPECT_EQ(fixture.pongs[0].port, kFrom.port);
  EXPECT_EQ(fixture.numbers(), std::vector<double>{1});
  EXPECT_EQ(fixture.engine.link.counters.received, 4u);
}

TEST(Receiver, AnswersUnsupportedTags) {
  ReceiverFixture fixture;
  fixture.process(bundle(1, {numbered(1), Bytes().text("/b").text(",b").u32(0).str()}));
  ASSERT_EQ(fixture.errors.size(), 1u);
  EXPECT_EQ(fixture.errors[0].destination, engine::Outgoing::Destination::error);
  EXPECT_EQ(fixture.errors[0].origin.port, kFrom.port);
  EXPECT_EQ(fixture.errors[0].message.address, "/error");
  EXPECT_EQ(fixture.errors[0].message.args.at(0).text, "/b");
  EXPECT_EQ(fixture.errors[0].message.args.at(1).text,
            "a blob (b) is not supported; send numbers (i h f d T F) or text (s)");
  EXPECT_EQ(fixture.engine.link.counters.refused, 1u);
  EXPECT_EQ(fixture.numbers(), std::vector<double>{1});
}

TEST(Receiver, ChecksAllowListFirst) {
  log_to_stderr(false);
  ReceiverFixture fixture({{0xc0a80100u, 24}, {0x0a000001u, 32}});
  fixture.process(numbered(1), {0xc0a801ffu, 1});
  fixture.process(numbered(2), {0xc0a80201u, 1});
  fixture.process(numbered(3), {0x0a000001u, 1});
  fixture.process(numbered(4), {0x0a000002u, 1});
  fixture.process("bad", {0x0a000002u, 1});
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 3}));
  EXPECT_EQ(fixture.engine.link.counters.denied, 3u);
  EXPECT_EQ(fixture.engine.link.counters.malformed, 0u);
  log_to_stderr(true);
}

TEST(Receiver, DeliversInOrderOfTimeTags) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;
  const std::uint64_t now = fixture.manual_clock.ntp;
  fixture.process(bundle(now + 2 * kSecond, {numbered(4), numbered(5)}));
  fixture.process(bundle(now + kSecond, {numbered(3)}));
  fixture.process(bundle(0, {numbered(1)}));                   // undefined time: now
  fixture.process(bundle(now + 20 * kSecond, {numbered(2)}));  // too far ahead: now
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2}));
  fixture.manual_clock.advance(1);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(fixture.receiver.timeout(), 1'000'000'001);
  fixture.manual_clock.advance(5);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2, 3, 4, 5}));
  log_to_stderr(true);
}

// A nested bundle waits for its own time; one whose time is before that of its container is due with it.
TEST(Receiver, DeliversNestedBundlesAtTheirTimes) {
  ReceiverFixture fixture;
  constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;
  const std::uint64_t now = fixture.manual_clock.ntp;
  const std::string inner = bundle(now + 2 * kSecond, {numbered(5), numbered(6)});
  const std::string outer = bundle(now + kSecond, {numbered(3), bundle(now, {numbered(4)}), inner});
  fixture.process(bundle(1, {numbered(1), outer, numbered(2)}));
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2}));
  fixture.manual_clock.advance(1.5);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2, 3, 4}));
  fixture.manual_clock.advance(1);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

// The command queue is limited; further commands are dropped and their messages counted.
TEST(Receiver, CountsMessagesDroppedByFullInbox) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  for (std::size_t i = 0; i < engine::EngineLink::kMaxCommands; i++) fixture.process(numbered(1));
  EXPECT_EQ(fixture.engine.link.counters.dropped, 0u);
  fixture.process(bundle(1, {numbered(2), numbered(2), numbered(2)}));
  EXPECT_EQ(fixture.engine.link.counters.dropped, 3u);
  EXPECT_EQ(fixture.numbers().size(), engine::EngineLink::kMaxCommands);
  fixture.process(numbered(7));
  EXPECT_EQ(fixture.numbers().back(), 7);
  log_to_stderr(true);
}

TEST(Receiver, KeepsUnchangedSocketsOpen) {
  ReceiverFixture fixture;
  const ListenAddress any{"127.0.0.1", 0};
  ASSERT_TRUE(fixture.receiver.listen({any}).empty());
  const Endpoint first = fixture.receiver.bound().at(0);
  ASSERT_NE(first.port, 0);
  const ListenAddress other{"127.0.0.2", 0};
  ASSERT_TRUE(fixture.receiver.listen({any, other}).empty());
  EXPECT_EQ(fixture.receiver.bound().at(0), first);
  EXPECT_EQ(fixture.receiver.bound().at(1).ip, 0x7f000002u);
  ASSERT_TRUE(fixture.receiver.listen({other}).empty());
  EXPECT_EQ(fixture.receiver.bound().size(), 1u);
  // the port has been closed
  ASSERT_TRUE(fixture.receiver.listen({other, {"127.0.0.1", first.port}}).empty());
  EXPECT_EQ(fixture.receiver.bound().at(1), first);
}

TEST(Receiver, ReportsPortInUseWithCorrection) {
  ReceiverFixture fixture;
  const Client holder;
  const std::uint16_t port = holder.end().port;
  const auto faults = fixture.receiver.listen({{"127.0.0.1", port}});
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0], "OSC can't listen on 127.0.0.1:" + std::to_string(port) +
                           ": Address already in use. Choose another port with --osc-in ADDR:PORT, or continue "
                           "without it with --osc-optional");
  const auto nowhere = fixture.receiver.listen({{"192.0.2.1", 9003}});
  ASSERT_EQ(nowhere.size(), 1u);
  EXPECT_NE(nowhere[0].find("192.0.2.1:9003: Cannot assign requested address"), std::string::npos) << nowhere[0];
}

TEST(Receiver, RemembersSocketOfSender) {
  ReceiverFixture fixture;
  ASSERT_TRUE(fixture.receiver.listen({{"127.0.0.1", 0}, {"127.0.0.2", 0}}).empty());
  const std::vector<int> fds = fixture.receiver.descriptors();
  const Client client;
  client.send(fixture.receiver.bound().at(1), numbered(1));
  // loopback delivers before sendto() returns
  fixture.receiver.receive(fds[0]);
  fixture.receiver.receive(fds[1]);
  fixture.receiver.process_pending();
  EXPECT_EQ(fixture.numbers(), std::vector<double>{1});
  EXPECT_EQ(fixture.receiver.socket_of(client.end()), fds[1]);
  EXPECT_EQ(fixture.receiver.socket_of({0x7f000001u, 1}), -1);
  fixture.receiver.listen({{"127.0.0.1", 0}});
  EXPECT_EQ(fixture.receiver.socket_of(client.end()), -1) << "its socket is closed";
}

// Datagrams that overflow the socket's buffer are dropped by the kernel, and all of them are counted.
TEST(Receiver, CountsKernelDrops) {
  log_to_stderr(false);
  ReceiverFixture fixture;
  ASSERT_TRUE(fixture.receiver.listen({{"127.0.0.1", 0}}).empty());
  const int fd = fixture.receiver.descriptors().at(0);
  const int small = 4096;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  const Client client;
  for (std::uint32_t i = 0; i < 500; i++) client.send(fixture.receiver.bound().at(0), numbered(i));
  fixture.receiver.receive(fd);
  // the kernel reports the count with the next accepted datagram
  client.send(fixture.receiver.bound().at(0), numbered(500));
  fixture.receiver.receive(fd);
  while (fixture.receiver.timeout() == 0) fixture.receiver.process_pending();
  const std::uint64_t lost = fixture.engine.link.counters.dropped_kernel;
  log_to_stderr(true);
  if (system::is_portable()) {
    EXPECT_LT(fixture.numbers().size(), 501u);
    EXPECT_EQ(lost, 0u) << "POSIX does not count them";
    return;
  }
  EXPECT_GT(lost, 0u);
  EXPECT_EQ(fixture.numbers().size() + lost, 501u);
}

}  // namespace
}  // namespace limber::osc
