// The performer's hand: the last value for each address and names, the newest last.
#include "engine/hand.h"

#include "engine/show.h"

namespace limber::engine_test {
namespace {

std::vector<std::string> texts(const PerformerHand& hand) {
  std::vector<std::string> list;
  for (const HandStep& step : hand.in_order()) {
    list.push_back(step.message != nullptr ? text_of(*step.message)
                   : step.blend != nullptr ? "preset " + step.blend->a->name
                                           : "back " + *step.address);
  }
  return list;
}

TEST(PerformerHand, KeepsTheLastForEachAddressAndNames) {
  PerformerHand hand;
  EXPECT_TRUE(texts(hand).empty());
  hand.remember(message("/physics/part/mass", 1));
  hand.remember(message("/physics/part/mass", "arm", 2));
  hand.remember(message("/physics/part/mass", "arm", "tip", 3));
  hand.remember(message("/physics/sim/gravity", 1, 2, 3));
  // all parts again: this is the newest now, the arm's value before it no longer counts where both reach
  hand.remember(message("/physics/part/mass", 4));
  EXPECT_EQ(texts(hand), (std::vector<std::string>{"/physics/part/mass arm 2", "/physics/part/mass arm tip 3",
                                                   "/physics/sim/gravity 1 2 3", "/physics/part/mass 4"}));
  hand.remember(message("/physics/part/mass", "arm", "tip", 5));
  EXPECT_EQ(texts(hand).back(), "/physics/part/mass arm tip 5");
  EXPECT_EQ(hand.size(), 4U);
}

TEST(PerformerHand, WhatAReloadGaveBackStandsInTheOrder) {
  PerformerHand hand;
  hand.give_back("/physics/sim/gravity");
  EXPECT_TRUE(texts(hand).empty()) << "nothing was set by hand before";
  hand.remember(message("/physics/part/mass", 1));
  hand.give_back("/physics/body/arm/part/tip/mass");
  hand.remember(message("/physics/part/friction", 2));
  hand.give_back("/physics/body/arm/part/tip/friction");
  EXPECT_EQ(texts(hand),
            (std::vector<std::string>{"/physics/part/mass 1", "back /physics/body/arm/part/tip/mass",
                                      "/physics/part/friction 2", "back /physics/body/arm/part/tip/friction"}));
  hand.remember(message("/physics/part/mass", 3));
  hand.give_back("/physics/body/arm/part/tip/friction");
  EXPECT_EQ(texts(hand),
            (std::vector<std::string>{"back /physics/body/arm/part/tip/mass", "/physics/part/friction 2",
                                      "/physics/part/mass 3", "back /physics/body/arm/part/tip/friction"}));
}

TEST(PerformerHand, APresetReplacesOneOfTheSameRows) {
  const auto preset = [](const std::string& name, const std::string& row) {
    PresetBuilder builder;
    PresetClass rows;
    rows.add({row, RowType::number, 1, {}});
    builder.give(builder.thing("/scene"), std::move(rows), {1});
    return builder.finish(name, {});
  };
  const auto dusk = preset("dusk", "wind");
  const auto dawn = std::make_shared<const Preset>(Preset{"dawn", {}, dusk->shape, {2}});
  PerformerHand hand;
  hand.recall(Blend::of(dusk));
  hand.remember(message("/scene/wind", 3));
  hand.give_back("/scene/wind");
  hand.recall(Blend::of(preset("other", "rain")));
  EXPECT_EQ(texts(hand),
            (std::vector<std::string>{"preset dusk", "/scene/wind 3", "back /scene/wind", "preset other"}));
  hand.recall(Blend::of(dawn));
  EXPECT_EQ(texts(hand).size(), 4U);
  EXPECT_EQ(texts(hand).back(), "preset dawn");
  EXPECT_EQ(texts(hand).front(), "/scene/wind 3");
  for (int i = 0; i < 1000; i++) hand.recall(Blend::of(preset("flood", "rain")));
  EXPECT_EQ(texts(hand).size(), 66U) << "messages, what was given back, and the newest 64";
}

TEST(PerformerHand, TwoNamesAreNotOneLongName) {
  PerformerHand hand;
  hand.remember(message("/a", "b", "c", 1));
  hand.remember(message("/a", "bc", 2));
  EXPECT_EQ(hand.size(), 2U);
}

TEST(PerformerHand, AFloodOfAddressesEnds) {
  PerformerHand hand;
  for (int i = 0; i < 70000; i++) hand.remember(message(fmt::format("/physics/body/b{}/part/p/mass", i), i));
  EXPECT_EQ(hand.size(), 65536U);
  hand.remember(message("/physics/body/b5/part/p/mass", -1));
  EXPECT_EQ(texts(hand).back(), "/physics/body/b5/part/p/mass -1") << "what is known can still change";
}

}  // namespace
}  // namespace limber::engine_test
