// No message holds up a tick: patterns that would be too much work are refused whole, whatever they stand in.
#include "engine/rig.h"

namespace limber::engine_test {
namespace {

using Kind = Outcome::Kind;

// six hundred bodies whose names make patterns try and try again
struct Crowd : Rig {
  Crowd() {
    const Shape& shape = *world.find_shape("ball");
    for (int i = 0; i < 600; i++) {
      Body& body = **world.add_body(fmt::format("{}{}", std::string(60, 'a'), i));
      EXPECT_TRUE(body.add_part("tip", const_cast<Shape&>(shape), 1, Pose{{1.0 * i, 5, 5}, quat_identity()}).ok());
    }
  }
};

const std::string kEvil = "*a*a*a*a*a*a*b";

TEST(PatternCost, WhatIsTooMuchWorkIsRefusedWhole) {
  Crowd crowd;
  ASSERT_TRUE(crowd.world.behaviors().add(**crowd.world.bodies().begin(), "force", "push").ok());
  const std::vector<double> before = crowd.everything();
  std::string deep;
  for (int i = 0; i < 40; i++) deep += "//*" + kEvil;
  const Message costly[] = {message("/physics/body/" + kEvil + "/part/tip/mass", 2),
                            message("/physics/body/*/part/" + std::string(90, '*') + kEvil + "/mass", 2),
                            message(deep + "/mass", 2),
                            message("/physics/part/mass", kEvil, 2),
                            message("/physics/part/mass", "*", kEvil + "?", 2),
                            message("/physics/behavior/parameter", kEvil, "push", "amp", 2),
                            message("/get", "/physics/body/" + kEvil + "/part/tip/mass")};
  for (const Message& m : costly) {
    SCOPED_TRACE(m.address.substr(0, 80));
    crowd.dispatch.begin_tick();
    const Outcome outcome = crowd.dispatch.execute(m);
    // a pattern of stars that matches at once is cheap, and right
    if (outcome.kind == Kind::refused) continue;
    ADD_FAILURE() << "it was not refused: " << outcome.error;
  }
  EXPECT_EQ(crowd.everything(), before);
}

TEST(PatternCost, AllPatternsOfATickShareABudget) {
  Crowd crowd;
  const Message evil = message("/physics/body/" + kEvil + "/part/tip/mass", 2);
  const Message cheap = message("/physics/body/*/part/tip/mass", 2);
  crowd.dispatch.begin_tick();
  EXPECT_EQ(crowd.dispatch.execute(cheap).kind, Kind::applied);
  // four of them use up what a tick has
  for (int i = 0; i < 5; i++) EXPECT_NE(crowd.dispatch.execute(evil).kind, Kind::applied);
  EXPECT_EQ(crowd.dispatch.execute(cheap).kind, Kind::refused);
  // what needs no search is not held up, and the next tick begins anew
  EXPECT_EQ(crowd.dispatch.execute(message("/physics/sim/gravity", -1)).kind, Kind::applied);
  EXPECT_EQ(crowd.dispatch.execute(message("/physics/body/arm/part/tip/mass", 3)).kind, Kind::applied);
  crowd.dispatch.begin_tick();
  EXPECT_EQ(crowd.dispatch.execute(cheap).kind, Kind::applied);
  EXPECT_EQ(crowd.read("/physics/body/arm/part/tip/mass").at(0), 2);
}

TEST(PatternCost, AShowOfAThousandIsReachedByOnePattern) {
  Crowd crowd;
  for (const char* pattern : {"/physics/body/*/part/*/mass", "/physics/body//mass", "//part/t?p/mass", "//mass"}) {
    crowd.dispatch.begin_tick();
    const Outcome outcome = crowd.dispatch.execute(message(pattern, 2.5));
    EXPECT_EQ(outcome.kind, Kind::applied) << pattern << ": " << outcome.error;
  }
  const std::string last = fmt::format("/physics/body/{}{}/part/tip/mass", std::string(60, 'a'), 599);
  EXPECT_EQ(crowd.read(last).at(0), 2.5);
}

}  // namespace
}  // namespace limber::engine_test
