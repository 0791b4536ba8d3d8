// Evaluations on their way through the engine: a command of its own kind, done between two ticks, answered at once.
#include <gtest/gtest.h>

#include <memory>

#include "base/log.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

using AnswerKind = Evaluation::Kind;

/// What was answered, and on which tick.
struct Answers {
  std::vector<Evaluation> said;
  std::shared_ptr<Evaluate> wish(const std::string& text, Evaluate::Wish kind = Evaluate::Wish::run) {
    auto wish = std::make_shared<Evaluate>();
    wish->wish = kind;
    wish->text = text;
    wish->answer = [this](Evaluation e) { said.push_back(std::move(e)); };
    return wish;
  }
};

struct EvaluateTest : testing::Test {
  EvaluateTest() { log_to_stderr(false); }
  ~EvaluateTest() override { log_to_stderr(true); }

  void push(Show& show, const std::string& text, Evaluate::Wish kind = Evaluate::Wish::run) {
    show.link.inbox.push({{}, {Hand::console}, answers.wish(text, kind)});
  }
  std::string text(std::size_t i) { return i < answers.said.size() ? answers.said[i].text : "not answered"; }

  Answers answers;
};

TEST_F(EvaluateTest, IsDoneBeforeTheTickInTheOrderOfArrival) {
  const SceneFile scene("state.n = 1  sim:on_step(function() seen = state.n end)");
  Show show(scene.path());
  push(show, "state.n = state.n * 10");
  push(show, "state.n = state.n + 1");
  push(show, "sim.tick");
  EXPECT_TRUE(answers.said.empty()) << "nothing happens while no tick comes";
  show.ticks(1);
  ASSERT_EQ(answers.said.size(), 3U);
  EXPECT_EQ(answers.said[0].kind, AnswerKind::done);
  EXPECT_EQ(text(2), "0");
  push(show, "seen, sim.tick");
  show.ticks(1);
  EXPECT_EQ(text(3), "11\t1") << "the tick's callbacks saw what was evaluated before them";
}

TEST_F(EvaluateTest, HappensWhileTimeStandsStill) {
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

TEST_F(EvaluateTest, MistypedTextIsNoFaultOfTheShow) {
  const SceneFile scene("x = 1");
  EngineOptions options = fast_options(scene.path());
  options.strict = true;
  Show show(options);
  const std::uint64_t errors = log_count(LogLevel::error);
  push(show, "nothing.at.all");
  show.ticks(1);
  ASSERT_EQ(answers.said.size(), 1U);
  EXPECT_EQ(answers.said[0].kind, AnswerKind::error);
  EXPECT_EQ(show.engine.faults(), 0U);
  EXPECT_EQ(log_count(LogLevel::error), errors);
  EXPECT_TRUE(show.outbox().empty()) << "nobody on the network hears of it";
}

TEST_F(EvaluateTest, OneThatWasStoppedCostsTheNextNothing) {
  const SceneFile scene("n = 1");
  Show show(scene.path());
  push(show, "while true do end");
  push(show, "n + 1");
  push(show, "('abc'):gsub('b', 'x')");
  show.ticks(1);
  ASSERT_EQ(answers.said.size(), 3U);
  EXPECT_EQ(answers.said[0].kind, AnswerKind::error);
  EXPECT_EQ(text(1), "2");
  EXPECT_EQ(text(2), "axc\t1");
}

TEST_F(EvaluateTest, WhatItPrintedCanBeToldApart) {
  const SceneFile scene("sim:on_step(function() print('tick') end)");
  EngineOptions options = fast_options(scene.path());
  options.print = false;
  Show show(options);
  testing::internal::CaptureStderr();
  const std::uint64_t start = log_newest();
  push(show, "print('one') print('two')");
  show.ticks(1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "one\ntwo\ntick\n");
  ASSERT_EQ(answers.said.size(), 1U);
  EXPECT_EQ(answers.said[0].log_before, start);
  EXPECT_EQ(answers.said[0].log_after, start + 2);
  const std::vector<LogLine> lines = log_since(start);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].text, "two");
  EXPECT_EQ(lines[2].text, "tick");
  EXPECT_EQ(lines[2].level, LogLevel::print);
}

TEST_F(EvaluateTest, CompletionAndRefusals) {
  const SceneFile scene("apple = 1");
  Show show(scene.path());
  push(show, "return app", Evaluate::Wish::complete);
  push(show, std::string(kMostEvaluated + 1, 'x'));
  show.ticks(1);
  EXPECT_EQ(text(0), "apple");
  EXPECT_EQ(answers.said[0].word, 3U);
  EXPECT_EQ(text(1), "a text for the scene has up to 65536 bytes, this one 65537");
  Show empty;
  push(empty, "1");
  empty.ticks(1);
  EXPECT_EQ(text(2), "there is no scene to evaluate in");
}

TEST_F(EvaluateTest, NoMessageMeansIt) {
  const SceneFile scene("apple = 1");
  Show show(scene.path());
  for (const char* address : {"/evaluate", "/console/evaluate", "/script/evaluate"}) {
    show.link.inbox.push({{message(address, "apple = 2")}, {Hand::console}});
    show.send(address, "apple = 2");
  }
  show.ticks(1);
  push(show, "apple");
  show.ticks(1);
  EXPECT_EQ(text(0), "1");
}

TEST_F(EvaluateTest, TheSameEvaluationsAtTheSameTicksGiveTheSameRun) {
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
  EXPECT_EQ(run("ball.mass"), run("sim.time")) << "to ask changes nothing";
}

TEST_F(EvaluateTest, ALongTextWeighsWhatItIs) {
  const std::size_t light = weight_of(Command{});
  Command heavy;
  heavy.evaluate = answers.wish(std::string(5000, 'x'));
  EXPECT_GE(weight_of(heavy), light + 5000);
}

}  // namespace
}  // namespace limber::engine_test
