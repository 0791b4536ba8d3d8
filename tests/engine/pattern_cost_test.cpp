// No message delays a tick: patterns that need too much work are rejected as a whole, in any kind of message.
#include "engine/rig.h"

namespace limber::engine::test {
namespace {

using Kind = Outcome::Kind;

// six hundred bodies with names that make patterns backtrack
struct ManyBodies : Rig {
  ManyBodies() {
    const sim::Shape& shape = *world.shapes().find("ball");
    for (int i = 0; i < 600; i++) {
      sim::Body& body = **world.add_body(fmt::format("{}{}", std::string(60, 'a'), i));
      EXPECT_TRUE(body.add_part("tip", const_cast<sim::Shape&>(shape), 1, Pose{{1.0 * i, 5, 5}, quat_identity()}).ok());
    }
  }
};

const std::string kCostlyPattern = "*a*a*a*a*a*a*b";

TEST(PatternCost, TooMuchWorkIsRejectedAsAWhole) {
  ManyBodies many_bodies;
  ASSERT_TRUE(many_bodies.world.behaviors().add(**many_bodies.world.bodies().begin(), "force", "push").ok());
  const std::vector<double> before = many_bodies.everything();
  std::string deep;
  for (int i = 0; i < 40; i++) deep += "//*" + kCostlyPattern;
  const Message costly[] = {message("/physics/body/" + kCostlyPattern + "/part/tip/mass", 2),
                            message("/physics/body/*/part/" + std::string(90, '*') + kCostlyPattern + "/mass", 2),
                            message(deep + "/mass", 2),
                            message("/physics/part/mass", kCostlyPattern, 2),
                            message("/physics/part/mass", "*", kCostlyPattern + "?", 2),
                            message("/physics/behavior/parameter", kCostlyPattern, "push", "amp", 2),
                            message("/get", "/physics/body/" + kCostlyPattern + "/part/tip/mass")};
  for (const Message& m : costly) {
    SCOPED_TRACE(m.address.substr(0, 80));
    many_bodies.dispatcher.begin_pass();
    const Outcome outcome = many_bodies.dispatcher.execute(m);
    // a pattern of stars that matches at once is cheap and accepted
    if (outcome.kind == Kind::rejected) continue;
    ADD_FAILURE() << "it was not rejected: " << outcome.error;
  }
  EXPECT_EQ(many_bodies.everything(), before);
}

TEST(PatternCost, AllPatternsOfATickShareABudget) {
  ManyBodies many_bodies;
  const Message costly = message("/physics/body/" + kCostlyPattern + "/part/tip/mass", 2);
  const Message cheap = message("/physics/body/*/part/tip/mass", 2);
  many_bodies.dispatcher.begin_pass();
  EXPECT_EQ(many_bodies.dispatcher.execute(cheap).kind, Kind::applied);
  // four of them use up the budget of a tick
  for (int i = 0; i < 5; i++) EXPECT_NE(many_bodies.dispatcher.execute(costly).kind, Kind::applied);
  EXPECT_EQ(many_bodies.dispatcher.execute(cheap).kind, Kind::rejected);
  // plain paths are not delayed, and the next tick has a new budget
  EXPECT_EQ(many_bodies.dispatcher.execute(message("/physics/sim/gravity", -1)).kind, Kind::applied);
  EXPECT_EQ(many_bodies.dispatcher.execute(message("/physics/body/arm/part/tip/mass", 3)).kind, Kind::applied);
  many_bodies.dispatcher.begin_pass();
  EXPECT_EQ(many_bodies.dispatcher.execute(cheap).kind, Kind::applied);
  EXPECT_EQ(many_bodies.read("/physics/body/arm/part/tip/mass").at(0), 2);
}

TEST(PatternCost, OnePatternMatchesAThousandBodies) {
  ManyBodies many_bodies;
  for (const char* pattern : {"/physics/body/*/part/*/mass", "/physics/body//mass", "//part/t?p/mass", "//mass"}) {
    many_bodies.dispatcher.begin_pass();
    const Outcome outcome = many_bodies.dispatcher.execute(message(pattern, 2.5));
    EXPECT_EQ(outcome.kind, Kind::applied) << pattern << ": " << outcome.error;
  }
  const std::string last = fmt::format("/physics/body/{}{}/part/tip/mass", std::string(60, 'a'), 599);
  EXPECT_EQ(many_bodies.read(last).at(0), 2.5);
}

}  // namespace
}  // namespace limber::engine::test
