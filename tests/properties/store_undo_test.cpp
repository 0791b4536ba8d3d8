// Transactions of the store: a rollback restores values, dirty flags and hidden nodes.
#include "properties/store_transaction.h"

#include <gtest/gtest.h>

#include "properties/toy.h"

namespace limber {
namespace {

using test::read;
using test::set;
using test::Toy;
using Numbers = std::vector<double>;

struct StoreTransactionTest : testing::Test {
  Store store;
  Toy toy;
  NodeId toys = store.add_group(store.root(), "toys");
  NodeId id = store.add(Toy::table(), toys, "bear", &toy);
  void SetUp() override {
    begin();
    store.flush();
    begin();
  }
  // Resets the counters of callbacks.
  void begin() {
    toy = {};
    toy.store = &store;
    toy.id = id;
  }
  const Property& property(const char* name) const { return Toy::table().at(name); }
};

TEST_F(StoreTransactionTest, RollsBackWrites) {
  ASSERT_TRUE(set(store, id, "size", {1, 1, 1}));
  store.begin_transaction();
  for (double v : {4.0, 5.0, 6.0}) ASSERT_TRUE(set(store, id, "mass", {v}));
  ASSERT_TRUE(set(store, id, "size", {2, 2, 2}));
  ASSERT_TRUE(set(store, id, "position", {7, 8, 9}));
  store.save_before_write(id, property("speed"));
  store.mutable_values(id, property("speed"))[0] = 3;
  store.rollback();
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
  EXPECT_EQ(read(store, id, "size"), (Numbers{1, 1, 1}));
  EXPECT_EQ(read(store, id, "position"), (Numbers{0, 0, 0}));
  EXPECT_EQ(read(store, id, "speed"), Numbers{0});
}

TEST_F(StoreTransactionTest, CommitKeepsWrites) {
  store.begin_transaction();
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.commit_transaction();
  store.begin_transaction();
  store.rollback();
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 1);
}

TEST_F(StoreTransactionTest, WritesOutsideATransactionAreNotLogged) {
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.begin_transaction();
  store.rollback();
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
}

TEST_F(StoreTransactionTest, RollbackRestoresDirtyFlags) {
  // A pending callback stays pending; one that the transaction added is removed.
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.begin_transaction();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  store.rollback();
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 1);
  EXPECT_EQ(toy.pose_callbacks, 0);
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
}

TEST_F(StoreTransactionTest, RollbackMarksFlushedPropertiesDirty) {
  store.begin_transaction();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  store.flush(id);
  EXPECT_EQ(toy.mass_callbacks, 1);
  EXPECT_EQ(toy.pose_callbacks, 1);
  store.rollback();
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 2);
  EXPECT_EQ(toy.pose_callbacks, 1);  // the owner restores transient values
}

TEST_F(StoreTransactionTest, RollbackKeepsTheOrderOfCallbacks) {
  Toy other;
  const NodeId second = store.add(Toy::table(), toys, "hare", &other);
  other.store = &store;
  other.id = second;
  store.flush();
  // Only the failing transaction marked the first node dirty. Later marks must not use its position in the order.
  store.begin_transaction();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  store.rollback();
  ASSERT_TRUE(set(store, second, "mass", {5}));
  other.mass_callbacks = 0;
  store.flush();
  EXPECT_EQ(toy.mass_callbacks, 0);
  EXPECT_EQ(other.mass_callbacks, 1);
}

TEST_F(StoreTransactionTest, RollbackIgnoresRemovedNodes) {
  store.begin_transaction();
  const NodeId made = store.add(Toy::table(), toys, "made", &toy);
  ASSERT_TRUE(set(store, made, "mass", {5}));
  ASSERT_TRUE(set(store, id, "mass", {5}));
  store.remove(made);
  store.rollback();
  EXPECT_FALSE(store.alive(made));
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
}

TEST_F(StoreTransactionTest, HiddenNodeIsInvisibleUntilShown) {
  const NodeId second = store.add(Toy::table(), toys, "hare", &toy);
  const NodeId below = store.add(Toy::table(), id, "cub", &toy);
  ASSERT_TRUE(set(store, below, "mass", {7}));
  const std::size_t position = store.hide(id);
  EXPECT_EQ(position, 0u);
  EXPECT_FALSE(store.alive(id));
  EXPECT_FALSE(store.alive(below));
  EXPECT_TRUE(store.child(toys, "bear").null());
  ASSERT_EQ(store.children(toys).size(), 1u);
  // Its name is free meanwhile, its slot is not.
  const NodeId same = store.add(Toy::table(), toys, "bear", &toy);
  EXPECT_NE(same.slot, id.slot);
  store.remove(same);
  store.show(id, position);
  EXPECT_TRUE(store.alive(id));
  EXPECT_EQ(store.child(toys, "bear"), id);
  EXPECT_EQ(store.child(id, "cub"), below);
  EXPECT_EQ(read(store, below, "mass"), Numbers{7});
  ASSERT_EQ(store.children(toys).size(), 2u);
  EXPECT_EQ(store.children(toys)[0], id);
  EXPECT_EQ(store.children(toys)[1], second);
}

TEST_F(StoreTransactionTest, RemovingAHiddenNodeFreesItsSlots) {
  const NodeId below = store.add(Toy::table(), id, "cub", &toy);
  const std::size_t slots = store.view()->slot_count;
  store.hide(id);
  store.remove_hidden(id);
  EXPECT_FALSE(store.alive(id));
  EXPECT_FALSE(store.alive(below));
  const NodeId one = store.add(Toy::table(), toys, "bear", &toy);
  const NodeId two = store.add(Toy::table(), one, "cub", &toy);
  EXPECT_EQ(store.view()->slot_count, slots);
  EXPECT_EQ(read(store, two, "mass"), Numbers{1});
  EXPECT_FALSE(store.alive(id));
}

}  // namespace
}  // namespace limber
