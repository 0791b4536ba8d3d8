// Overrides: the last value for each address and names, in the order in which they were set.
#include "engine/edits/overrides.h"

#include "engine/show.h"

namespace limber::engine::test {
namespace {

std::vector<std::string> texts(const Overrides& overrides) {
  std::vector<std::string> list;
  for (const Override& step : overrides.in_order()) {
    list.push_back(step.message != nullptr ? text_of(*step.message)
                   : step.blend != nullptr ? "preset " + step.blend->a->name
                                           : "back " + *step.address);
  }
  return list;
}

TEST(Overrides, KeepTheLastMessagePerAddressAndNames) {
  Overrides overrides;
  EXPECT_TRUE(texts(overrides).empty());
  overrides.add(message("/physics/part/mass", 1));
  overrides.add(message("/physics/part/mass", "arm", 2));
  overrides.add(message("/physics/part/mass", "arm", "tip", 3));
  overrides.add(message("/physics/sim/gravity", 1, 2, 3));
  // all parts again: this is the newest now and replaces the earlier value of the arm
  overrides.add(message("/physics/part/mass", 4));
  EXPECT_EQ(texts(overrides), (std::vector<std::string>{"/physics/part/mass arm 2", "/physics/part/mass arm tip 3",
                                                        "/physics/sim/gravity 1 2 3", "/physics/part/mass 4"}));
  overrides.add(message("/physics/part/mass", "arm", "tip", 5));
  EXPECT_EQ(texts(overrides).back(), "/physics/part/mass arm tip 5");
  EXPECT_EQ(overrides.size(), 4U);
}

TEST(Overrides, ListReleasedValuesInOrder) {
  Overrides overrides;
  overrides.release("/physics/sim/gravity");
  EXPECT_TRUE(texts(overrides).empty()) << "there was no override before";
  overrides.add(message("/physics/part/mass", 1));
  overrides.release("/physics/body/arm/part/tip/mass");
  overrides.add(message("/physics/part/friction", 2));
  overrides.release("/physics/body/arm/part/tip/friction");
  EXPECT_EQ(texts(overrides),
            (std::vector<std::string>{"/physics/part/mass 1", "back /physics/body/arm/part/tip/mass",
                                      "/physics/part/friction 2", "back /physics/body/arm/part/tip/friction"}));
  overrides.add(message("/physics/part/mass", 3));
  overrides.release("/physics/body/arm/part/tip/friction");
  EXPECT_EQ(texts(overrides),
            (std::vector<std::string>{"back /physics/body/arm/part/tip/mass", "/physics/part/friction 2",
                                      "/physics/part/mass 3", "back /physics/body/arm/part/tip/friction"}));
}

TEST(Overrides, APresetReplacesOneOfTheSameProperties) {
  const auto preset = [](const std::string& name, const std::string& property) {
    PresetBuilder builder;
    PresetLayout layout;
    layout.add({property, PropertyType::number, 1, {}});
    builder.add("/scene", std::move(layout), {1});
    return builder.finish(name, {});
  };
  const auto dusk = preset("dusk", "wind");
  const auto dawn = std::make_shared<const Preset>(Preset{"dawn", {}, dusk->schema, {2}});
  Overrides overrides;
  overrides.add_recall(Blend::of(dusk));
  overrides.add(message("/scene/wind", 3));
  overrides.release("/scene/wind");
  overrides.add_recall(Blend::of(preset("other", "rain")));
  EXPECT_EQ(texts(overrides),
            (std::vector<std::string>{"preset dusk", "/scene/wind 3", "back /scene/wind", "preset other"}));
  overrides.add_recall(Blend::of(dawn));
  EXPECT_EQ(texts(overrides).size(), 4U);
  EXPECT_EQ(texts(overrides).back(), "preset dawn");
  EXPECT_EQ(texts(overrides).front(), "/scene/wind 3");
  for (int i = 0; i < 1000; i++) overrides.add_recall(Blend::of(preset("flood", "rain")));
  EXPECT_EQ(texts(overrides).size(), 66U) << "messages, released values and the newest 64 recalls";
}

TEST(Overrides, DistinguishTwoNamesFromOneLongName) {
  Overrides overrides;
  overrides.add(message("/a", "b", "c", 1));
  overrides.add(message("/a", "bc", 2));
  EXPECT_EQ(overrides.size(), 2U);
}

TEST(Overrides, LimitAFloodOfAddresses) {
  Overrides overrides;
  for (int i = 0; i < 70000; i++) overrides.add(message(fmt::format("/physics/body/b{}/part/p/mass", i), i));
  EXPECT_EQ(overrides.size(), 65536U);
  overrides.add(message("/physics/body/b5/part/p/mass", -1));
  EXPECT_EQ(texts(overrides).back(), "/physics/body/b5/part/p/mass -1") << "known overrides can still change";
}

}  // namespace
}  // namespace limber::engine::test
