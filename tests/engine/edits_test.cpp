// Undo and redo of the values that controllers set: restored to the bit, in the steps in which they were set.
#include "engine/edits/undo_stack.h"

#include "base/log/log.h"
#include "engine/edited.h"
#include "engine/everything.h"

namespace limber::engine::test {
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

struct EditFixture {
  Show show;
  explicit EditFixture(const SceneFile& file) : show(file.path()) {}

  // as another controller, with its own port
  template <class... A>
  void send_from(std::uint16_t port, std::string address, A&&... args) {
    show.link.command_queue.push(
        {{message(std::move(address), std::forward<A>(args)...)}, {CommandSource::osc, 0x7f000001, port}});
  }
  // from one controller, after the merge interval
  template <class... A>
  void set(std::string address, A&&... args) {
    pass_merge_interval();
    show.send(std::move(address), std::forward<A>(args)...);
    show.ticks(1);
  }
  void pass_merge_interval() { show.ticks(40); }
  std::string reply_to(const std::string& address) {
    show.sent_texts();
    show.send(address);
    show.ticks(1);
    const auto out = show.sent_texts();
    return out.empty() ? "" : out.front();
  }
  std::string text(const char* property) {
    const PropertyRef ref = *find_property(show.engine.store(), fmt::format("/edit/{}", property));
    return std::string(ref.property->read_text(show.engine.store().object(ref.node)));
  }
};

struct UndoStackTest : ::testing::Test {
  UndoStackTest() { log_to_stderr(false); }
  SceneFile file{kEditScene};
  EditFixture editing{file};
  Show& show = editing.show;
  double wind() { return show.read("/scene/wind"); }
};

TEST_F(UndoStackTest, UndoAndRedoRestoreExactValues) {
  EXPECT_EQ(editing.reply_to("/edit/undo"), "/error /edit/undo there is nothing to undo");
  editing.set("/scene/wind", 4.1);
  editing.set("/physics/body/b2/part/tip/mass", 0.3);
  editing.set("/scene/wind", 5.7);
  EXPECT_EQ(editing.text("undo_of"), "/scene/wind (127.0.0.1:4000)");
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 4.1);
  EXPECT_EQ(editing.text("redo_of"), "/scene/wind (127.0.0.1:4000)");
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b2/part/tip/mass (127.0.0.1:4000)");
  const double mass = show.engine.world().find_body("b1")->find_part("tip")->mass();
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(show.read("/physics/body/b2/part/tip/mass"), mass);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "/error /edit/undo there is nothing to undo");
  for (int i = 0; i < 3; i++) EXPECT_EQ(editing.reply_to("/edit/redo"), "");
  EXPECT_EQ(wind(), 5.7);
  EXPECT_EQ(show.read("/physics/body/b2/part/tip/mass"), 0.3);
  EXPECT_EQ(editing.reply_to("/edit/redo"), "/error /edit/redo there is nothing to redo");
}

TEST_F(UndoStackTest, ANewStepClearsTheRedoStack) {
  editing.set("/scene/wind", 4);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  editing.set("/scene/sun", 2);  // unchanged: no step
  EXPECT_EQ(editing.text("redo_of"), "/scene/wind (127.0.0.1:4000)");
  editing.set("/scene/sun", 3);
  EXPECT_EQ(editing.reply_to("/edit/redo"), "/error /edit/redo there is nothing to redo");
  EXPECT_EQ(wind(), 1);
}

TEST_F(UndoStackTest, AGestureOrABurstIsOneStep) {
  editing.pass_merge_interval();
  for (int i = 0; i < 50; i++) {
    show.send("/scene/wind", 2 + 0.1 * i);
    show.ticks(1);
  }
  editing.pass_merge_interval();
  for (int i = 1; i <= 3; i++) show.send(fmt::format("/physics/body/b{}/part/tip/mass", i), 2);  // in one tick
  show.ticks(1);
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (127.0.0.1:4000)");
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  for (int i = 1; i <= 3; i++) EXPECT_NE(show.read(fmt::format("/physics/body/b{}/part/tip/mass", i)), 2);
  EXPECT_EQ(wind(), 2 + 0.1 * 49);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 1) << "all of the gesture";
}

TEST_F(UndoStackTest, EachValueIsAStepWhilePaused) {
  editing.pass_merge_interval();
  show.send("/transport/pause");
  show.ticks(1);
  show.send("/scene/wind", 4);
  show.ticks(1);
  show.send("/scene/sun", 5);
  show.ticks(1);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 4);
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(UndoStackTest, SkipsAStepThatAnotherSourceExtends) {
  editing.set("/scene/wind", 4);
  for (int i = 0; i < 60; i++) {
    editing.send_from(5000, "/scene/sun", 0.1 * i);
    show.ticks(1);
  }
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(show.read("/scene/sun"), 0.1 * 59);
  editing.pass_merge_interval();
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(UndoStackTest, GroupMembersGetTheirOwnValuesBack) {
  editing.set("/physics/body/b2/behavior/all/amount", 0.7);
  editing.set("/physics/group/all/amount", 0.9);
  for (int i = 1; i <= 3; i++) EXPECT_EQ(show.read(fmt::format("/physics/body/b{}/behavior/all/amount", i)), 0.9);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(show.read("/physics/body/b1/behavior/all/amount"), 0.5);
  EXPECT_EQ(show.read("/physics/body/b2/behavior/all/amount"), 0.7);
  EXPECT_EQ(show.read("/physics/group/all/amount"), 0.5);
  EXPECT_EQ(editing.reply_to("/edit/redo"), "");
  for (int i = 1; i <= 3; i++) EXPECT_EQ(show.read(fmt::format("/physics/body/b{}/behavior/all/amount", i)), 0.9);
}

TEST_F(UndoStackTest, WritesOfHandlersBelongToTheSenderAndNewObjectsAreNoEdits) {
  editing.set("/storm");
  EXPECT_EQ(wind(), 9);
  editing.set("/spawn");
  EXPECT_EQ(show.read("/physics/body/b4/part/tip/mass"), 7);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 9);
  EXPECT_EQ(show.read("/physics/body/b4/part/tip/mass"), 7);
  editing.set("/physics/body/b4/part/tip/mass", 8);
  show.send("/scene/sun", 7);
  show.ticks(1);
  show.engine.world().remove_body(*show.engine.world().find_body("b4"));
  EXPECT_EQ(editing.reply_to("/edit/undo"), "") << "removed objects are skipped";
  EXPECT_EQ(show.read("/scene/sun"), 2);
}

TEST_F(UndoStackTest, AResetKeepsOverridesAndSteps) {
  editing.set("/scene/wind", 4);
  editing.set("/scene/wind", 5);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 4) << "undone values are not restored";
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 1);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 1);
  EXPECT_EQ(editing.reply_to("/edit/redo"), "");
  EXPECT_EQ(editing.reply_to("/edit/redo"), "");
  EXPECT_EQ(wind(), 5);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 5);
}

TEST_F(UndoStackTest, ARecallIsOneStepAndAMorphIsUndoneToItsStart) {
  editing.set("/scene/wind", 4);
  editing.set("/preset/store", "calm");
  editing.set("/scene/wind", 8);
  editing.set("/scene/sun", 9);
  editing.set("/preset/recall", "calm");
  EXPECT_EQ(wind(), 4);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 8);
  EXPECT_EQ(show.read("/scene/sun"), 9);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(wind(), 8) << "the recall was undone";
  editing.set("/preset/recall", "calm", 2.0);
  show.ticks(60);
  EXPECT_LT(wind(), 8);
  EXPECT_GT(wind(), 4);
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_EQ(wind(), 8);
  show.ticks(120);
  EXPECT_EQ(wind(), 8) << "undo is an edit: it releases the property from the morph";
  EXPECT_EQ(show.read("/scene/sun"), 9);
}

TEST_F(UndoStackTest, AConsoleLineIsAStepUnlessItFails) {
  const auto evaluate_line = [&](const char* text) {
    editing.pass_merge_interval();
    show.link.command_queue.push(
        {{},
         {CommandSource::console},
         std::make_shared<const EvaluationRequest>(EvaluationRequest{EvaluationRequest::Action::run, text})});
    show.ticks(1);
  };
  evaluate_line("for b in sim:bodies('b*') do b.parts[1].mass = 5 end");
  EXPECT_EQ(show.read("/physics/body/b3/part/tip/mass"), 5);
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (console)");
  evaluate_line("params.wind = 9; error('no')");
  EXPECT_EQ(editing.text("undo_of"), "/physics/body/b1/part/tip/mass and 2 more (console)");
  EXPECT_EQ(editing.reply_to("/edit/undo"), "");
  EXPECT_NE(show.read("/physics/body/b3/part/tip/mass"), 5);
}

// Returns messages that each set a random property to a random value.
std::vector<Message> messages_at_random(const Store& store, Random& random, int count) {
  std::vector<std::pair<NodeId, const Property*>> all;
  store.walk(store.root(), [&](NodeId id) {
    for (const Property& property : store.table(id).properties()) {
      if (property.kind == PropertyKind::setting && property.stored()) all.emplace_back(id, &property);
    }
  });
  std::vector<Message> messages;
  for (int i = 0; i < count; i++) {
    const auto [id, property] = all[static_cast<std::size_t>(random.uniform(0, static_cast<double>(all.size())))];
    Message m{fmt::format("{}/{}", store.path(id), property->name), {}};
    for (std::uint32_t k = 0; k < property->width; k++)
      m.args.push_back(Arg::of(random.uniform(std::max(property->low(k), -50.0), std::min(property->high(k), 50.0))));
    messages.push_back(std::move(m));
  }
  return messages;
}

TEST(UndoStack, RestoresExactValuesInAnyOrder) {
  EditedShow edited(kEverything);
  Show& show = edited.show();
  Random random(7, "edits");
  const auto current_values = [&] {
    const auto values = show.engine.store().persistent_values();
    return std::vector<double>(values.begin(), values.end());
  };
  // while paused only controllers set values
  show.send("/transport/pause");
  show.ticks(2);
  std::vector<std::vector<double>> states{current_values()};
  const std::vector<Message> messages = messages_at_random(show.engine.store(), random, 200);
  for (const Message& m : messages) {
    show.link.command_queue.push({{m}, {CommandSource::osc, 0x7f000001, static_cast<std::uint16_t>(states.size())}});
    show.ticks(1);
    if (current_values() != states.back()) states.push_back(current_values());
  }
  ASSERT_GT(states.size(), 100u);
  for (std::size_t i = states.size() - 1; i > 0; i--) {
    show.send("/edit/undo");
    show.ticks(1);
    ASSERT_EQ(current_values(), states[i - 1]) << i;
  }
  for (std::size_t i = 1; i < states.size(); i++) {
    show.send("/edit/redo");
    show.ticks(1);
    ASSERT_EQ(current_values(), states[i]) << i;
  }
}

TEST(UndoStack, DropsTheOldestSteps) {
  const SceneFile file(kEditScene);
  EditFixture editing(file);
  editing.show.send("/transport/pause");
  editing.show.ticks(1);
  for (std::size_t i = 0; i < UndoStack::kMaxSteps + 10; i++) {
    editing.send_from(static_cast<std::uint16_t>(1 + i), "/scene/wind", i % 2 == 0 ? 0.0 : 10.0);
    editing.show.ticks(1);
  }
  std::size_t undone = 0;
  while (editing.reply_to("/edit/undo").empty()) undone++;
  EXPECT_EQ(undone, UndoStack::kMaxSteps);
}

// one controller sets the same property of objects that are added and removed: one step that is extended forever
TEST(UndoStack, PurgesRemovedObjectsOfAnEndlessStep) {
  static const Property& gravity = sim::World::table().at("gravity");
  static const Property& collides = sim::Body::table().at("self_collision");
  Store store;
  sim::World world(store);
  Overrides overrides;
  UndoStack undo_stack(overrides);
  const auto set = [&](NodeId id, const Property& property, std::vector<double> values) {
    const std::vector<double> before(store.values(id, property), store.values(id, property) + property.width);
    ASSERT_TRUE(store.set(id, property, values));
    undo_stack.on_write(store, id, property, false, before.data());
  };
  sim::Body* const lasting = *world.add_body("stays");
  std::size_t max_size = 0;
  for (int round = 0; round < 5000; round++) {
    sim::Body* const temporary = *world.add_body("guest");
    undo_stack.begin({CommandSource::osc, 0x7f000001, 4000}, world);
    set(world.id(), gravity, {0, 0, -1.0 - round % 7});
    if (round == 2500) set(lasting->id(), collides, {0});
    set(temporary->id(), collides, {0});
    undo_stack.end(store);
    max_size = std::max(max_size, undo_stack.state()->size());
    world.remove_body(*temporary);
  }
  EXPECT_LT(max_size, 10000u) << "5000 bodies need 80000 bytes";
  ASSERT_TRUE(undo_stack.undo(world));
  EXPECT_EQ(store.values(world.id(), gravity)[2], -9.81);
  EXPECT_EQ(store.values(lasting->id(), collides)[0], 1);
  EXPECT_FALSE(undo_stack.undo(world)) << "it is one step";
  ASSERT_TRUE(undo_stack.redo(world));
  EXPECT_EQ(store.values(world.id(), gravity)[2], -1.0 - 4999 % 7);
  EXPECT_EQ(store.values(lasting->id(), collides)[0], 0);
}

}  // namespace
}  // namespace limber::engine::test
