// Store: the setter, dirty properties, computed properties, slots and generations, reuse of blocks.
#include "properties/store.h"
#include "base/memory/archive.h"

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

#include "properties/toy.h"

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

TEST_F(StoreTest, ClampsEachNumberAndReportsIt) {
  const struct {
    const char* property;
    Numbers input, stored;
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
    const auto outcome = set(store, id, c.property, c.input);
    ASSERT_TRUE(outcome) << outcome.error();
    EXPECT_EQ(outcome->clamped, c.clamped) << c.property << c.input[0];
    const Numbers stored = read(store, id, c.property);
    for (std::size_t i = 0; i < stored.size(); i++)
      EXPECT_NEAR(stored[i], c.stored[i], 1e-15) << c.property << c.input[0];
  }
}

TEST_F(StoreTest, SettingAReadRotationDoesNotChangeIt) {
  ASSERT_TRUE(set(store, id, "rotation", {0.1, -0.7, 0.3, 0.2}));
  for (int i = 0; i < 100; i++) {
    const Numbers now = read(store, id, "rotation");
    ASSERT_TRUE(set(store, id, "rotation", now));
    ASSERT_EQ(read(store, id, "rotation"), now);
  }
}

TEST_F(StoreTest, ListenerGetsEachWriteWithThePreviousValue) {
  struct Recorder {
    std::vector<std::string> calls;
  } recorder;
  const auto record = [](void* context, NodeId, const Property& property, bool later, const double* previous) {
    static_cast<Recorder*>(context)->calls.push_back(
        fmt::format("{} {}{}", property.name, previous[0], later ? " later" : ""));
  };
  const Store::Listener before = store.set_listener({record, &recorder});
  EXPECT_EQ(before.callback, nullptr);
  EXPECT_TRUE(set(store, id, "mass", {2}));
  EXPECT_TRUE(set(store, id, "mass", {2})) << "an equal value, too";
  EXPECT_FALSE(set(store, id, "mass", {kNan}));
  EXPECT_TRUE(set(store, id, "position", {1, 2, 3}));
  store.notify(id, store.table(id).at("mass"), true);
  EXPECT_EQ(store.set_listener(before).context, &recorder);
  EXPECT_TRUE(set(store, id, "mass", {3}));
  EXPECT_EQ(recorder.calls, (std::vector<std::string>{"mass 1", "mass 2", "position 0", "mass 2 later"}));
}

TEST_F(StoreTest, TransactionNotifiesOnCommit) {
  std::vector<std::string> calls;
  const auto record = [](void* context, NodeId, const Property& property, bool, const double* previous) {
    static_cast<std::vector<std::string>*>(context)->push_back(fmt::format("{} {}", property.name, previous[0]));
  };
  store.set_listener({record, &calls});
  store.begin_transaction();
  EXPECT_TRUE(set(store, id, "mass", {2}));
  store.rollback();
  EXPECT_TRUE(calls.empty()) << "rolled back";
  store.begin_transaction();
  EXPECT_TRUE(set(store, id, "mass", {2}));
  EXPECT_TRUE(set(store, id, "position", {1, 2, 3}));
  EXPECT_TRUE(set(store, id, "mass", {3}));
  EXPECT_TRUE(calls.empty());
  store.commit_transaction();
  EXPECT_EQ(calls, (std::vector<std::string>{"mass 1", "position 0"})) << "once, with the value before the transaction";
  store.begin_transaction();
  EXPECT_TRUE(set(store, id, "mass", {4}));
  store.commit_transaction();
  EXPECT_EQ(calls.back(), "mass 3");
}

TEST_F(StoreTest, ReportsWhenANodeWasAdded) {
  const std::uint64_t then = store.structure_version();
  EXPECT_LE(store.added_version(id), then);
  const NodeId newer = store.add(store.table(id), store.root(), "newer", nullptr);
  EXPECT_GT(store.added_version(newer), then);
  EXPECT_LE(store.added_version(newer), store.structure_version());
  store.remove(newer);
  EXPECT_EQ(store.added_version(newer), 0u);
}

TEST_F(StoreTest, RejectsInvalidValuesWithoutWriting) {
  const Numbers persistent_before(store.persistent_values().begin(), store.persistent_values().end());
  const Numbers transient_before(store.transient_values().begin(), store.transient_values().end());
  store.flush();
  const std::uint64_t version = store.persistent_version();
  const int callbacks = toy.mass_callbacks + toy.pose_callbacks;
  toy.rejects_large_mass = true;
  const struct {
    const char* property;
    Numbers input;
    const char* text;
  } cases[] = {
      {"mass", {kNan}, "/toys/bear/mass takes finite numbers, not nan"},
      {"mass", {kInf}, "/toys/bear/mass takes finite numbers, not inf"},
      {"mass", {-kInf}, "/toys/bear/mass takes finite numbers, not -inf"},
      {"size", {1, kNan, 1}, "/toys/bear/size takes finite numbers, not nan"},
      {"rotation", {0, 0, 0, kNan}, "/toys/bear/rotation takes finite numbers, not nan"},
      {"rotation", {0, 0, 0, 0}, "/toys/bear/rotation takes a rotation, not 0 0 0 0"},
      {"active", {1, kNan, 0}, "/toys/bear/active takes finite numbers, not nan"},
      {"mass", {}, "/toys/bear/mass takes 1 number, not 0"},
      {"mass", {1, 2}, "/toys/bear/mass takes 1 number, not 2"},
      {"size", {1}, "/toys/bear/size takes 3 numbers, not 1"},
      {"mode", {3}, "/toys/bear/mode must be one of off, on, auto (got 3)"},
      {"mode", {-1}, "/toys/bear/mode must be one of off, on, auto (got -1)"},
      {"speed", {1}, "/toys/bear/speed can be read, not set"},
      {"answer", {1}, "/toys/bear/answer can be read, not set"},
      {"kick", {}, "/toys/bear/kick can be called, not set"},
      {"mass", {7}, "/toys/bear/mass: it is fixed"},
  };
  for (const auto& c : cases) {
    const auto outcome = set(store, id, c.property, c.input);
    ASSERT_FALSE(outcome) << c.property;
    EXPECT_EQ(outcome.error(), c.text);
  }
  store.flush();
  EXPECT_TRUE(std::equal(persistent_before.begin(), persistent_before.end(), store.persistent_values().begin()));
  EXPECT_TRUE(std::equal(transient_before.begin(), transient_before.end(), store.transient_values().begin()));
  EXPECT_EQ(store.persistent_version(), version);
  EXPECT_EQ(toy.mass_callbacks + toy.pose_callbacks, callbacks);
}

TEST_F(StoreTest, CallbackRunsOncePerFlush) {
  store.flush();  // all properties of a new node are dirty
  EXPECT_EQ(toy.mass_callbacks, 1);
  EXPECT_EQ(toy.pose_callbacks, 1);
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 1);
  for (int i = 0; i < 5; i++) ASSERT_TRUE(set(store, id, "mass", {2.0 + i}));
  ASSERT_TRUE(set(store, id, "density", {3}));  // the same callback
  EXPECT_EQ(toy.mass_callbacks, 1);
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 2);
  EXPECT_EQ(toy.pose_callbacks, 1);
  ASSERT_TRUE(set(store, id, "position", {1, 2, 3}));
  ASSERT_TRUE(set(store, id, "count", {5}));  // without a callback
  store.flush();
  EXPECT_EQ(toy.pose_callbacks, 2);
  EXPECT_EQ(toy.mass_callbacks, 2);
}

TEST_F(StoreTest, UncheckedWriteNotifiesWithoutCallback) {
  store.flush();
  std::vector<std::string> calls;
  const auto record = [](void* context, NodeId, const Property& property, bool, const double* previous) {
    static_cast<std::vector<std::string>*>(context)->push_back(fmt::format("{} {}", property.name, previous[0]));
  };
  store.set_listener({record, &calls});
  const Property& mass = Toy::table().at("mass");
  const Property& density = Toy::table().at("density");
  const double values[] = {4, 7};
  const std::uint64_t version = store.persistent_version();
  store.write_unchecked(id, mass, &values[0]);
  store.write_unchecked(id, density, &values[1]);
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
  EXPECT_EQ(read(store, id, "density"), Numbers{7});
  EXPECT_GT(store.persistent_version(), version);
  EXPECT_EQ(calls, (std::vector<std::string>{"mass 1", "density 2"}));
  EXPECT_FALSE(store.is_dirty(id, mass));
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 1) << "only the call for the new node";
  const std::uint64_t count = Toy::table().at("count").index;
  store.run_callbacks(id,
                      std::uint64_t{1} << mass.index | std::uint64_t{1} << density.index | std::uint64_t{1} << count);
  EXPECT_EQ(toy.mass_callbacks, 2) << "one call for both; `count` has no callback";
  EXPECT_EQ(toy.pose_callbacks, 1);
}

TEST_F(StoreTest, ValidateDoesNotWrite) {
  Numbers accepted(4);
  const auto outcome = store.validate(id, Toy::table().at("mass"), Numbers{11}, accepted.data());
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->clamped);
  EXPECT_EQ(accepted[0], 10);
  toy.rejects_large_mass = true;
  const auto rejected = store.validate(id, Toy::table().at("mass"), Numbers{6}, accepted.data());
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error(), set(store, id, "mass", {6}).error());
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
}

TEST_F(StoreTest, CallbackThatSetsItselfIsLimited) {
  store.flush();
  const int rounds = toy.rounds;
  EXPECT_GT(rounds, 1);
  EXPECT_LT(rounds, 10);
  store.flush();
  EXPECT_GT(toy.rounds, rounds);
}

TEST_F(StoreTest, ComputedPropertyUsesGetterAndSetter) {
  ASSERT_TRUE(set(store, id, "twice", {6}));
  EXPECT_EQ(toy.doubled, 3);
  EXPECT_EQ(read(store, id, "twice"), Numbers{6});
  const auto outcome = set(store, id, "twice", {100});
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(outcome->clamped);
  EXPECT_EQ(toy.doubled, 5);
  EXPECT_EQ(read(store, id, "answer"), Numbers{42});
}

TEST_F(StoreTest, CountsWritesToPersistentValuesOnly) {
  const std::uint64_t start = store.persistent_version();
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  EXPECT_EQ(store.persistent_version(), start);
  ASSERT_TRUE(set(store, id, "mass", {2}));
  EXPECT_GT(store.persistent_version(), start);
  const std::uint64_t structure = store.structure_version();
  add("duck");
  EXPECT_GT(store.structure_version(), structure);
}

TEST_F(StoreTest, StaleIdsAreSafe) {
  store.remove(id);
  const NodeId far{4000000000u, 1};
  for (const NodeId stale : {id, NodeId{}, far}) {
    EXPECT_FALSE(store.alive(stale));
    EXPECT_EQ(store.object(stale), nullptr);
    EXPECT_EQ(store.name(stale), "");
    EXPECT_EQ(store.path(stale), "");
    EXPECT_TRUE(store.children(stale).empty());
    EXPECT_TRUE(store.parent(stale).null());
    EXPECT_FALSE(store.is_group(stale));
    const double one = 1;
    const auto outcome = store.set(stale, Toy::table().at("mass"), {&one, 1});
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error(), "this object no longer exists");
    EXPECT_FALSE(store.set(stale, "mass", {&one, 1}));
    double out = 7;
    store.get(stale, Toy::table().at("mass"), &out);
    EXPECT_EQ(out, 0);
    store.mark_dirty(stale, Toy::table().at("mass"));
    store.remove(stale);
  }
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 0);
}

TEST_F(StoreTest, ReusesSlotsAndBlocksButNotGenerations) {
  const std::size_t persistent_size = store.persistent_values().size();
  const std::size_t transient_size = store.transient_values().size();
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
    // No values of the previous node remain.
    EXPECT_EQ(read(store, last, "mass"), Numbers{1});
    EXPECT_EQ(read(store, last, "position"), (Numbers{0, 0, 0}));
  }
  EXPECT_EQ(store.persistent_values().size(), persistent_size);
  EXPECT_EQ(store.transient_values().size(), transient_size);
}

TEST_F(StoreTest, RemovingANodeRemovesItsDescendants) {
  const NodeId house = store.add_group(toys, "house");
  const NodeId inner = store.add(Toy::table(), house, "doll", &toy);
  const NodeId deep = store.add(Toy::table(), inner, "button", &toy);
  store.remove(house);
  for (const NodeId removed : {house, inner, deep}) EXPECT_FALSE(store.alive(removed));
  EXPECT_TRUE(store.alive(id));
  EXPECT_EQ(store.children(toys).size(), 1u);
  EXPECT_TRUE(store.child(toys, "house").null());
  EXPECT_EQ(store.path(id), "/toys/bear");
  store.remove(store.root());
  EXPECT_TRUE(store.alive(store.root()));
}

TEST_F(StoreTest, FreedBlocksAreZero) {
  ASSERT_TRUE(set(store, id, "position", {1, 2, 3}));
  store.remove(id);
  for (const double v : store.persistent_values()) EXPECT_EQ(v, 0);
  for (const double v : store.transient_values()) EXPECT_EQ(v, 0);
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

TEST_F(StoreTest, ViewLocatesTheValues) {
  for (int i = 0; i < 50; i++) add(std::to_string(i).c_str());
  ASSERT_TRUE(set(store, id, "size", {4, 5, 1}));
  const StoreView& view = *store.view();
  ASSERT_GT(view.slot_count, id.slot);
  const NodeSlot& slot = view.slots[id.slot];
  EXPECT_EQ(slot.generation, id.generation);
  EXPECT_EQ(store.tables()[slot.table], &Toy::table());
  EXPECT_EQ(view.persistent[slot.persistent + Toy::table().at("size").offset + 1], 5);
  EXPECT_EQ(view.transient[slot.transient + Toy::table().at("rotation").offset + 3], 1);
}

// Records the marbles that rolled and their threads.
struct Rolls {
  std::mutex mutex;
  std::condition_variable rolled;
  std::vector<int> order;
  std::set<std::thread::id> threads;
  std::size_t required_threads = 1;  // each marble waits until this many threads have rolled one,
  bool timed_out = false;            // or until a timeout
};

struct Marble {
  int number = 0;
  Rolls* rolls = nullptr;
  void roll() {
    std::unique_lock lock(rolls->mutex);
    rolls->order.push_back(number);
    rolls->threads.insert(std::this_thread::get_id());
    rolls->rolled.notify_all();
    if (rolls->timed_out) return;
    rolls->timed_out = !rolls->rolled.wait_for(lock, std::chrono::seconds(60),
                                               [this] { return rolls->threads.size() >= rolls->required_threads; });
  }
  static const PropertyTable& table() {
    static const PropertyTable marble(
        "marble", "/marbles/<marble>", "",
        {properties::independent(
             properties::on_change<&Marble::roll>(properties::number("spin", "", 0, 0, 1, "Alone."))),
         properties::on_change<&Marble::roll>(properties::number("weight", "", 0, 0, 1, "Among others."))});
    return marble;
  }
};

struct ManyMarbles : testing::Test {
  static constexpr int kCount = 8 * kDefaultGrain;
  static constexpr int kRepetitions = 200;  // repetitions, since a worker that should not run may be late
  Store store;
  Rolls rolls;
  std::vector<Marble> marbles{std::size_t{kCount}};
  std::vector<NodeId> ids;
  ThreadPool pool{2};
  void SetUp() override {
    for (int i = 0; i < kCount; i++) {
      marbles[static_cast<std::size_t>(i)] = {i, &rolls};
      ids.push_back(store.add(Marble::table(), store.root(), fmt::format("m{}", i), &marbles[ids.size()]));
    }
    store.flush();
    reset();
  }
  void reset() {
    rolls.order.clear();
    rolls.threads.clear();
  }
  void spin_all() {
    for (const NodeId id : ids) ASSERT_TRUE(set(store, id, "spin", {1}));
  }
  bool in_dirty_order() const { return std::is_sorted(rolls.order.begin(), rolls.order.end()); }
};

TEST_F(ManyMarbles, IndependentCallbacksRunInParallelOnceEach) {
  rolls.required_threads = 2;
  spin_all();
  store.flush(&pool);
  EXPECT_EQ(rolls.order.size(), ids.size());
  EXPECT_EQ(std::set<int>(rolls.order.begin(), rolls.order.end()).size(), ids.size());
  EXPECT_EQ(rolls.threads.size(), 2u);
}

TEST_F(ManyMarbles, OneDependentCallbackMakesAllRunInOrder) {
  for (int repetition = 0; repetition < kRepetitions; repetition++) {
    spin_all();
    ASSERT_TRUE(set(store, ids[kCount / 2], "weight", {1}));
    reset();
    store.flush(&pool);
    ASSERT_EQ(rolls.order.size(), ids.size());
    ASSERT_TRUE(in_dirty_order());
    ASSERT_EQ(rolls.threads, std::set{std::this_thread::get_id()});
  }
}

TEST_F(ManyMarbles, ANodeListedTwicePreventsParallelFlush) {
  for (int repetition = 0; repetition < kRepetitions; repetition++) {
    spin_all();
    store.flush(ids[3]);  // ahead of the others; it stays in the list
    ASSERT_TRUE(set(store, ids[3], "spin", {0}));
    reset();
    store.flush(&pool);
    ASSERT_EQ(rolls.order.size(), ids.size());
    ASSERT_EQ(rolls.threads, std::set{std::this_thread::get_id()});
  }
}

TEST_F(ManyMarbles, CheckpointRestoresDependentCallbacks) {
  Archive checkpoint;
  for (int repetition = 0; repetition < kRepetitions; repetition++) {
    spin_all();
    ASSERT_TRUE(set(store, ids[kCount / 2], "weight", {1}));
    checkpoint.begin_saving();
    store.serialize(checkpoint);
    store.flush();
    reset();
    checkpoint.begin_loading();
    store.serialize(checkpoint);
    store.flush(&pool);
    ASSERT_EQ(rolls.order.size(), ids.size());
    ASSERT_TRUE(in_dirty_order());
    ASSERT_EQ(rolls.threads, std::set{std::this_thread::get_id()});
  }
}

}  // namespace
}  // namespace limber
