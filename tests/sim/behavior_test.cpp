// Common features of behaviors: targets, start, intervals, random generator, errors, time.
#include "sim/behavior/behavior.h"

#include <algorithm>

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Behavior, TargetsAreInStreamOrderWithoutDuplicates) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base", "left", "right", "tip"});
  const auto parts = [&](Words words) {
    Probe& p = s.probe(body, "p", on_parts(std::move(words)));
    const Words names = names_in(p.parts());
    s.list().remove(p);
    return names;
  };
  EXPECT_EQ(parts({"tip", "base"}), (Words{"base", "tip"}));
  EXPECT_EQ(parts({"tip", "t*", "tip"}), (Words{"tip"}));
  EXPECT_EQ(parts({"{left,right}"}), (Words{"left", "right"}));
  EXPECT_EQ(parts({"none*"}), Words{});
  EXPECT_EQ(parts({}), Words{});
  Probe& all = s.probe(body, "all");
  EXPECT_EQ(names_in(all.parts()), (Words{"base", "left", "right", "tip"}));
  EXPECT_EQ(names_in(all.joints()), (Words{"to_left", "to_right", "to_tip"}));
  EXPECT_EQ(names_in(all.motors()), (Words{"to_left", "to_right", "to_tip"}));
}

TEST(Behavior, AllExcludesStaticParts) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base", "tip"}, 0);
  EXPECT_EQ(names_in(s.probe(body, "p").parts()), (Words{"tip"}));
  EXPECT_EQ(names_in(s.probe(body, "q", on_parts({"all"})).parts()), (Words{"tip"}));
  EXPECT_EQ(names_in(s.probe(body, "r", on_parts({"all", "base"})).parts()), (Words{"base", "tip"}));
  EXPECT_EQ(names_in(s.probe(body, "t", on_parts({"*"})).parts()), (Words{"base", "tip"}));
}

TEST(Behavior, StartsBeforeTheFirstStepAndAfterTargetsChange) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base"});
  s.probe(body, "all");
  s.probe(body, "named", on_parts({"base"}));
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::consume_calls(),
            (Words{"start b/all", "step b/all", "start b/named", "step b/named", "step b/all", "step b/named"}));
  ASSERT_TRUE(body.add_part("tip", s.shape(sphere_model(0.1)), 1, Pose{}).ok());
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"start b/all", "step b/all", "step b/named"}));
  body.recovery().reset();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"start b/all", "step b/all", "start b/named", "step b/named"}));
}

TEST(Behavior, DoesNotStepWhileInactiveOrBodyIsDisabled) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base"});
  Probe& p = s.probe(body, "p");
  s.set(p.id(), "active", {0});
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::consume_calls(), Words{});
  s.set(p.id(), "active", {1});
  body.set_enabled(false);
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::consume_calls(), Words{});
  body.set_enabled(true);
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"start b/p", "step b/p"}));
}

TEST(Behavior, ErrorSuspendsOnlyItAndIsReportedOnce) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base"});
  Probe& one = s.probe(body, "one");
  s.probe(body, "two");
  std::vector<std::string> reports;
  s.list().on_fault([&](const Behavior& b) { reports.push_back(b.name() + ": " + b.fault().file + " " + b.error()); });
  s.set(one.id(), "broken", {1});
  s.ticks(3);
  EXPECT_EQ(reports, (Words{"one: probe.lua it is broken"}));
  EXPECT_EQ(one.error(), "it is broken");
  EXPECT_EQ(one.fault().line, 7);
  EXPECT_TRUE(one.active());
  EXPECT_FALSE(one.runs());
  EXPECT_EQ(std::count(Probe::calls.begin(), Probe::calls.end(), "step b/two"), 3);
  // setting `active` to any value clears the error; start() isn't called again
  BehaviorRig::consume_calls();
  s.set(one.id(), "broken", {0});
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/two"}));
  s.set(one.id(), "active", {1});
  EXPECT_EQ(one.error(), "");
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/one", "step b/two"}));
}

// 250 ticks of 4 ms: an interval of 10 ms elapses 100 times, one shorter than a tick at every tick
TEST(Behavior, IntervalsUseSimulatedTimeWithoutDrift) {
  for (const auto& [interval, expected_count] : std::vector<std::pair<double, int>>{
           {10, 100}, {4, 250}, {0, 250}, {0.1, 250}, {4.1, 243}, {33, 31}, {500, 2}, {1000, 1}}) {
    BehaviorRig s;
    s.set(s.world.id(), "timestep", {0.004});
    Probe& p = s.probe(s.chain("b", {"base"}), "p");
    s.set(p.id(), "beat", {interval});
    s.ticks(250);
    EXPECT_EQ(p.elapsed_count, expected_count) << interval;
  }
}

TEST(Behavior, ChangedIntervalCountsFromTheLastElapsedTime) {
  BehaviorRig s;
  s.set(s.world.id(), "timestep", {0.01});
  Probe& p = s.probe(s.chain("b", {"base"}), "p");  // 100 ms: at 0, 100, 200 …
  s.ticks(15);                                      // 0 .. 140 ms
  EXPECT_EQ(p.elapsed_count, 2);
  s.set(p.id(), "beat", {30});  // counted from 100: elapsed at 130, then at 160, 190, 220
  s.ticks(1);
  EXPECT_EQ(p.elapsed_count, 3);
  s.ticks(1);  // 160
  EXPECT_EQ(p.elapsed_count, 4);
  s.ticks(3);  // .. 190
  EXPECT_EQ(p.elapsed_count, 5);
  s.set(p.id(), "beat", {1000});
  s.ticks(99);  // .. 1180; from 190 on: 1190
  EXPECT_EQ(p.elapsed_count, 5);
  s.ticks(1);
  EXPECT_EQ(p.elapsed_count, 6);
}

TEST(Behavior, RandomGeneratorDependsOnSeedAndPath) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  Probe& one = s.probe(a, "one");
  Probe& two = s.probe(b, "one");
  s.ticks(1);
  EXPECT_EQ(one.last, Random(1, "/physics/body/a/behavior/one").uniform());
  EXPECT_EQ(two.last, Random(1, "/physics/body/b/behavior/one").uniform());
  s.ticks(3);
  s.set(s.world.id(), "seed", {77});
  s.ticks(1);
  EXPECT_EQ(one.last, Random(77, "/physics/body/a/behavior/one").uniform());
  s.ticks(3);
  a.recovery().reset();
  s.ticks(1);
  EXPECT_EQ(one.last, Random(77, "/physics/body/a/behavior/one").uniform());
  EXPECT_NE(two.last, Random(77, "/physics/body/b/behavior/one").uniform());
}

TEST(Behavior, HashCoversParametersGeneratorAndTimers) {
  const auto hash = [](const std::function<void(BehaviorRig&, Probe&)>& change) {
    BehaviorRig s;
    Probe& p = s.probe(s.chain("b", {"base"}), "p");
    s.ticks(2);
    change(s, p);
    return s.world.state_hash();
  };
  const std::uint64_t plain = hash([](BehaviorRig&, Probe&) {});
  EXPECT_EQ(plain, hash([](BehaviorRig&, Probe&) {}));
  EXPECT_NE(plain, hash([](BehaviorRig& s, Probe& p) { s.set(p.id(), "amount", {3}); }));
  EXPECT_NE(plain, hash([](BehaviorRig& s, Probe& p) { s.set(p.id(), "active", {0}); }));
  EXPECT_NE(plain, hash([](BehaviorRig&, Probe& p) { p.random().next(); }));
  EXPECT_NE(plain, hash([](BehaviorRig& s, Probe& p) { s.list().remove(p); }));
}

TEST(Behavior, PublishesItsStepTime) {
  BehaviorRig s;
  Probe& p = s.probe(s.chain("b", {"base"}), "p");
  const TickTimes times = s.world.step();
  const double took = s.number(p.id(), "time");
  EXPECT_GT(took, 0);
  EXPECT_EQ(took, p.step_microseconds());
  EXPECT_GE(times.behaviors, 1e-6 * took);
}

}  // namespace
}  // namespace limber::sim
