// The sender: receivers of each kind of message, the limit of ten errors per second, and messages that are never
// answered.
#include "net/osc/sender.h"

#include <gtest/gtest.h>

#include "base/log/log.h"
#include "osc/osc_test_tools.h"

namespace limber::osc {
namespace {

using namespace test;

CommandOrigin origin_of(const Client& client) { return {CommandSource::osc, client.end().ip, client.end().port}; }

Message error_about(const std::string& address) { return {"/error", {Arg::of(address), Arg::of("wrong")}}; }

// Counts the waiting datagrams; the client sends itself a last one as an end marker.
int count_waiting(const Client& client) {
  client.send(client.end(), "end!");
  int count = 0;
  while (client.receive().value_or("end!") != "end!") count++;
  return count;
}

struct SenderFixture {
  SenderFixture() {
    EXPECT_TRUE(sender.open().ok());
    StreamTarget plain;
    StreamTarget with_errors;
    with_errors.errors = true;
    sender.set_targets({{plain, target.end()}, {with_errors, error_target.end()}});
  }
  Client requester, target, error_target, listener;
  ManualClock manual_clock;
  NetClock clock = manual_clock.clock();
  engine::Counters counters;
  engine::MessageLog traffic;
  int reply_fd = -1;
  Sender sender{counters, traffic, [this](const Endpoint&) { return reply_fd; }, clock};
};

TEST(Sender, RepliesToSender) {
  SenderFixture fixture;
  fixture.sender.send({engine::Outgoing::Destination::reply,
                       origin_of(fixture.requester),
                       {"/list/bodies", {Arg::of("arm1"), Arg::of("arm2")}}});
  EXPECT_EQ(fixture.requester.receive(), Bytes().text("/list/bodies").text(",ss").text("arm1").text("arm2").str());
  fixture.sender.pong(origin_of(fixture.requester), 12, 0.5);
  EXPECT_EQ(fixture.requester.receive(), Bytes().text("/pong").text(",if").u32(12).f(0.5f).str());
  fixture.sender.send({engine::Outgoing::Destination::direct, origin_of(fixture.requester), {"/hello", {}}});
  EXPECT_EQ(fixture.requester.receive(), Bytes().text("/hello").text(",").str());
  EXPECT_EQ(count_waiting(fixture.target), 0);
  EXPECT_EQ(fixture.counters.sent, 3u);
}

TEST(Sender, RepliesFromReceivingSocket) {
  SenderFixture fixture;
  const Result<system::UdpSocket> listening = system::open_udp({0x7f000001, 0});
  ASSERT_TRUE(listening.ok());
  fixture.reply_fd = listening->fd();
  Endpoint from;
  fixture.sender.pong(origin_of(fixture.requester), 1, 1);
  ASSERT_TRUE(fixture.requester.receive(kTimeoutMs, &from));
  EXPECT_EQ(from, listening->local());
  fixture.sender.send({engine::Outgoing::Destination::direct, origin_of(fixture.requester), {"/hello", {}}});
  ASSERT_TRUE(fixture.requester.receive(kTimeoutMs, &from));
  EXPECT_NE(from, listening->local());
}

TEST(Sender, SendsSceneMessagesToAllTargets) {
  SenderFixture fixture;
  fixture.sender.send({engine::Outgoing::Destination::targets, {}, {"/pulse", {Arg::of(2.0), Arg::of(true)}}});
  const std::string expected = Bytes().text("/pulse").text(",fi").f(2).u32(1).str();
  EXPECT_EQ(fixture.target.receive(), expected);
  EXPECT_EQ(fixture.error_target.receive(), expected);
  fixture.sender.send({engine::Outgoing::Destination::event, {}, {"/transport/state", {}}});
  EXPECT_EQ(count_waiting(fixture.target), 1);
  EXPECT_EQ(count_waiting(fixture.error_target), 1);
}

TEST(Sender, SendsErrorsToSenderAndErrorTargets) {
  SenderFixture fixture;
  fixture.sender.send(
      {engine::Outgoing::Destination::error, origin_of(fixture.requester), error_about("/physics/part/mas")});
  const std::string expected = Bytes().text("/error").text(",ss").text("/physics/part/mas").text("wrong").str();
  EXPECT_EQ(fixture.requester.receive(), expected);
  EXPECT_EQ(fixture.error_target.receive(), expected);
  EXPECT_EQ(count_waiting(fixture.target), 0);
}

TEST(Sender, LimitsErrorsToTenPerSecond) {
  SenderFixture fixture;
  const auto err = [&](const Client& client) {
    for (int i = 0; i < 100; i++)
      fixture.sender.send({engine::Outgoing::Destination::error, origin_of(client), error_about("/x")});
  };
  err(fixture.requester);
  EXPECT_EQ(count_waiting(fixture.requester), 10);
  fixture.manual_clock.advance(0.999);
  err(fixture.requester);
  EXPECT_EQ(count_waiting(fixture.requester), 0);
  err(fixture.listener);
  EXPECT_EQ(count_waiting(fixture.listener), 10) << "another sender has its own ten";
  fixture.manual_clock.advance(0.001);
  err(fixture.requester);
  EXPECT_EQ(count_waiting(fixture.requester), 10);
  EXPECT_EQ(count_waiting(fixture.error_target), 30) << "targets with errors=on get all errors that were sent";
}

TEST(Sender, NeverAnswersRepliesAndStreams) {
  SenderFixture fixture;
  for (const char* address :
       {"/error", "/pong", "/physics/joint/pos", "/physics/joint/rot", "/physics/joint/relrot", "/physics/joint/relpos",
        "/physics/contact", "/transport/state", "/script/error", "/script/ok"}) {
    fixture.sender.send({engine::Outgoing::Destination::error, origin_of(fixture.requester), error_about(address)});
  }
  EXPECT_EQ(count_waiting(fixture.requester), 0);
  EXPECT_EQ(count_waiting(fixture.error_target), 0);
  EXPECT_EQ(fixture.counters.sent, 0u);
}

TEST(Sender, CountsFailedSends) {
  log_to_stderr(false);
  SenderFixture fixture;
  // datagrams can't be sent to port 0
  StreamTarget target;
  fixture.sender.set_targets({{target, {0x7f000001, 0}}});
  for (int i = 0; i < 3; i++) fixture.sender.send({engine::Outgoing::Destination::targets, {}, {"/a", {}}});
  EXPECT_EQ(fixture.counters.unsent, 3u);
  EXPECT_EQ(fixture.counters.sent, 0u);
  log_to_stderr(true);
}

TEST(Sender, SkipsReplyWithoutAddress) {
  SenderFixture fixture;
  fixture.sender.send({engine::Outgoing::Destination::reply, {CommandSource::panel, 0, 0}, {"/a", {}}});
  EXPECT_EQ(fixture.counters.sent, 0u);
}

TEST(Sender, ReportsTooLargeMessage) {
  log_to_stderr(false);
  SenderFixture fixture;
  const std::uint64_t before = log_count(LogLevel::warning);
  Message m{"/large", std::vector<Arg>(20000, Arg::of(1.0))};
  fixture.sender.send({engine::Outgoing::Destination::targets, {}, m});
  fixture.sender.send({engine::Outgoing::Destination::targets, {}, m});
  EXPECT_EQ(fixture.counters.sent, 0u);
  EXPECT_EQ(log_count(LogLevel::warning), before + 1);
  log_to_stderr(true);
}

// 300 senders pass through a table of 256 entries: each can still get ten errors and no more.
TEST(ErrorRateLimit, HandlesManySenders) {
  ErrorRateLimit limit;
  for (std::uint32_t s = 0; s < 300; s++) {
    int allowed = 0;
    for (int i = 0; i < 25; i++) allowed += limit.allow({s + 1, 9}, 1000 + s) ? 1 : 0;
    EXPECT_EQ(allowed, 10) << s;
  }
  EXPECT_FALSE(limit.allow({300, 9}, 2000)) << "still remembered";
  EXPECT_TRUE(limit.allow({1, 9}, 2000)) << "forgotten: the longest quiet";
}

}  // namespace
}  // namespace limber::osc
