// The store's undo: values, marks and hidden nodes are as they were before a call that failed.
#include "params/store_undo.h"

#include <gtest/gtest.h>

#include "params/toy.h"

namespace limber {
namespace {

using test::read;
using test::set;
using test::Toy;
using Numbers = std::vector<double>;

struct StoreUndoTest : testing::Test {
  Store store;
  Toy toy;
  NodeId toys = store.add_group(store.root(), "toys");
  NodeId id = store.add(Toy::table(), toys, "bear", &toy);
  void SetUp() override {
    store.apply_marks();
    toy = {};
    toy.store = &store;
    toy.id = id;
  }
  const Row& row(const char* name) const { return Toy::table().at(name); }
};

TEST_F(StoreUndoTest, TakesBackWhatWasWritten) {
  ASSERT_TRUE(set(store, id, "size", {1, 1, 1}));
  store.begin_undo();
  for (double v : {4.0, 5.0, 6.0}) ASSERT_TRUE(set(store, id, "mass", {v}));
  ASSERT_TRUE(set(store, id, "size", {2, 2, 2}));
  ASSERT_TRUE(set(store, id, "position", {7, 8, 9}));
  store.keep(id, row("speed"));
  store.tell(id, row("speed"))[0] = 3;
  store.take_back();
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
  EXPECT_EQ(read(store, id, "size"), (Numbers{1, 1, 1}));
  EXPECT_EQ(read(store, id, "position"), (Numbers{0, 0, 0}));
  EXPECT_EQ(read(store, id, "speed"), Numbers{0});
}

TEST_F(StoreUndoTest, AGoodCallStays) {
  store.begin_undo();
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.end_undo();
  store.begin_undo();
  store.take_back();
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 1);
}

TEST_F(StoreUndoTest, NothingIsKeptOutsideOfACall) {
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.begin_undo();
  store.take_back();
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
}

TEST_F(StoreUndoTest, EffectsWaitAsBefore) {
  // one that waited goes on waiting; one that the call asked for is forgotten
  ASSERT_TRUE(set(store, id, "mass", {4}));
  store.begin_undo();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  store.take_back();
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 1);
  EXPECT_EQ(toy.pose_effects, 0);
  EXPECT_EQ(read(store, id, "mass"), Numbers{4});
}

TEST_F(StoreUndoTest, AnEffectThatRanMeanwhileRunsAgain) {
  store.begin_undo();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  ASSERT_TRUE(set(store, id, "position", {1, 1, 1}));
  store.apply_marks(id);
  EXPECT_EQ(toy.mass_effects, 1);
  EXPECT_EQ(toy.pose_effects, 1);
  store.take_back();
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 2);
  EXPECT_EQ(toy.pose_effects, 1);  // live ones are undone by their owner
}

TEST_F(StoreUndoTest, EffectsOfOthersKeepTheirTurn) {
  Toy other;
  const NodeId second = store.add(Toy::table(), toys, "hare", &other);
  store.apply_marks();
  // only the failing call marked the first; what is marked after it must not run ahead of others through that
  store.begin_undo();
  ASSERT_TRUE(set(store, id, "mass", {5}));
  store.take_back();
  ASSERT_TRUE(set(store, second, "mass", {5}));
  other.mass_effects = 0;
  store.apply_marks();
  EXPECT_EQ(toy.mass_effects, 0);
  EXPECT_EQ(other.mass_effects, 1);
}

TEST_F(StoreUndoTest, WhatWasMadeInTheCallIsPassedOver) {
  store.begin_undo();
  const NodeId made = store.add(Toy::table(), toys, "made", &toy);
  ASSERT_TRUE(set(store, made, "mass", {5}));
  ASSERT_TRUE(set(store, id, "mass", {5}));
  store.remove(made);
  store.take_back();
  EXPECT_FALSE(store.alive(made));
  EXPECT_EQ(read(store, id, "mass"), Numbers{1});
}

TEST_F(StoreUndoTest, AHiddenNodeIsGoneUntilItIsShown) {
  const NodeId second = store.add(Toy::table(), toys, "hare", &toy);
  const NodeId below = store.add(Toy::table(), id, "cub", &toy);
  ASSERT_TRUE(set(store, below, "mass", {7}));
  const std::size_t place = store.hide(id);
  EXPECT_EQ(place, 0u);
  EXPECT_FALSE(store.alive(id));
  EXPECT_FALSE(store.alive(below));
  EXPECT_TRUE(store.child(toys, "bear").null());
  ASSERT_EQ(store.children(toys).size(), 1u);
  // its name is free meanwhile, its slot is not
  const NodeId same = store.add(Toy::table(), toys, "bear", &toy);
  EXPECT_NE(same.slot, id.slot);
  store.remove(same);
  store.show(id, place);
  EXPECT_TRUE(store.alive(id));
  EXPECT_EQ(store.child(toys, "bear"), id);
  EXPECT_EQ(store.child(id, "cub"), below);
  EXPECT_EQ(read(store, below, "mass"), Numbers{7});
  ASSERT_EQ(store.children(toys).size(), 2u);
  EXPECT_EQ(store.children(toys)[0], id);
  EXPECT_EQ(store.children(toys)[1], second);
}

TEST_F(StoreUndoTest, ADroppedNodeGivesItsSlotsBack) {
  const NodeId below = store.add(Toy::table(), id, "cub", &toy);
  const std::size_t slots = store.view()->slot_count;
  store.hide(id);
  store.drop_hidden(id);
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
