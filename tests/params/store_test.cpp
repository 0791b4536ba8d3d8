// The store: its one door, marks, views, slots and generations, blocks that are used again.
#include "params/store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "params/toy.h"

namespace limber {
namespace {

using test::read;
using test::set;
using test::Toy;
using Numbers = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct StoreTest : testing::Test {
  NodeId add(const char* name) { return store.add(Toy::table(), toys, name, &toy); }
  Store store;
  Toy toy;
  NodeId toys = store.add_group(store.root(), "toys");
  NodeId id = add("bear");
  void SetUp() override {
    toy.store = &store;
    toy.id = id;
  }
};

TEST_F(StoreTest, StartsWithTheTablesDefaults) {
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
  EXPECT_EQ(read(store, id, "size"), (Numbers{1, 2, 3}));
  EXPECT_EQ(read(store, id, "active"), (Numbers{0, 1, 0}));
  EXPECT_EQ(read(store, id, "rotation"), (Numbers{0, 0, 0, 1}));
  EXPECT_EQ(read(store, id, "mode"), Numbers{1});
}

TEST_F(StoreTest, ClampsEachNumberAndSaysSo) {
  const struct {
    const char* row;
    Numbers given, kept;
    bool clamped;
  } cases[] = {
      {"mass", {2.5}, {2.5}, false},
      {"mass", {0.1}, {0.5}, true},
      {"mass", {11}, {10}, true},
      {"mass", {10}, {10}, false},
      {"size", {9, -9, 0}, {5, -5, 0}, true},
      {"count", {2.4}, {2}, false},
      {"count", {2.6}, {3}, false},
      {"count", {-1}, {0}, true},
      {"awake", {0}, {0}, false},
      {"awake", {0.4}, {0}, false},
      {"awake", {7}, {1}, false},
      {"awake", {-3}, {0}, false},
      {"active", {1, 0, 5}, {1, 0, 1}, false},
      {"mode", {2}, {2}, false},
      {"rotation", {0, 0, 0.5, 0.5}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}, false},
  };
  for (const auto& c : cases) {
    const auto outcome = set(store, id, c.row, c.given);
    ASSERT_TRUE(outcome) << outcome.error();
    EXPECT_EQ(outcome->clamped, c.clamped) << c.row << c.given[0];
    const Numbers kept = read(store, id, c.row);
    for (std::size_t i = 0; i < kept.size(); i++) EXPECT_NEAR(kept[i], c.kept[i], 1e-15) << c.row << c.given[0];
  }
}

TEST_F(StoreTest, ARotationThatWasReadCanBeSetAgainToTheBit) {
  ASSERT_TRUE(set(store, id, "rotation", {0.1, -0.7, 0.3, 0.2}));
  for (int i = 0; i < 100; i++) {
    const Numbers now = read(store, id, "rotation");
    ASSERT_TRUE(set(store, id, "rotation", now));
    ASSERT_EQ(read(store, id, "rotation"), now);
  }
}

TEST_F(StoreTest, WhoListensHearsOfEachRowAndWhatItWas) {
  struct Ear {
    std::vector<std::string> heard;
  } ear;
  const auto hear = [](void* who, NodeId, const Row& row, bool later, const double* was) {
    static_cast<Ear*>(who)->heard.push_back(fmt::format("{} {}{}", row.name, was[0], later ? " later" : ""));
  };
  const Store::Listener before = store.listen({hear, &ear});
  EXPECT_EQ(before.heard, nullptr);
  EXPECT_TRUE(set(store, id, "mass", {2}));
  EXPECT_TRUE(set(store, id, "mass", {2})) << "the same value too";
  EXPECT_FALSE(set(store, id, "mass", {kNan}));
  EXPECT_TRUE(set(store, id, "position", {1, 2, 3}));
  store.announce(id, store.table(id).at("mass"), true);
  EXPECT_EQ(store.listen(before).who, &ear);
  EXPECT_TRUE(set(store, id, "mass", {3}));
  EXPECT_EQ(ear.heard, (std::vector<std::string>{"mass 1", "mass 2", "position 0", "mass 2 later"}));
}

TEST_F(StoreTest, WhatACallSetsIsHeardOnceItHasEndedWell) {
  std::vector<std::string> heard;
  const auto hear = [](void* who, NodeId, const Row& row, bool, const double* was) {
    static_cast<std::vector<std::string>*>(who)->push_back(fmt::format("{} {}", row.name, was[0]));
  };
  store.listen({hear, &heard});
  store.begin_undo();
  EXPECT_TRUE(set(store, id, "mass", {2}));
  store.take_back();
  EXPECT_TRUE(heard.empty()) << "it never was";
  store.begin_undo();
  EXPECT_TRUE(set(store, id, "mass", {2}));
  EXPECT_TRUE(set(store, id, "position", {1, 2, 3}));
  EXPECT_TRUE(set(store, id, "mass", {3}));
  EXPECT_TRUE(heard.empty());
  store.end_undo();
  EXPECT_EQ(heard, (std::vector<std::string>{"mass 1", "position 0"})) << "once, with what it was before the call";
  store.begin_undo();
  EXPECT_TRUE(set(store, id, "mass", {4}));
  store.end_undo();
  EXPECT_EQ(heard.back(), "mass 3");
}

TEST_F(StoreTest, TellsWhenANodeCame) {
  const std::uint64_t then = store.structure_version();
  EXPECT_LE(store.born(id), then);
  const NodeId newer = store.add(store.table(id), store.root(), "newer", nullptr);
  EXPECT_GT(store.born(newer), then);
  EXPECT_LE(store.born(newer), store.structure_version());
  store.remove(newer);
  EXPECT_EQ(store.born(newer), 0u);
}

TEST_F(StoreTest, RefusesWhatIsNoValueAndAppliesNothingOfIt) {
  const Numbers before(store.kept().begin(), store.kept().end());
  const Numbers live(store.live().begin(), store.live().end());
  store.apply_marks();
  const std::uint64_t version = store.kept_version();
  const int effects = toy.mass_effects + toy.pose_effects;
  toy.holds_mass = true;
  const struct {
    const char* row;
    Numbers given;
    const char* text;
  } cases[] = {
      {"mass", {kNan}, "/toys/bear/mass takes numbers; nan is none"},
      {"mass", {kInf}, "/toys/bear/mass takes numbers; inf is none"},
      {"mass", {-kInf}, "/toys/bear/mass takes numbers; -inf is none"},
      {"size", {1, kNan, 1}, "/toys/bear/size takes numbers; nan is none"},
      {"rotation", {0, 0, 0, kNan}, "/toys/bear/rotation takes numbers; nan is none"},
      {"rotation", {0, 0, 0, 0}, "/toys/bear/rotation takes a rotation; 0 0 0 0 is none"},
      {"active", {1, kNan, 0}, "/toys/bear/active takes numbers; nan is none"},
      {"mass", {}, "/toys/bear/mass takes 1 number, not 0"},
      {"mass", {1, 2}, "/toys/bear/mass takes 1 number, not 2"},
      {"size", {1}, "/toys/bear/size takes 3 numbers, not 1"},
      {"mode", {3}, "/toys/bear/mode has the choices off, on, auto; 3 is none of them"},
      {"mode", {-1}, "/toys/bear/mode has the choices off, on, auto; -1 is none of them"},
      {"speed", {1}, "/toys/bear/speed can be read, not set"},
      {"answer", {1}, "/toys/bear/answer can be read, not set"},
      {"kick", {}, "/toys/bear/kick can be done, not set"},
      {"mass", {7}, "/toys/bear/mass: it is nailed down"},
  };
  for (const auto& c : cases) {
    const auto outcome = set(store, id, c.row, c.given);
    ASSERT_FALSE(outcome) << c.row;
    EXPECT_EQ(outcome.error(), c.text);
  }
  store.apply_marks();
  EXPECT_TRUE(std::equal(before.begin(), before.end(), store.kept().begin()));
  EXPECT_TRUE(std::equal(live.begin(), live.end(), store.live().begin()));
  EXPECT_EQ(store.kept_version(), version);
  EXPECT_EQ(toy.mass_effects + toy.pose_effects, effects);
}

TEST_F(StoreTest, AnEffectHappensOnceBeforeTheNextStep) {
  store.apply_marks();  // a new node's rows are all marked
  EXPECT_EQ(toy.mass_effects, 1);
  EXPECT_EQ(toy.pose_effects, 1);
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 1);
  for (int i = 0; i < 5; i++) ASSERT_TRUE(set(store, id, "mass", {2.0 + i}));
  ASSERT_TRUE(set(store, id, "density", {3}));  // the same effect
  EXPECT_EQ(toy.mass_effects, 1);
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 2);
  EXPECT_EQ(toy.pose_effects, 1);
  ASSERT_TRUE(set(store, id, "position", {1, 2, 3}));
  ASSERT_TRUE(set(store, id, "count", {5}));  // without effect
  store.apply_marks();
  EXPECT_EQ(toy.pose_effects, 2);
  EXPECT_EQ(toy.mass_effects, 2);
}

TEST_F(StoreTest, WhatGoesOnIsWrittenAndToldAndItsEffectsAreTheCallers) {
  store.apply_marks();
  std::vector<std::string> heard;
  const auto hear = [](void* who, NodeId, const Row& row, bool, const double* was) {
    static_cast<std::vector<std::string>*>(who)->push_back(fmt::format("{} {}", row.name, was[0]));
  };
  store.listen({hear, &heard});
  const Row& mass = Toy::table().at("mass");
  const Row& density = Toy::table().at("density");
  const double values[] = {4, 7};
  const std::uint64_t version = store.kept_version();
  store.go_on(id, mass, &values[0]);
  store.go_on(id, density, &values[1]);
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
  EXPECT_EQ(read(store, id, "density"), Numbers{7});
  EXPECT_GT(store.kept_version(), version);
  EXPECT_EQ(heard, (std::vector<std::string>{"mass 1", "density 2"}));
  EXPECT_FALSE(store.marked(id, mass));
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 1) << "of the beginning";
  const std::uint64_t count = Toy::table().at("count").index;
  store.run_effects(id, std::uint64_t{1} << mass.index | std::uint64_t{1} << density.index | std::uint64_t{1} << count);
  EXPECT_EQ(toy.mass_effects, 2) << "one for both, and none of a row without";
  EXPECT_EQ(toy.pose_effects, 1);
}

TEST_F(StoreTest, TellsWhatItWouldTakeAndDoesNotTakeIt) {
  Numbers taken(4);
  const auto outcome = store.take(id, Toy::table().at("mass"), Numbers{11}, taken.data());
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->clamped);
  EXPECT_EQ(taken[0], 10);
  toy.holds_mass = true;
  const auto refused = store.take(id, Toy::table().at("mass"), Numbers{6}, taken.data());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), set(store, id, "mass", {6}).error());
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
}

TEST_F(StoreTest, KnowsBelowWhichNodesSomethingChanged) {
  const NodeId other = store.add_group(store.root(), "other");
  const NodeId below = store.add_group(other, "below");
  std::uint64_t then = 0;
  // those of the four below which something changed since
  const auto changed = [&] {
    std::string names;
    for (const NodeId node : {store.root(), toys, id, other})
      names += store.changed(node) > then ? store.path(node) + " " : "";
    then = store.structure_version();
    return names;
  };
  (void)changed();
  EXPECT_EQ(changed(), "");
  const NodeId came = add("came");
  EXPECT_EQ(changed(), "/ /toys ");
  const std::size_t place = store.hide(came);
  EXPECT_EQ(changed(), "/ /toys ");
  store.show(came, place);
  EXPECT_EQ(store.changed(came), store.structure_version()) << "it was not there meanwhile";
  EXPECT_EQ(changed(), "/ /toys ");
  const NodeId children[] = {came, id};
  store.order_children(toys, children);
  EXPECT_EQ(changed(), "/ /toys ");
  store.remove(came);
  EXPECT_EQ(changed(), "/ /toys ");
  store.retable(below, Toy::table(), &toy);
  EXPECT_EQ(changed(), "/ /other ");
  ASSERT_TRUE(set(store, id, "mass", {2}));
  EXPECT_EQ(changed(), "") << "a value is no structure";
}

TEST_F(StoreTest, AnEffectThatMarksItselfDoesNotGoOnForEver) {
  store.apply_marks();
  const int rounds = toy.rounds;
  EXPECT_GT(rounds, 1);
  EXPECT_LT(rounds, 10);
  store.apply_marks();
  EXPECT_GT(toy.rounds, rounds);
}

TEST_F(StoreTest, AViewReadsAndWritesWhatIsBehindIt) {
  ASSERT_TRUE(set(store, id, "twice", {6}));
  EXPECT_EQ(toy.doubled, 3);
  EXPECT_EQ(read(store, id, "twice"), Numbers{6});
  const auto outcome = set(store, id, "twice", {100});
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->clamped);
  EXPECT_EQ(toy.doubled, 5);
  EXPECT_EQ(read(store, id, "answer"), Numbers{42});
}

TEST_F(StoreTest, CountsWritesToKeptValuesOnly) {
  const std::uint64_t start = store.kept_version();
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  EXPECT_EQ(store.kept_version(), start);
  ASSERT_TRUE(set(store, id, "mass", {2}));
  EXPECT_GT(store.kept_version(), start);
  const std::uint64_t structure = store.structure_version();
  add("duck");
  EXPECT_GT(store.structure_version(), structure);
}

TEST_F(StoreTest, AStaleIdIsAnAnswer) {
  store.remove(id);
  const NodeId far{4000000000u, 1};
  for (const NodeId gone : {id, NodeId{}, far}) {
    EXPECT_FALSE(store.alive(gone));
    EXPECT_EQ(store.thing(gone), nullptr);
    EXPECT_EQ(store.name(gone), "");
    EXPECT_EQ(store.path(gone), "");
    EXPECT_TRUE(store.children(gone).empty());
    EXPECT_TRUE(store.parent(gone).null());
    EXPECT_FALSE(store.is_group(gone));
    const double one = 1;
    const auto outcome = store.set(gone, Toy::table().at("mass"), {&one, 1});
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error(), "this thing no longer exists");
    EXPECT_FALSE(store.set(gone, "mass", {&one, 1}));
    double out = 7;
    store.get(gone, Toy::table().at("mass"), &out);
    EXPECT_EQ(out, 0);
    store.mark(gone, Toy::table().at("mass"));
    store.remove(gone);
  }
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 0);
}

TEST_F(StoreTest, SlotsAndBlocksAreUsedAgainGenerationsNever) {
  const std::size_t kept = store.kept().size();
  const std::size_t live = store.live().size();
  std::set<NodeId> seen;
  NodeId last = id;
  for (int i = 0; i < 100; i++) {
    ASSERT_TRUE(set(store, last, "mass", {9}));
    ASSERT_TRUE(set(store, last, "position", {1, 2, 3}));
    store.remove(last);
    EXPECT_FALSE(store.alive(last));
    last = add("bear");
    EXPECT_TRUE(seen.insert(last).second);
    EXPECT_EQ(last.slot, id.slot);
    // nothing is left of the one before
    EXPECT_EQ(read(store, last, "mass"), Numbers{1});
    EXPECT_EQ(read(store, last, "position"), (Numbers{0, 0, 0}));
  }
  EXPECT_EQ(store.kept().size(), kept);
  EXPECT_EQ(store.live().size(), live);
}

TEST_F(StoreTest, RemovingANodeRemovesAllBelowIt) {
  const NodeId house = store.add_group(toys, "house");
  const NodeId inner = store.add(Toy::table(), house, "doll", &toy);
  const NodeId deep = store.add(Toy::table(), inner, "button", &toy);
  store.remove(house);
  for (const NodeId gone : {house, inner, deep}) EXPECT_FALSE(store.alive(gone));
  EXPECT_TRUE(store.alive(id));
  EXPECT_EQ(store.children(toys).size(), 1u);
  EXPECT_TRUE(store.child(toys, "house").null());
  EXPECT_EQ(store.path(id), "/toys/bear");
  store.remove(store.root());
  EXPECT_TRUE(store.alive(store.root()));
}

TEST_F(StoreTest, TheDeadLeaveZeros) {
  ASSERT_TRUE(set(store, id, "position", {1, 2, 3}));
  store.remove(id);
  for (const double v : store.kept()) EXPECT_EQ(v, 0);
  for (const double v : store.live()) EXPECT_EQ(v, 0);
}

TEST_F(StoreTest, ChildrenKeepTheirOrderAndWalkIsDepthFirst) {
  add("duck");
  const NodeId cat = add("cat");
  store.add_group(cat, "tail");
  store.remove(id);
  add("bear");
  std::vector<std::string> order;
  store.walk(toys, [&](NodeId n) { order.push_back(store.path(n)); });
  EXPECT_EQ(order, (std::vector<std::string>{"/toys", "/toys/duck", "/toys/cat", "/toys/cat/tail", "/toys/bear"}));
}

TEST_F(StoreTest, TheViewShowsWhereTheNumbersAre) {
  for (int i = 0; i < 50; i++) add(std::to_string(i).c_str());
  ASSERT_TRUE(set(store, id, "size", {4, 5, 1}));
  const StoreView& view = *store.view();
  ASSERT_GT(view.slot_count, id.slot);
  const NodeSlot& slot = view.slots[id.slot];
  EXPECT_EQ(slot.generation, id.generation);
  EXPECT_EQ(store.tables()[slot.table], &Toy::table());
  EXPECT_EQ(view.kept[slot.kept + Toy::table().at("size").offset + 1], 5);
  EXPECT_EQ(view.live[slot.live + Toy::table().at("rotation").offset + 3], 1);
}

// who rolled, and on which threads
struct Rolls {
  std::mutex mutex;
  std::condition_variable rolled;
  std::vector<int> order;
  std::set<std::thread::id> threads;
  std::size_t awaited = 1;  // who rolls waits until so many threads have,
  bool gave_up = false;     // unless none comes
};

struct Marble {
  int number = 0;
  Rolls* rolls = nullptr;
  void roll() {
    std::unique_lock lock(rolls->mutex);
    rolls->order.push_back(number);
    rolls->threads.insert(std::this_thread::get_id());
    rolls->rolled.notify_all();
    if (rolls->gave_up) return;
    rolls->gave_up = !rolls->rolled.wait_for(lock, std::chrono::seconds(60),
                                             [this] { return rolls->threads.size() >= rolls->awaited; });
  }
  static const Table& table() {
    static const Table marble("marble", "/marbles/<marble>", "",
                              {rows::apart(rows::effect<&Marble::roll>(rows::number("spin", "", 0, 0, 1, "Alone."))),
                               rows::effect<&Marble::roll>(rows::number("weight", "", 0, 0, 1, "Among others."))});
    return marble;
  }
};

struct ManyMarbles : testing::Test {
  static constexpr int kCount = 8 * kPlaces;
  static constexpr int kOften = 200;  // a helper that should have no part comes in time now and then
  Store store;
  Rolls rolls;
  std::vector<Marble> marbles{std::size_t{kCount}};
  std::vector<NodeId> ids;
  Team team{2};
  void SetUp() override {
    for (int i = 0; i < kCount; i++) {
      marbles[static_cast<std::size_t>(i)] = {i, &rolls};
      ids.push_back(store.add(Marble::table(), store.root(), fmt::format("m{}", i), &marbles[ids.size()]));
    }
    store.apply_marks();
    forget();
  }
  void forget() {
    rolls.order.clear();
    rolls.threads.clear();
  }
  void spin_all() {
    for (const NodeId id : ids) ASSERT_TRUE(set(store, id, "spin", {1}));
  }
  bool in_the_order_of_marks() const { return std::is_sorted(rolls.order.begin(), rolls.order.end()); }
};

TEST_F(ManyMarbles, EffectsThatAreApartRunSideBySideEachOnce) {
  rolls.awaited = 2;
  spin_all();
  store.apply_marks(&team);
  EXPECT_EQ(rolls.order.size(), ids.size());
  EXPECT_EQ(std::set<int>(rolls.order.begin(), rolls.order.end()).size(), ids.size());
  EXPECT_EQ(rolls.threads.size(), 2u);
}

TEST_F(ManyMarbles, WithOneThatIsNotApartAllRunInTheirOrder) {
  for (int often = 0; often < kOften; often++) {
    spin_all();
    ASSERT_TRUE(set(store, ids[kCount / 2], "weight", {1}));
    forget();
    store.apply_marks(&team);
    ASSERT_EQ(rolls.order.size(), ids.size());
    ASSERT_TRUE(in_the_order_of_marks());
    ASSERT_EQ(rolls.threads, std::set{std::this_thread::get_id()});
  }
}

TEST_F(ManyMarbles, ANodeThatIsListedTwiceIsNotSharedOut) {
  for (int often = 0; often < kOften; often++) {
    spin_all();
    store.apply_marks(ids[3]);  // ahead of the others: it stays in the list
    ASSERT_TRUE(set(store, ids[3], "spin", {0}));
    forget();
    store.apply_marks(&team);
    ASSERT_EQ(rolls.order.size(), ids.size());
    ASSERT_EQ(rolls.threads, std::set{std::this_thread::get_id()});
  }
}

}  // namespace
}  // namespace limber
