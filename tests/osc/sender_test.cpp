// The sender: who gets what, ten errors a second, and what is never answered.
#include "osc/sender.h"

#include <gtest/gtest.h>

#include "base/log.h"
#include "osc/osc_test_tools.h"

namespace limber {
namespace {

using namespace osc_test;

Origin origin_of(const Client& client) { return {Hand::osc, client.end().ip, client.end().port}; }

Message error_about(const std::string& address) { return {"/error", {Arg::of(address), Arg::of("wrong")}}; }

// how many datagrams wait; a last one from the client to itself says that there are no more
int waiting(const Client& client) {
  client.send(client.end(), "end!");
  int count = 0;
  while (client.receive().value_or("end!") != "end!") count++;
  return count;
}

struct SenderDesk {
  SenderDesk() {
    EXPECT_TRUE(sender.open().ok());
    StreamTarget plain;
    StreamTarget with_errors;
    with_errors.errors = true;
    sender.set_targets({{plain, target.end()}, {with_errors, watcher.end()}});
  }
  Client asker, target, watcher, listener;
  HandClock hand;
  NetClock clock = hand.clock();
  Counters counters;
  Traffic traffic;
  int reply_fd = -1;
  Sender sender{counters, traffic, [this](const Endpoint&) { return reply_fd; }, clock};
};

TEST(Sender, AnswersGoToTheAsker) {
  SenderDesk desk;
  desk.sender.send({Outgoing::To::sender, origin_of(desk.asker), {"/list/bodies", {Arg::of("arm1"), Arg::of("arm2")}}});
  EXPECT_EQ(desk.asker.receive(), Bytes().text("/list/bodies").text(",ss").text("arm1").text("arm2").str());
  desk.sender.pong(origin_of(desk.asker), 12, 0.5);
  EXPECT_EQ(desk.asker.receive(), Bytes().text("/pong").text(",if").u32(12).f(0.5f).str());
  desk.sender.send({Outgoing::To::direct, origin_of(desk.asker), {"/hello", {}}});
  EXPECT_EQ(desk.asker.receive(), Bytes().text("/hello").text(",").str());
  EXPECT_EQ(waiting(desk.target), 0);
  EXPECT_EQ(desk.counters.sent, 3u);
}

TEST(Sender, AnswersComeFromTheSocketThatWasAsked) {
  SenderDesk desk;
  const Result<system::UdpSocket> listening = system::open_udp({0x7f000001, 0});
  ASSERT_TRUE(listening.ok());
  desk.reply_fd = listening->fd();
  Endpoint from;
  desk.sender.pong(origin_of(desk.asker), 1, 1);
  ASSERT_TRUE(desk.asker.receive(kPatienceMs, &from));
  EXPECT_EQ(from, listening->local());
  desk.sender.send({Outgoing::To::direct, origin_of(desk.asker), {"/hello", {}}});
  ASSERT_TRUE(desk.asker.receive(kPatienceMs, &from));
  EXPECT_NE(from, listening->local());
}

TEST(Sender, SceneMessagesGoToEveryTarget) {
  SenderDesk desk;
  desk.sender.send({Outgoing::To::targets, {}, {"/pulse", {Arg::of(2.0), Arg::of(true)}}});
  const std::string expected = Bytes().text("/pulse").text(",fi").f(2).u32(1).str();
  EXPECT_EQ(desk.target.receive(), expected);
  EXPECT_EQ(desk.watcher.receive(), expected);
  desk.sender.send({Outgoing::To::event, {}, {"/transport/state", {}}});
  EXPECT_EQ(waiting(desk.target), 1);
  EXPECT_EQ(waiting(desk.watcher), 1);
}

TEST(Sender, ErrorsGoToTheAskerAndToWhoWantsThem) {
  SenderDesk desk;
  desk.sender.send({Outgoing::To::error, origin_of(desk.asker), error_about("/physics/part/mas")});
  const std::string expected = Bytes().text("/error").text(",ss").text("/physics/part/mas").text("wrong").str();
  EXPECT_EQ(desk.asker.receive(), expected);
  EXPECT_EQ(desk.watcher.receive(), expected);
  EXPECT_EQ(waiting(desk.target), 0);
}

TEST(Sender, TenErrorsASecondPerSender) {
  SenderDesk desk;
  const auto err = [&](const Client& who) {
    for (int i = 0; i < 100; i++) desk.sender.send({Outgoing::To::error, origin_of(who), error_about("/x")});
  };
  err(desk.asker);
  EXPECT_EQ(waiting(desk.asker), 10);
  desk.hand.turn(0.999);
  err(desk.asker);
  EXPECT_EQ(waiting(desk.asker), 0);
  err(desk.listener);
  EXPECT_EQ(waiting(desk.listener), 10) << "another sender has its own ten";
  desk.hand.turn(0.001);
  err(desk.asker);
  EXPECT_EQ(waiting(desk.asker), 10);
  EXPECT_EQ(waiting(desk.watcher), 30) << "one who wants errors sees what was answered";
}

TEST(Sender, AnswersAndStreamsAreNeverAnswered) {
  SenderDesk desk;
  for (const char* address :
       {"/error", "/pong", "/physics/joint/pos", "/physics/joint/rot", "/physics/joint/relrot", "/physics/joint/relpos",
        "/physics/contact", "/transport/state", "/script/error", "/script/ok"}) {
    desk.sender.send({Outgoing::To::error, origin_of(desk.asker), error_about(address)});
  }
  EXPECT_EQ(waiting(desk.asker), 0);
  EXPECT_EQ(waiting(desk.watcher), 0);
  EXPECT_EQ(desk.counters.sent, 0u);
}

TEST(Sender, WhatTheSystemDoesNotTakeIsCounted) {
  log_to_stderr(false);
  SenderDesk desk;
  // no datagram goes to port 0
  StreamTarget wish;
  desk.sender.set_targets({{wish, {0x7f000001, 0}}});
  for (int i = 0; i < 3; i++) desk.sender.send({Outgoing::To::targets, {}, {"/a", {}}});
  EXPECT_EQ(desk.counters.unsent, 3u);
  EXPECT_EQ(desk.counters.sent, 0u);
  log_to_stderr(true);
}

TEST(Sender, NoAddressNoAnswer) {
  SenderDesk desk;
  desk.sender.send({Outgoing::To::sender, {Hand::panel, 0, 0}, {"/a", {}}});
  EXPECT_EQ(desk.counters.sent, 0u);
}

TEST(Sender, TooLargeIsSaidAndNotSent) {
  log_to_stderr(false);
  SenderDesk desk;
  const std::uint64_t before = log_count(LogLevel::warning);
  Message m{"/large", std::vector<Arg>(20000, Arg::of(1.0))};
  desk.sender.send({Outgoing::To::targets, {}, m});
  desk.sender.send({Outgoing::To::targets, {}, m});
  EXPECT_EQ(desk.counters.sent, 0u);
  EXPECT_EQ(log_count(LogLevel::warning), before + 1);
  log_to_stderr(true);
}

// 300 senders pass through a table of 256: each still gets its ten, none more
TEST(ErrorLimit, ManySenders) {
  ErrorLimit limit;
  for (std::uint32_t s = 0; s < 300; s++) {
    int allowed = 0;
    for (int i = 0; i < 25; i++) allowed += limit.allow({s + 1, 9}, 1000 + s) ? 1 : 0;
    EXPECT_EQ(allowed, 10) << s;
  }
  EXPECT_FALSE(limit.allow({300, 9}, 2000)) << "still remembered";
  EXPECT_TRUE(limit.allow({1, 9}, 2000)) << "forgotten: the longest quiet";
}

}  // namespace
}  // namespace limber
