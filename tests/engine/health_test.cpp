// Health: each kind of loss is provoked and read with /list/health.
#include "engine/output/health.h"

#include <gtest/gtest.h>

#include <map>

#include "base/log/log.h"
#include "engine/clock.h"
#include "engine/recovery/recovery_saver.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

std::int64_t now_at = 0;
std::int64_t test_clock() { return now_at; }

// the answer to /list/health: the count of each entry
std::map<std::string, double> losses(Show& show) {
  std::vector<Outgoing> out;
  show.link.output_queue.drain(out);
  show.ticks(16);  // some counters are read every 16 passes
  show.send("/list/health");
  show.ticks(1);
  show.link.output_queue.drain(out);
  std::map<std::string, double> list;
  for (const Outgoing& o : out) {
    if (o.message.address != "/list/health") continue;
    for (std::size_t i = 0; i + 2 < o.message.args.size(); i += 3) {
      list[o.message.args[i].text] = o.message.args[i + 1].number;
      EXPECT_GE(o.message.args[i + 2].number, 0) << "seconds ago";
    }
  }
  return list;
}

using Losses = std::map<std::string, double>;

TEST(Health, SinceIsTheTimeWhenACountLeftZero) {
  Health health(&test_clock);
  EXPECT_TRUE(health.healthy());
  EXPECT_EQ(health.text(), "");
  now_at = 100;
  health.add(HealthItem::dropped, 2);
  now_at = 160;
  health.add(HealthItem::dropped);
  health.set(HealthItem::handlers, 1);
  now_at = 200;
  const std::vector<HealthEntry> entries = health.entries();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].count, 3u);
  EXPECT_EQ(entries[0].since, 100);
  EXPECT_EQ(entries[1].since, 160);
  EXPECT_EQ(health.text(), "dropped 3 since " + time_of_day(100) + ", handlers 1 since " + time_of_day(160));
  EXPECT_EQ(text_of(health.answer_message("/list/health")), "/list/health dropped 3 100 handlers 1 40");
  health.set(HealthItem::handlers, 0);
  EXPECT_EQ(health.entries().size(), 1u) << "the handler is fixed";
  health.set(HealthItem::handlers, 2);
  EXPECT_EQ(health.entries()[1].since, 200);
}

TEST(Health, EveryItemHasANameAndADescription) {
  Health health;
  for (std::size_t i = 0; i < Health::kItems; i++) health.add(static_cast<HealthItem>(i));
  std::map<std::string, int> names;
  for (const HealthEntry& entry : health.entries()) {
    names[entry.name]++;
    EXPECT_GT(std::string(entry.doc).size(), 10u) << entry.name;
  }
  EXPECT_EQ(names.size(), Health::kItems);
}

TEST(Health, AHealthyShowHasNoEntries) {
  Show show;
  show.sent_texts();
  EXPECT_EQ(losses(show), Losses{});
  show.send("/list/health");
  show.send("/get", "/transport/health");
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), (std::vector<std::string>{"/list/health ", "/transport/health "}));
  show.send("/list/health", 1);
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), std::vector<std::string>{"/error /list/health takes no arguments"});
}

TEST(Health, IncludesTheMessageCounters) {
  Show show;
  show.link.counters.dropped = 3;
  show.link.counters.dropped_kernel = 5;
  show.link.counters.unheard = 7;
  EXPECT_EQ(losses(show), (Losses{{"dropped", 3}, {"dropped_kernel", 5}, {"unheard", 7}}));
  show.send("/get", "/transport/health");
  show.ticks(1);
  const std::string text = show.sent_texts().back();
  EXPECT_TRUE(text.starts_with("/transport/health dropped 3 since ")) << text;
}

TEST(Health, CountsOvertakenRequests) {
  Show show;
  show.send("/transport/play");
  show.send("/transport/panic");
  show.ticks(1);
  EXPECT_EQ(losses(show)["discarded"], 1);
}

TEST(Health, CountsDroppedAnswers) {
  Show show;
  while (show.link.output_queue.push({Outgoing::Destination::targets, {}, {"/filler", {}}})) continue;
  EXPECT_EQ(losses(show), (Losses{{"unanswered", 1}}));
}

TEST(Health, CountsDisabledHandlersUntilTheyAreFixed) {
  const SceneFile file("osc:on('/go', function() error('no') end)");
  Show show(file.path());
  show.send("/go");
  show.ticks(1);
  EXPECT_EQ(losses(show)["handlers"], 1);
  file.write("osc:on('/go', function() end)");
  show.send("/transport/reset");
  show.ticks(1);
  EXPECT_EQ(losses(show)["handlers"], 0);
}

/// Fails at each step.
class FailingBehavior : public sim::Behavior {
 public:
  void step(double) override { fail({"on purpose", "", 0}); }
};

constexpr const char* kTwoBodies = R"(
for i = 1, 2 do
  local body = sim:add_body("b" .. i)
  body:add_part("p", sim:add_sphere_shape("s" .. i, 0.1), { mass = 1, position = vec3(i, 0, 9) })
end
)";

TEST(Health, CountsSuspendedBehaviorsIncludingGroups) {
  const SceneFile file(kTwoBodies);
  Show show(file.path());
  sim::World& world = show.engine.world();
  sim::BehaviorTypes& types = world.behaviors().types();
  ASSERT_TRUE(
      types.add(sim::BehaviorType::create<FailingBehavior>("fails", "Fails.", sim::BehaviorTargets::any, {})).ok());
  ASSERT_TRUE(types.add(sim::BehaviorType::create_group<FailingBehavior>("all_fail", "Fail.", {})).ok());
  ASSERT_TRUE(world.behaviors().add(*world.find_body("b1"), "fails", "one").ok());
  sim::GroupSetup all;
  all.bodies = sim::Selection(std::vector<std::string>{"*"});
  const Result<sim::BehaviorGroup*> group = world.behaviors().add_group("all_fail", "all", all);
  ASSERT_TRUE(group.ok()) << group.error();
  EXPECT_EQ(losses(show)["behaviors"], 3);
  world.behaviors().remove(*world.behaviors().find_group("all"));
  EXPECT_EQ(losses(show)["behaviors"], 1);
}

TEST(Health, CountsStoppedCalls) {
  const SceneFile file("osc:on('/long', function() while true do end end)");
  EngineOptions options = fast_options(file.path());
  options.scene_options.limits.call_ms = 5;
  Show show(std::move(options));
  show.send("/long");
  show.ticks(1);
  EXPECT_EQ(losses(show)["stopped"], 1);
}

TEST(Health, CountsUnstableBodies) {
  const SceneFile file(R"(
    local part = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("ball", 0.1), { mass = 1 })
    osc:on("/far", function() part.position = vec3(1e6, 0, 0) end))");
  Show show(file.path());
  show.ticks(1);
  show.send("/far");
  show.ticks(2);
  EXPECT_EQ(losses(show)["bodies"], 1);
}

TEST(Health, CountsSuppressedLogLines) {
  Show show;
  log_to_stderr(true);  // other tests silence it
  log_forget_sources();
  for (int i = 0; i < 14; i++) log_warning("this warning repeats itself for a test of health");
  EXPECT_GE(losses(show)["log"], 4) << "ten of one source are written at most";
}

TEST(Health, CountsFailedWrites) {
  const SceneFile file("");
  Show show(file.path());
  const std::filesystem::path presets = PresetFile::path_for(file.path());
  std::filesystem::create_directories(presets / "in the way");
  show.send("/preset/store", "dusk");
  show.ticks(1);
  show.engine.finish_saving();
  EXPECT_EQ(losses(show)["files"], 1);
}

TEST(Health, ReportsThatAnotherProgramOwnsTheScene) {
  const SceneFile file("");
  EngineOptions options = fast_options(file.path());
  options.recovery.folder = file.path() + ".recovery";
  BackgroundWriter writer;
  RecoverySaver other(writer, options.recovery.folder);
  ASSERT_TRUE(other.open(file.path()).ok());
  ASSERT_TRUE(other.owned());
  Show show(std::move(options));
  EXPECT_EQ(losses(show)["not_owned"], 1);
}

TEST(Health, LateCountsSkippedDelays) {
  Clock clock;
  Clock::Time at{};
  clock.restart(at);
  clock.tick(at, 0.01, 1);
  at += std::chrono::milliseconds(200);
  clock.tick(at, 0.01, 1);
  EXPECT_EQ(clock.stalls(), 0u) << "caught up with";
  at += std::chrono::milliseconds(300);
  clock.tick(at, 0.01, 1);
  EXPECT_EQ(clock.stalls(), 1u);
}

}  // namespace
}  // namespace limber::engine::test
