// Value snapshots: they contain all values, are made on request and not too often, and contain the writes of clients.
#include "engine/output/value_snapshot.h"

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "engine/output/feed.h"
#include "engine/output/value_snapshotter.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

TEST(ValueSnapshot, ContainsEveryValueOfTheStore) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(20);
  const std::shared_ptr<const ValueSnapshot> value_snapshot = make_value_snapshot(show);
  const Store& store = show.engine.store();
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < value_snapshot->tree->nodes().size(); i++) {
    const TreeSnapshot::Node& node = value_snapshot->tree->nodes()[i];
    for (const Property& property : node.table->properties()) {
      const double* const values = value_snapshot->value(value_snapshot->tree->location({i, &property})).numbers;
      if (property.kind == PropertyKind::action) {
        EXPECT_EQ(values, nullptr);
        continue;
      }
      double expected[4] = {};
      store.get(node.id, property, expected);
      for (std::uint32_t k = 0; k < property.width; k++)
        EXPECT_EQ(values[k], expected[k]) << value_snapshot->tree->path({i, &property});
      count++;
    }
  }
  EXPECT_GT(count, 500u);
  EXPECT_EQ(value_snapshot->snapshot->tick, show.engine.world().tick());
}

TEST(ValueSnapshot, IsMadeOnRequestOnly) {
  Show show;
  show.ticks(5);
  EXPECT_EQ(show.link.value_snapshots.read(), nullptr);
  const std::uint64_t first = show.link.request_value_snapshot();
  const std::uint64_t second = show.link.request_value_snapshot();
  show.ticks(1);
  const auto value_snapshot = show.link.value_snapshots.read();
  ASSERT_NE(value_snapshot, nullptr);
  EXPECT_EQ(second, first + 1);
  EXPECT_EQ(value_snapshot->request, second) << "one snapshot serves all earlier requests";
  show.ticks(5);
  EXPECT_EQ(show.link.value_snapshots.read()->number, 1u);
}

TEST(ValueSnapshot, ContainsMessagesSentBeforeItsRequest) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  for (int i = 1; i <= 10; i++) {
    show.send("/scene/wind", 0.5 * i);
    const auto value_snapshot = make_value_snapshot(show);
    EXPECT_EQ(
        value_snapshot->value(value_snapshot->tree->location(*value_snapshot->tree->find("/scene/wind"))).numbers[0],
        0.5 * i);
  }
}

TEST(ValueSnapshot, RebuildsTheTreeOnlyWhenNodesAreAddedOrRemoved) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(20);
  show.send("/transport/pause");
  const auto first = make_value_snapshot(show);
  show.ticks(3);
  const auto second = make_value_snapshot(show);
  EXPECT_EQ(second->tree, first->tree);
  EXPECT_GT(second->number, first->number);
  ASSERT_TRUE(show.engine.world().add_body("new").ok());
  EXPECT_TRUE(make_value_snapshot(show)->tree->find("/physics/body/new").ok());
  EXPECT_FALSE(first->tree->find("/physics/body/new").ok());
  // a reset makes another store, regardless of its version numbers
  show.send("/transport/reset");
  const auto after = make_value_snapshot(show);
  EXPECT_FALSE(after->tree->find("/physics/body/new").ok());
  EXPECT_GT(after->number, second->number);
  EXPECT_GE(second->snapshot->tick, 20u);
  EXPECT_EQ(after->value(after->tree->location(*after->tree->find("/physics/sim/tick"))).numbers[0], 0);
}

// an object with a text property
struct TextObject {
  std::string text;
  std::string_view read_words() const { return text; }
};
const PropertyTable& text_object_table() {
  static const PropertyTable table(
      "voice", "/voice", "",
      {properties::number("before", "", 0, 0, 1, "A number."),
       properties::text_from<&TextObject::read_words>(properties::text("words", "A text.")),
       properties::text_from<&TextObject::read_words>(properties::text("again", "The same text."))});
  return table;
}

TEST(ValueSnapshotter, CopiesTexts) {
  TextObject one{"first"};
  TextObject two{"second"};
  Store store;
  store.add(text_object_table(), store.root(), "one", &one);
  store.add(text_object_table(), store.root(), "two", &two);
  Latest<ValueSnapshot> out;
  ValueSnapshotter snapshotter(out);
  Feed feed;
  std::vector<std::string> text;
  feed.add("/two/again");
  const auto send_changes = [&] {
    feed.update(out.read(), {});
    feed.send_changes([&](const std::string& path, const Property&, const PropertyValue& value) {
      text.push_back(path + " " + std::string(value.text));
      return true;
    });
  };
  ASSERT_TRUE(snapshotter.make(store, std::make_shared<Snapshot>(), 1));
  const auto value_snapshot = out.read();
  EXPECT_EQ(value_snapshot->value(value_snapshot->tree->location(*value_snapshot->tree->find("/one/words"))).text,
            "first");
  EXPECT_EQ(value_snapshot->value(value_snapshot->tree->location(*value_snapshot->tree->find("/two/again"))).text,
            "second");
  send_changes();
  send_changes();
  two.text = "third";
  for (std::uint64_t request = 2; out.read() == value_snapshot; request++)
    snapshotter.make(store, std::make_shared<Snapshot>(), request);
  EXPECT_EQ(value_snapshot->value(value_snapshot->tree->location(*value_snapshot->tree->find("/two/again"))).text,
            "second")
      << "unchanged";
  send_changes();
  EXPECT_EQ(text, (std::vector<std::string>{"/two/again second", "/two/again third"}));
}

// a clock that advances by `turn` at each call
double real_time = 0;
double real_step = 0;
double real_clock() { return real_time += real_step; }
// a clock that advances by 2 ms at each call, so that a snapshot costs 2 ms
double cpu_time = 0;
double cpu_clock() { return cpu_time += 0.002; }

TEST(ValueSnapshotter, UsesAtMostOnePercentOfTheTime) {
  Rig rig;
  Latest<ValueSnapshot> out;
  real_time = 0;
  real_step = 0.002;
  ValueSnapshotter snapshotter(out, &real_clock, &cpu_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  std::uint64_t made = 0;
  // 10 s: at most one every 200 ms
  for (std::uint64_t request = 1; real_time < 10; request++)
    made += snapshotter.make(rig.store, snapshot, request) ? 1 : 0;
  EXPECT_GE(made, 49u);
  EXPECT_LE(made, 51u);
}

TEST(ValueSnapshotter, IgnoresTimeInWhichTheProgramWasSuspended) {
  Rig rig;
  Latest<ValueSnapshot> out;
  ValueSnapshotter snapshotter(out, &real_clock, &cpu_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  real_time = 0;
  real_step = 1000;  // real time that the first snapshot takes
  ASSERT_TRUE(snapshotter.make(rig.store, snapshot, 1));
  real_step = 0.002;
  int calls = 1;
  while (calls < 1000 && !snapshotter.make(rig.store, snapshot, 2)) calls++;
  EXPECT_NEAR(calls, 99, 1) << "the next one is due after 198 ms";
}

TEST(ValueSnapshotter, WritesAreOrderedAndExpire) {
  Rig rig;
  Latest<ValueSnapshot> out;
  real_step = 0;
  ValueSnapshotter snapshotter(out, &real_clock, &real_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  const CommandOrigin one{CommandSource::osc, 1, 1, true};
  const PropertyRef friction = *find_property(rig.store, "/physics/body/arm/part/tip/friction");
  const PropertyRef mass = *find_property(rig.store, "/physics/body/arm/part/tip/mass");
  for (const double value : {0.25, 0.75}) {
    ASSERT_TRUE(rig.store.set(friction.node, *friction.property, {&value, 1}).ok());
    snapshotter.note_write(rig.store, one, friction, false);
  }
  snapshotter.note_write(rig.store, one, mass, true);
  std::uint64_t request = 0;
  ASSERT_TRUE(snapshotter.make(rig.store, snapshot, ++request));
  const auto& writes = out.read()->writes;
  ASSERT_EQ(writes.size(), 2u) << "a property that is set twice is noted once";
  EXPECT_EQ(writes[0].property, friction.property);
  EXPECT_EQ(writes[0].values[0], 0.75);
  EXPECT_FALSE(writes[0].clamped);
  EXPECT_TRUE(writes[1].clamped);
  EXPECT_LT(writes[0].number, writes[1].number);
  for (std::uint64_t i = 1; i < ValueSnapshotter::kWriteLifetime; i++)
    ASSERT_TRUE(snapshotter.make(rig.store, snapshot, ++request));
  EXPECT_EQ(out.read()->writes.size(), 2u);
  ASSERT_TRUE(snapshotter.make(rig.store, snapshot, ++request));
  EXPECT_TRUE(out.read()->writes.empty());
  // bounded, the newest kept
  for (std::uint32_t i = 0; i < 3 * ValueSnapshotter::kMaxWrites; i++)
    snapshotter.note_write(rig.store, {CommandSource::osc, 1, static_cast<std::uint16_t>(i), true}, friction, false);
  ASSERT_TRUE(snapshotter.make(rig.store, snapshot, ++request));
  EXPECT_LE(out.read()->writes.size(), ValueSnapshotter::kMaxWrites);
  EXPECT_EQ(out.read()->writes.back().origin.port, 3 * ValueSnapshotter::kMaxWrites - 1);
}

TEST(ValueSnapshot, ContainsWritesOfSubscribersOnly) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  const auto send = [&](bool follows, double wind) {
    show.link.command_queue.push({{message("/scene/wind", wind)}, {CommandSource::osc, 7, 7, follows}});
  };
  send(false, 1);
  EXPECT_TRUE(make_value_snapshot(show)->writes.empty());
  send(true, 20);  // its range ends at 10
  const auto value_snapshot = make_value_snapshot(show);
  ASSERT_EQ(value_snapshot->writes.size(), 1u);
  EXPECT_EQ(value_snapshot->writes[0].values[0], 10);
  EXPECT_TRUE(value_snapshot->writes[0].clamped);
  EXPECT_EQ(value_snapshot->writes[0].origin, (CommandOrigin{CommandSource::osc, 7, 7, false}))
      << "subscribing is not part of the identity of a client";
}

}  // namespace
}  // namespace limber::engine::test
