// Ranks of an MPI job, without MPI: messages in memory, workers in simulated time.
#include "experiments/ranks.h"

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "experiments/fake_workers.h"

namespace limber::experiments::test {
namespace {

using Kind = RankMessage::Kind;

/// The messages of one rank.
class FakeMessages final : public RankMessages {
 public:
  FakeMessages(std::vector<std::deque<Message>>& queues, std::size_t rank) : queues_(queues), rank_(rank) {}
  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return queues_.size(); }
  void send(std::size_t rank, std::string_view bytes) override { queues_[rank].push_back({rank_, std::string(bytes)}); }
  std::optional<Message> receive() override {
    std::deque<Message>& queue = queues_[rank_];
    if (queue.empty()) return {};
    Message message = std::move(queue.front());
    queue.pop_front();
    return message;
  }

 private:
  std::vector<std::deque<Message>>& queues_;
  std::size_t rank_;
};

struct FakeRank {
  FakeRank(std::vector<std::deque<RankMessages::Message>>& queues, std::size_t rank, const std::string& program)
      : messages(queues, rank), worker(messages, workers, program, "node" + std::to_string(rank)) {}
  FakeMessages messages;
  FakeWorkers workers{1};
  RankWorker worker;
};

/// Rank 0. While it waits, the other ranks take some steps, in a random order.
class Job final : public Workers {
 public:
  explicit Job(std::size_t size, const std::string& other_program = "1.0")
      : queues_(size), messages_(queues_, 0), workers(messages_, *this, "1.0") {
    for (std::size_t i = 1; i < size; i++) {
      ranks.push_back(std::make_unique<FakeRank>(queues_, i, i == 1 ? other_program : "1.0"));
      ranks.back()->workers.tries = local.tries;
    }
  }
  std::size_t count() const override { return 1; }
  Result<void> start(std::size_t worker) override { return local.start(worker); }
  void send(std::size_t worker, std::string_view line) override { local.send(worker, line); }
  std::vector<Event> wait(std::chrono::microseconds limit) override {
    for (std::size_t i = 0; i < ranks.size(); i++) {
      if (random_.uniform(0, 1) < 0.5) (void)ranks[i]->worker.step();
    }
    return local.wait(limit);
  }

  Dispatcher::Options options() {
    Dispatcher::Options options;
    options.time_limit = 5;
    options.clock = [this] { return local.now; };
    return options;
  }
  /// Evaluates `count` values; returns the error.
  std::string run(std::uint64_t count, const std::function<FakeWorkers::Fate(std::uint64_t, int)>& fate) {
    local.fate = fate;
    for (const auto& rank : ranks) rank->workers.fate = fate;
    Dispatcher dispatcher(workers, options());
    const Result<SceneInfo> scene = dispatcher.describe({"scene.lua", 10, {}});
    if (!scene) return scene.error();
    dispatcher.set_setup({"scene.lua", 10, {"rate"}});
    std::uint64_t next = 0;
    const auto end = dispatcher.run(
        [&]() -> std::optional<Evaluation> {
          if (next >= count) return {};
          const std::uint64_t number = next++;
          return Evaluation{number, 1, {static_cast<double>(number) / 8}};
        },
        [&](const Evaluation&, const Outcome& outcome) -> Result<void> {
          outcomes.push_back(outcome);
          return {};
        });
    return end ? "" : end.error();
  }
  static FakeWorkers::Fate answers(std::uint64_t /*number*/, int /*tried*/) { return FakeWorkers::Fate::answer; }

 private:
  std::vector<std::deque<RankMessages::Message>> queues_;
  FakeMessages messages_;
  Random random_{3, "steps"};

 public:
  FakeWorkers local{1};
  std::vector<std::unique_ptr<FakeRank>> ranks;
  RankWorkers workers;
  std::vector<Outcome> outcomes;
};

TEST(Ranks, OutcomesAreTheSameForAnyNumber) {
  for (const std::size_t size : {1u, 2u, 4u, 9u}) {
    Job job(size);
    EXPECT_EQ(job.run(60, Job::answers), "");
    expect_all(job.outcomes, 60);
    EXPECT_EQ(job.local.starts, 1);
    for (const auto& rank : job.ranks) EXPECT_EQ(rank->workers.starts, 1);
  }
}

TEST(Ranks, RepeatEvaluationsOfChildrenThatDieOrHang) {
  Job job(4);
  EXPECT_EQ(job.run(60,
                    [](std::uint64_t number, int tried) {
                      if (tried == 0 && number % 7 == 0) return FakeWorkers::Fate::crash;
                      return tried < 2 && number % 11 == 0 ? FakeWorkers::Fate::hang : FakeWorkers::Fate::answer;
                    }),
            "");
  expect_all(job.outcomes, 60);
}

TEST(Ranks, ErrorsNameTheRankAndItsHost) {
  Job job(3);
  job.ranks[1]->workers.fault = "/home/a/scene.lua not found";
  EXPECT_EQ(job.run(60, Job::answers), "rank 2 on node2: /home/a/scene.lua not found");
  Job other_scene(3);
  other_scene.ranks[0]->workers.scene.hash++;
  EXPECT_EQ(other_scene.run(60, Job::answers).find("rank 1 on node1: the scene is not the one"), 0u);
}

TEST(Ranks, OtherProgramsAreRejected) {
  Job job(3, "0.9");
  EXPECT_EQ(job.run(60, Job::answers),
            "rank 1 on node1: its limber is 0.9, that of rank 0 is 1.0; install the same one on all nodes");
}

TEST(Ranks, MessagesOfReplacedChildrenAreIgnored) {
  std::vector<std::deque<RankMessages::Message>> queues(2);
  FakeMessages messages(queues, 0);
  FakeMessages other(queues, 1);
  FakeWorkers local(1);
  RankWorkers workers(messages, local, "1.0");
  ASSERT_TRUE(workers.start(1).ok());
  ASSERT_TRUE(workers.start(1).ok());
  for (const std::uint64_t start : {1u, 2u}) {
    other.send(0, RankMessage{Kind::line, start, std::to_string(start)}.encode());
    other.send(0, RankMessage{Kind::ended, start, ""}.encode());
  }
  const std::vector<Workers::Event> events = workers.wait(std::chrono::microseconds(0));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].line, "2");
  EXPECT_FALSE(events[1].line.has_value());
}

TEST(Ranks, EndWithRankZero) {
  std::vector<std::deque<RankMessages::Message>> queues(2);
  FakeMessages messages(queues, 0);
  FakeWorkers local(1);
  FakeRank rank(queues, 1, "1.0");
  {
    RankWorkers workers(messages, local, "1.0");
    EXPECT_TRUE(rank.worker.step());
  }
  EXPECT_FALSE(rank.worker.step());
}

TEST(RankMessage, BytesGiveTheSameMessage) {
  for (const Kind kind : {Kind::hello, Kind::start, Kind::line, Kind::ended, Kind::quit}) {
    const RankMessage message{kind, 18446744073709551615u, std::string("a\n\0b", 4)};
    const std::optional<RankMessage> back = RankMessage::decode(message.encode());
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->kind, message.kind);
    EXPECT_EQ(back->start, message.start);
    EXPECT_EQ(back->text, message.text);
  }
  for (const char* wrong :
       {"", "\n", "l\n", "l1", "x1\n", "l-1\n", "l1 \n", "l18446744073709551616\n", "l1a\n", "l01\n", "l00\n"})
    EXPECT_FALSE(RankMessage::decode(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace limber::experiments::test
