// Undo and redo: what hands have set goes back and forth to the bit, in the steps in which a hand made it.
#include "engine/edits.h"

#include "base/log.h"
#include "engine/edited.h"
#include "engine/everything.h"

namespace limber::engine_test {
namespace {

constexpr const char* kEditScene = R"(
sim.gravity = vec3(0, 0, 0)
params { { "wind", 1, min = 0, max = 10 }, { "sun", 2, min = 0, max = 10 } }
local ball = sim:add_sphere_shape("ball", 0.05)
for i = 1, 3 do
  local body = sim:add_body("b" .. i)
  body:add_part("tip", ball, { position = vec3(i, 0, 1) })
end
sim:add_group_behavior("cohesion", "all", { bodies = "b*", amount = 0.5 })
osc:on("/storm", function(m) params.wind = 9; end)
osc:on("/spawn", function() local b = sim:body("b1"):copy("b4"); b.parts[1].mass = 7; params.wind = 3 end)
)";

struct Editing {
  Show show;
  explicit Editing(const SceneFile& file) : show(file.path()) {}

  // as another hand does: its port tells it
  template <class... A>
  void send_from(std::uint16_t port, std::string address, A&&... args) {
    show.link.inbox.push({{message(std::move(address), std::forward<A>(args)...)}, {Hand::osc, 0x7f000001, port}});
  }
  // from one hand, longer after what was before than a gesture lasts
  template <class... A>
  void set(std::string address, A&&... args) {
    rest();
    show.send(std::move(address), std::forward<A>(args)...);
    show.ticks(1);
  }
  void rest() { show.ticks(40); }
  std::string answer(const std::string& address) {
    show.outbox();
    show.send(address);
    show.ticks(1);
    const auto out = show.outbox();
    return out.empty() ? "" : out.front();
  }
  std::string text(const char* row) {
    const Place place = *find_place(show.engine.store(), fmt::format("/edit/{}", row));
    return std::string(place.row->say(show.engine.store().thing(place.node)));
  }
};

struct EditsTest : ::testing::Test {
  EditsTest() { log_to_stderr(false); }
  SceneFile file{kEditScene};
  Editing editing{file};
  Show& show = editing.show;
  double wind() { return show.read("/scene/wind"); }
};

TEST_F(EditsTest, GoBackAndForthToTheBit) {
  EXPECT_EQ(editing.answer("/edit/undo"), "/error /edit/undo there is nothing to undo");
  editing.set("/scene/wind", 4.1);
  editing.set("/physics/body/b2/part/tip/mass", 0.3);
  editing.set("/scene/wind", 5.7);
  EXPECT_EQ(editing.text("undo_of"), "/scene/wind (127.0.0.1:4000)");
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 4.1);
  EXPECT_EQ(editing.text("redo_of"), "/scene/wind (127.0.0.1:4000)");
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b2/part/tip/mass (127.0.0.1:4000)");
  const double mass = show.engine.world().find_body("b1")->find_part("tip")->mass();
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(show.read("/physics/body/b2/part/tip/mass"), mass);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(editing.answer("/edit/undo"), "/error /edit/undo there is nothing to undo");
  for (int i = 0; i < 3; i++) EXPECT_EQ(editing.answer("/edit/redo"), "");
  EXPECT_EQ(wind(), 5.7);
  EXPECT_EQ(show.read("/physics/body/b2/part/tip/mass"), 0.3);
  EXPECT_EQ(editing.answer("/edit/redo"), "/error /edit/redo there is nothing to redo");
}

TEST_F(EditsTest, AnotherStepEndsWhatCouldBeDoneAgain) {
  editing.set("/scene/wind", 4);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  editing.set("/scene/sun", 2);  // as it is: no step
  EXPECT_EQ(editing.text("redo_of"), "/scene/wind (127.0.0.1:4000)");
  editing.set("/scene/sun", 3);
  EXPECT_EQ(editing.answer("/edit/redo"), "/error /edit/redo there is nothing to redo");
  EXPECT_EQ(wind(), 1);
}

TEST_F(EditsTest, AGestureIsOneStepAndSoIsABurst) {
  editing.rest();
  for (int i = 0; i < 50; i++) {
    show.send("/scene/wind", 2 + 0.1 * i);
    show.ticks(1);
  }
  editing.rest();
  for (int i = 1; i <= 3; i++) show.send(fmt::format("/physics/body/b{}/part/tip/mass", i), 2);  // in one tick
  show.ticks(1);
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (127.0.0.1:4000)");
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  for (int i = 1; i <= 3; i++) EXPECT_NE(show.read(fmt::format("/physics/body/b{}/part/tip/mass", i)), 2);
  EXPECT_EQ(wind(), 2 + 0.1 * 49);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 1) << "all of the gesture";
}

TEST_F(EditsTest, WhileTimeStandsStillEachValueIsAStep) {
  editing.rest();
  show.send("/transport/pause");
  show.ticks(1);
  show.send("/scene/wind", 4);
  show.ticks(1);
  show.send("/scene/sun", 5);
  show.ticks(1);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 4);
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(EditsTest, WhatAnotherHandGoesOnWithIsPassedOver) {
  editing.set("/scene/wind", 4);
  for (int i = 0; i < 60; i++) {
    editing.send_from(5000, "/scene/sun", 0.1 * i);
    show.ticks(1);
  }
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(show.read("/scene/sun"), 0.1 * 59);
  editing.rest();
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(EditsTest, AGroupsMembersGetTheirOwnBack) {
  editing.set("/physics/body/b2/behavior/all/amount", 0.7);
  editing.set("/physics/group/all/amount", 0.9);
  for (int i = 1; i <= 3; i++) EXPECT_EQ(show.read(fmt::format("/physics/body/b{}/behavior/all/amount", i)), 0.9);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(show.read("/physics/body/b1/behavior/all/amount"), 0.5);
  EXPECT_EQ(show.read("/physics/body/b2/behavior/all/amount"), 0.7);
  EXPECT_EQ(show.read("/physics/group/all/amount"), 0.5);
  EXPECT_EQ(editing.answer("/edit/redo"), "");
  for (int i = 1; i <= 3; i++) EXPECT_EQ(show.read(fmt::format("/physics/body/b{}/behavior/all/amount", i)), 0.9);
}

TEST_F(EditsTest, HandlersAreOfTheHandThatSentTheirMessageAndThingsTheyMakeAreNoEdits) {
  editing.set("/storm");
  EXPECT_EQ(wind(), 9);
  editing.set("/spawn");
  EXPECT_EQ(show.read("/physics/body/b4/part/tip/mass"), 7);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 9);
  EXPECT_EQ(show.read("/physics/body/b4/part/tip/mass"), 7);
  editing.set("/physics/body/b4/part/tip/mass", 8);
  show.send("/scene/sun", 7);
  show.ticks(1);
  show.engine.world().remove_body(*show.engine.world().find_body("b4"));
  EXPECT_EQ(editing.answer("/edit/undo"), "") << "what has gone is left out";
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(EditsTest, AResetKeepsWhatIsInForceAndSteps) {
  editing.set("/scene/wind", 4);
  editing.set("/scene/wind", 5);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 4) << "what was undone does not come back";
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(editing.answer("/edit/redo"), "");
  EXPECT_EQ(editing.answer("/edit/redo"), "");
  EXPECT_EQ(wind(), 5);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 5);
}

TEST_F(EditsTest, ARecallIsOneStepAndAMorphIsTakenBackToWhereItBegan) {
  editing.set("/scene/wind", 4);
  editing.set("/preset/store", "calm");
  editing.set("/scene/wind", 8);
  editing.set("/scene/sun", 9);
  editing.set("/preset/recall", "calm");
  EXPECT_EQ(wind(), 4);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 8);
  EXPECT_EQ(show.read("/scene/sun"), 9);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 8) << "the recall was undone";
  editing.set("/preset/recall", "calm", 2.0);
  show.ticks(60);
  EXPECT_LT(wind(), 8);
  EXPECT_GT(wind(), 4);
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_EQ(wind(), 8);
  show.ticks(120);
  EXPECT_EQ(wind(), 8) << "undo is a hand: the morph lets go";
  EXPECT_EQ(show.read("/scene/sun"), 9);
}

TEST_F(EditsTest, ALineOfTheConsoleIsAStepAndAFailingOneIsNone) {
  const auto say = [&](const char* text) {
    editing.rest();
    show.link.inbox.push({{}, {Hand::console}, std::make_shared<const Evaluate>(Evaluate{Evaluate::Wish::run, text})});
    show.ticks(1);
  };
  say("for b in sim:bodies('b*') do b.parts[1].mass = 5 end");
  EXPECT_EQ(show.read("/physics/body/b3/part/tip/mass"), 5);
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (console)");
  say("params.wind = 9; error('no')");
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (console)");
  EXPECT_EQ(editing.answer("/edit/undo"), "");
  EXPECT_NE(show.read("/physics/body/b3/part/tip/mass"), 5);
}

// each sets one property at random
std::vector<Message> messages_at_random(const Store& store, Random& random, int count) {
  std::vector<std::pair<NodeId, const Row*>> all;
  store.walk(store.root(), [&](NodeId id) {
    for (const Row& row : store.table(id).rows()) {
      if (row.kind == RowKind::property && row.stored()) all.emplace_back(id, &row);
    }
  });
  std::vector<Message> messages;
  for (int i = 0; i < count; i++) {
    const auto [id, row] = all[static_cast<std::size_t>(random.uniform(0, static_cast<double>(all.size())))];
    Message m{fmt::format("{}/{}", store.path(id), row->name), {}};
    for (std::uint32_t k = 0; k < row->width; k++)
      m.args.push_back(Arg::of(random.uniform(std::max(row->low(k), -50.0), std::min(row->high(k), 50.0))));
    messages.push_back(std::move(m));
  }
  return messages;
}

TEST(Edits, AnyOrderOfHandsAndUndosComesBackToTheBit) {
  Edited edited(kEverything);
  Show& show = edited.show();
  Random random(7, "edits");
  const auto kept = [&] {
    const auto values = show.engine.store().kept();
    return std::vector<double>(values.begin(), values.end());
  };
  // while time stands still nothing but hands sets anything
  show.send("/transport/pause");
  show.ticks(2);
  std::vector<std::vector<double>> states{kept()};
  const std::vector<Message> messages = messages_at_random(show.engine.store(), random, 200);
  for (const Message& m : messages) {
    show.link.inbox.push({{m}, {Hand::osc, 0x7f000001, static_cast<std::uint16_t>(states.size())}});
    show.ticks(1);
    if (kept() != states.back()) states.push_back(kept());
  }
  ASSERT_GT(states.size(), 100u);
  for (std::size_t i = states.size() - 1; i > 0; i--) {
    show.send("/edit/undo");
    show.ticks(1);
    ASSERT_EQ(kept(), states[i - 1]) << i;
  }
  for (std::size_t i = 1; i < states.size(); i++) {
    show.send("/edit/redo");
    show.ticks(1);
    ASSERT_EQ(kept(), states[i]) << i;
  }
}

TEST(Edits, TheOldestStepsGo) {
  const SceneFile file(kEditScene);
  Editing editing(file);
  editing.show.send("/transport/pause");
  editing.show.ticks(1);
  for (std::size_t i = 0; i < Edits::kMostSteps + 10; i++) {
    editing.send_from(static_cast<std::uint16_t>(1 + i), "/scene/wind", i % 2 == 0 ? 0.0 : 10.0);
    editing.show.ticks(1);
  }
  std::size_t undone = 0;
  while (editing.answer("/edit/undo").empty()) undone++;
  EXPECT_EQ(undone, Edits::kMostSteps);
}

// one hand, always the same value, and things that come and go: one step that goes on for as long as the show does
TEST(Edits, AHandThatNeverPausesForgetsWhatHasGone) {
  static const Row& gravity = World::table().at("gravity");
  static const Row& collides = Body::table().at("self_collision");
  Store store;
  World world(store);
  PerformerHand hand;
  Edits edits(hand);
  const auto set = [&](NodeId id, const Row& row, std::vector<double> values) {
    const std::vector<double> before(store.values(id, row), store.values(id, row) + row.width);
    ASSERT_TRUE(store.set(id, row, values));
    edits.heard(store, id, row, false, before.data());
  };
  Body* const stays = *world.add_body("stays");
  std::size_t most = 0;
  for (int round = 0; round < 5000; round++) {
    Body* const guest = *world.add_body("guest");
    edits.begin({Hand::osc, 0x7f000001, 4000}, world);
    set(world.id(), gravity, {0, 0, -1.0 - round % 7});
    if (round == 2500) set(stays->id(), collides, {0});
    set(guest->id(), collides, {0});
    edits.end(store);
    most = std::max(most, edits.memory()->size());
    world.remove_body(*guest);
  }
  EXPECT_LT(most, 10000u) << "5000 guests take 80000 bytes";
  ASSERT_TRUE(edits.undo(world));
  EXPECT_EQ(store.values(world.id(), gravity)[2], -9.81);
  EXPECT_EQ(store.values(stays->id(), collides)[0], 1);
  EXPECT_FALSE(edits.undo(world)) << "it is one step";
  ASSERT_TRUE(edits.redo(world));
  EXPECT_EQ(store.values(world.id(), gravity)[2], -1.0 - 4999 % 7);
  EXPECT_EQ(store.values(stays->id(), collides)[0], 0);
}

}  // namespace
}  // namespace limber::engine_test
