// Console evaluations in the engine: a separate kind of command, executed between two ticks and answered at once.
#include <gtest/gtest.h>

#include <memory>

#include "base/log/log.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

using ResultKind = Evaluation::Kind;

/// Collects the results of evaluations.
struct EvaluationResults {
  std::vector<Evaluation> results;
  std::shared_ptr<EvaluationRequest> request(const std::string& text,
                                             EvaluationRequest::Action kind = EvaluationRequest::Action::run) {
    auto request = std::make_shared<EvaluationRequest>();
    request->action = kind;
    request->text = text;
    request->on_result = [this](Evaluation e) { results.push_back(std::move(e)); };
    return request;
  }
};

struct EvaluateTest : testing::Test {
  EvaluateTest() { log_to_stderr(false); }
  ~EvaluateTest() override { log_to_stderr(true); }

  void push(Show& show, const std::string& text, EvaluationRequest::Action kind = EvaluationRequest::Action::run) {
    show.link.command_queue.push({{}, {CommandSource::console}, results.request(text, kind)});
  }
  std::string text(std::size_t i) { return i < results.results.size() ? results.results[i].text : "not answered"; }

  EvaluationResults results;
};

TEST_F(EvaluateTest, RunsBeforeTheTickInOrderOfArrival) {
  const SceneFile scene("state.n = 1  sim:on_step(function() seen = state.n end)");
  Show show(scene.path());
  push(show, "state.n = state.n * 10");
  push(show, "state.n = state.n + 1");
  push(show, "sim.tick");
  EXPECT_TRUE(results.results.empty()) << "it is not executed before a tick";
  show.ticks(1);
  ASSERT_EQ(results.results.size(), 3U);
  EXPECT_EQ(results.results[0].kind, ResultKind::done);
  EXPECT_EQ(text(2), "0");
  push(show, "seen, sim.tick");
  show.ticks(1);
  EXPECT_EQ(text(3), "11\t1") << "the tick's callbacks see the earlier evaluations";
}

TEST_F(EvaluateTest, RunsWhilePaused) {
  const SceneFile scene("ball = sim:add_body('b'):add_part('p', sim:add_sphere_shape('s', 1))");
  Show show(scene.path());
  show.send("/transport/pause");
  show.ticks(1);
  push(show, "ball.position = vec3(0, 0, 4)");
  push(show, "sim.tick");
  show.ticks(1);
  EXPECT_EQ(text(1), "0");
  EXPECT_EQ(show.read("/physics/body/b/part/p/position", 2), 4);
}

TEST_F(EvaluateTest, MistypedTextIsNotAFaultOfTheShow) {
  const SceneFile scene("x = 1");
  EngineOptions options = fast_options(scene.path());
  options.strict = true;
  Show show(options);
  const std::uint64_t errors = log_count(LogLevel::error);
  push(show, "nothing.at.all");
  show.ticks(1);
  ASSERT_EQ(results.results.size(), 1U);
  EXPECT_EQ(results.results[0].kind, ResultKind::error);
  EXPECT_EQ(show.engine.faults(), 0U);
  EXPECT_EQ(log_count(LogLevel::error), errors);
  EXPECT_TRUE(show.sent_texts().empty()) << "it is not sent to the network";
}

TEST_F(EvaluateTest, AStoppedEvaluationDoesNotAffectTheNext) {
  const SceneFile scene("n = 1");
  Show show(scene.path());
  push(show, "while true do end");
  push(show, "n + 1");
  push(show, "('abc'):gsub('b', 'x')");
  show.ticks(1);
  ASSERT_EQ(results.results.size(), 3U);
  EXPECT_EQ(results.results[0].kind, ResultKind::error);
  EXPECT_EQ(text(1), "2");
  EXPECT_EQ(text(2), "axc\t1");
}

TEST_F(EvaluateTest, ReportsTheRangeOfItsOutputInTheLog) {
  const SceneFile scene("sim:on_step(function() print('tick') end)");
  EngineOptions options = fast_options(scene.path());
  options.print = false;
  Show show(options);
  testing::internal::CaptureStderr();
  const std::uint64_t start = log_newest();
  push(show, "print('one') print('two')");
  show.ticks(1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "one\ntwo\ntick\n");
  ASSERT_EQ(results.results.size(), 1U);
  EXPECT_EQ(results.results[0].log_before, start);
  EXPECT_EQ(results.results[0].log_after, start + 2);
  const std::vector<LogLine> lines = log_since(start);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].text, "two");
  EXPECT_EQ(lines[2].text, "tick");
  EXPECT_EQ(lines[2].level, LogLevel::print);
}

TEST_F(EvaluateTest, CompletesAndReportsErrors) {
  const SceneFile scene("apple = 1");
  Show show(scene.path());
  push(show, "return app", EvaluationRequest::Action::complete);
  push(show, std::string(kMaxEvaluatedBytes + 1, 'x'));
  show.ticks(1);
  EXPECT_EQ(text(0), "apple");
  EXPECT_EQ(results.results[0].word, 3U);
  EXPECT_EQ(text(1), "the text must have at most 65536 bytes, got 65537");
  Show empty;
  push(empty, "1");
  empty.ticks(1);
  EXPECT_EQ(text(2), "there is no scene to evaluate in");
}

TEST_F(EvaluateTest, CantBeRequestedByMessage) {
  const SceneFile scene("apple = 1");
  Show show(scene.path());
  for (const char* address : {"/evaluate", "/console/evaluate", "/script/evaluate"}) {
    show.link.command_queue.push({{message(address, "apple = 2")}, {CommandSource::console}});
    show.send(address, "apple = 2");
  }
  show.ticks(1);
  push(show, "apple");
  show.ticks(1);
  EXPECT_EQ(text(0), "1");
}

TEST_F(EvaluateTest, EqualEvaluationsAtEqualTicksGiveEqualRuns) {
  const SceneFile scene("ball = sim:add_body('b'):add_part('p', sim:add_sphere_shape('s', 1))");
  const auto run = [&](const char* text) {
    Show show(scene.path());
    show.ticks(10);
    push(show, text);
    show.ticks(50);
    return show.engine.state_hash();
  };
  const std::uint64_t once = run("ball:apply_impulse(rng:direction())");
  EXPECT_EQ(run("ball:apply_impulse(rng:direction())"), once);
  EXPECT_NE(run("ball:apply_impulse(2 * rng:direction())"), once);
  EXPECT_EQ(run("ball.mass"), run("sim.time")) << "a completion changes nothing";
}

TEST_F(EvaluateTest, ALongTextCountsWithItsSize) {
  const std::size_t light = weight_of(Command{});
  Command heavy;
  heavy.evaluation = results.request(std::string(5000, 'x'));
  EXPECT_GE(weight_of(heavy), light + 5000);
}

}  // namespace
}  // namespace limber::engine::test
