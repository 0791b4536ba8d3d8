// Presets are made ready in small pieces while nothing comes or goes, and are the same as those that are not.
#include "engine/preset_taker.h"

#include <algorithm>
#include <set>
#include <span>

#include <fmt/ranges.h>

#include "engine/rig.h"
#include "params/catalog.h"
#include "sim/part.h"

namespace limber::engine_test {
namespace {

std::size_t things_of(const Store& store) {
  std::size_t count = 0;
  store.walk(store.root(), [&](NodeId) { count++; });
  return count;
}

// calls until it is ready
std::size_t prepare(PresetTaker& taker, const Store& store) {
  std::size_t calls = 0;
  for (; !taker.ready(store) && calls < 100000; calls++) taker.prepare(store);
  return calls;
}

void expect_same(const Preset& a, const Preset& b) {
  EXPECT_EQ(a.values, b.values);
  EXPECT_TRUE(*a.shape == *b.shape);
}

struct PresetTakerTest : testing::Test {
  Rig rig;
  void add_bodies(int count) {
    Shape& shape = **rig.world.add_shape(fmt::format("shape{}", made), ball());
    for (int i = 0; i < count; i++) {
      Body& body = **rig.world.add_body(fmt::format("more{}", made++));
      ASSERT_TRUE(body.add_part("tip", shape, i % 2, Pose{}).ok());
    }
    rig.world.settle();
  }
  std::shared_ptr<const Preset> fresh(const PresetChoice& choice = {}) const {
    return *PresetTaker().take(rig.store, "all", choice);
  }
  int made = 0;
};

TEST_F(PresetTakerTest, TellsOfThingsInTheOrderOfTheTree) {
  std::vector<std::string> tree, preset;
  rig.store.walk(rig.store.root(), [&](NodeId id) {
    const auto& rows = rig.store.table(id).rows();
    if (std::ranges::any_of(rows, [](const Row& row) { return row.kind == RowKind::property && row.stored(); }))
      tree.push_back(rig.store.path(id));
  });
  const auto taken = fresh();
  for (std::uint32_t i = 0; i < taken->shape->things().size(); i++) {
    if (taken->shape->rows(taken->shape->things()[i]) != nullptr) preset.push_back(taken->shape->path(i));
  }
  EXPECT_GT(tree.size(), 15u);
  EXPECT_EQ(preset, tree);
}

TEST_F(PresetTakerTest, IsReadyInTheTickInWhichMuchCame) {
  PresetTaker taker;
  EXPECT_EQ(prepare(taker, rig.store), 1u);
  add_bodies(700);
  EXPECT_FALSE(taker.ready(rig.store));
  EXPECT_EQ(prepare(taker, rig.store), 1u);
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
  add_bodies(300);
  EXPECT_EQ(prepare(taker, rig.store), 1u);
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
  add_bodies(1);
  EXPECT_GT(prepare(taker, rig.store), static_cast<std::size_t>(PresetTaker::kQuiet)) << "little waits for quiet";
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
}

TEST_F(PresetTakerTest, IsReadyAfterSoManySlices) {
  PresetTaker taker;
  taker.prepare(rig.store);
  taker.forget_store();
  EXPECT_EQ(prepare(taker, rig.store), PresetTaker::kQuiet + 1u) << "less than a slice";
  add_bodies(700);
  taker.prepare(rig.store);
  taker.forget_store();
  const std::size_t slices = things_of(rig.store) / PresetTaker::kSlice + 1;
  EXPECT_GT(slices, 4u);
  EXPECT_EQ(prepare(taker, rig.store), PresetTaker::kQuiet + slices);
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
}

TEST_F(PresetTakerTest, WhatComesOnTheWayIsInIt) {
  PresetTaker taker;
  add_bodies(700);
  taker.prepare(rig.store);
  taker.forget_store();
  for (int i = 0; i < PresetTaker::kQuiet + 3; i++) taker.prepare(rig.store);
  add_bodies(3);
  taker.prepare(rig.store);
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
  rig.world.remove_body(*rig.world.find_body("more1"));
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
}

TEST_F(PresetTakerTest, HalfReadyIsFinishedAtOnce) {
  PresetTaker taker;
  add_bodies(700);
  taker.prepare(rig.store);
  taker.forget_store();
  for (int i = 0; i < PresetTaker::kQuiet + 2; i++) taker.prepare(rig.store);
  EXPECT_FALSE(taker.ready(rig.store));
  const PresetChoice part{{"/physics/body/more*//*"}, {}, true, false};
  expect_same(**taker.take(rig.store, "some", part), *fresh(part));
  expect_same(**taker.take(rig.store, "all", {}), *fresh());
  EXPECT_TRUE(taker.ready(rig.store));
}

// rows of a preset, each with its numbers
std::set<std::string> rows_of(const Preset& preset) {
  std::set<std::string> texts;
  for (std::uint32_t i = 0; i < preset.shape->things().size(); i++) {
    const PresetShape::Thing& thing = preset.shape->things()[i];
    const PresetClass* const rows = preset.shape->rows(thing);
    for (std::size_t k = 0; rows != nullptr && k < rows->rows.size(); k++) {
      const double* const values = preset.values.data() + thing.at + rows->offsets[k];
      texts.insert(fmt::format("{}/{} {}", preset.shape->path(i), rows->rows[k].name,
                               fmt::join(std::span(values, rows->rows[k].width), " ")));
    }
  }
  return texts;
}

// what an address means is asked of the store, place by place
std::set<std::string> rows_of(const Store& store, const PresetChoice& choice) {
  std::set<std::string> texts;
  const auto add = [&](NodeId id, const Row& row) {
    const bool state = row.kind == RowKind::state && &store.table(id) == &Part::table();
    const bool pose = row.name == "position" || row.name == "rotation";
    if (row.kind != RowKind::property && !(state && (pose ? choice.poses : choice.velocities))) return;
    if (!row.stored() || (row.refuse != nullptr && !row.refuse(store.thing(id), store.values(id, row)))) return;
    texts.insert(
        fmt::format("{}/{} {}", store.path(id), row.name, fmt::join(std::span(store.values(id, row), row.width), " ")));
  };
  std::vector<NodeId> parts;
  for (const std::string& pattern : choice.rows) {
    PatternBudget budget;
    const auto places = match_places(store, pattern, budget);
    for (const Place& place : *places) {
      store.walk(place.node, [&](NodeId id) {
        if (place.row != nullptr && id != place.node) return;
        if (place.row != nullptr)
          add(id, *place.row);
        else
          for (const Row& row : store.table(id).rows()) add(id, row);
        if (&store.table(id) == &Part::table()) parts.push_back(id);
      });
    }
  }
  // where parts are: of those that are meant, else of all
  if (parts.empty()) {
    store.walk(store.root(), [&](NodeId id) {
      if (&store.table(id) == &Part::table()) parts.push_back(id);
    });
  }
  for (const NodeId part : parts) {
    for (const Row& row : Part::table().rows()) {
      if (row.kind == RowKind::state) add(part, row);
    }
  }
  return texts;
}

TEST_F(PresetTakerTest, AChoiceIsWhatItsPatternsMean) {
  add_bodies(25);
  const std::vector<PresetChoice> choices = {
      {{"/physics/body/*/part/*/*"}, {}, false, false},
      {{"/physics/body/*/part/*/{mass,friction}"}, {}, false, false},
      {{"/physics/body/more1*//*"}, {}, true, false},
      {{"/physics/body/more[12]//friction", "/physics/sim/gravity"}, {}, false, true},
      {{"/physics/body/more3"}, {}, true, true},
      {{"/physics/body/more3/part/tip/mass", "/physics/body/more4/part/tip/mass"}, {}, false, false},
      {{"/visuals"}, {}, true, false},
      {{"//friction"}, {}, false, false},
      {{"/Physics/BODY/more?/Part/tip/restitution"}, {}, false, false},
      {{"/physics/body"}, {}, false, true},
      {{"/physics", "/visuals"}, {}, true, true},
  };
  for (const PresetChoice& choice : choices) {
    SCOPED_TRACE(choice.rows.front());
    PresetTaker taker;
    const auto taken = taker.take(rig.store, "some", choice);
    ASSERT_TRUE(taken.ok()) << taken.error();
    EXPECT_EQ(rows_of(**taken), rows_of(rig.store, choice));
    expect_same(**taker.take(rig.store, "again", choice), **taken);
  }
  // nothing chosen is everything, here with what parts are
  const auto all = *PresetTaker().take(rig.store, "all", {{}, {}, true, true});
  EXPECT_EQ(rows_of(*all), rows_of(rig.store, {{"/physics", "/visuals"}, {}, true, true}));
}

TEST_F(PresetTakerTest, AChoiceThatReachesNothingIsSaid) {
  const auto fault = [&](const char* pattern) {
    const auto taken = PresetTaker().take(rig.store, "some", {{pattern}, {}, false, false});
    return taken.ok() ? "" : taken.error();
  };
  EXPECT_EQ(fault("/physics/body/*/part/*/position"), "'/physics/body/*/part/*/position' reaches no property");
  EXPECT_EQ(fault("/physics/body/nobody*"), "'/physics/body/nobody*' reaches no property");
  EXPECT_EQ(fault("/physics/bodi").find("there is no 'bodi' in /physics"), 0u) << fault("/physics/bodi");
  EXPECT_EQ(fault("body"), "'body' is no address: it must begin with /");
  // each is little work, all together are not
  const auto many =
      PresetTaker().take(rig.store, "many", {std::vector<std::string>(100000, "//mass"), {}, false, false});
  ASSERT_FALSE(many.ok());
  EXPECT_EQ(many.error().find("the pattern '//mass' is too much work"), 0u) << many.error();
}

// where copies are worth room that is made beside the show, and where the room is too small for what came
TEST_F(PresetTakerTest, ManyNumbersAreTheSameInRoomMadeAhead) {
  PresetTaker taker;
  for (const int more : {7000, 1, 1500}) {
    add_bodies(more);
    for (int i = 0; i < 3; i++) taker.prepare(rig.store);
    const auto taken = *taker.take(rig.store, "all", {});
    EXPECT_GT(taken->values.size(), PresetTaker::kRoomWorth);
    expect_same(*taken, *fresh());
  }
}

// what stands as it stood is not looked at again: whatever came, went or moved beside it
TEST_F(PresetTakerTest, KeepsWhatStandsAsItStood) {
  PresetTaker taker;
  add_bodies(20);
  taker.make_ready(rig.store);
  const auto expect_fresh = [&](const char* what) {
    EXPECT_FALSE(taker.ready(rig.store)) << what;
    SCOPED_TRACE(what);
    expect_same(**taker.take(rig.store, "all", {}), *fresh());
    EXPECT_TRUE(taker.ready(rig.store)) << what;
  };
  add_bodies(1);
  expect_fresh("one came");
  rig.world.remove_body(*rig.world.find_body("more0"));
  expect_fresh("the first went");
  rig.world.remove_body(*rig.world.find_body("more20"));
  rig.world.remove_body(*rig.world.find_body("more7"));
  add_bodies(2);
  expect_fresh("others in the same slots");
  const NodeId body = rig.world.find_body("more9")->id();
  const std::size_t place = rig.store.hide(body);
  expect_fresh("one hides");
  rig.store.show(body, place);
  expect_fresh("it is back");
  const NodeId first[] = {rig.world.find_body("more15")->id(), body};
  rig.store.order_children(rig.store.parent(body), first);
  expect_fresh("another order");
  rig.store.note_structure();
  expect_fresh("no node at all");
  const PresetChoice part{{"/physics/body/more1*//*"}, {}, false, false};
  expect_same(**taker.take(rig.store, "some", part), *fresh(part));
}

}  // namespace
}  // namespace limber::engine_test
