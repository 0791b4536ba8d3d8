// The state hash: equal for equal states, and different if a single bit of the state differs.
#include <bit>
#include <cmath>

#include "engine/edited.h"
#include "engine/everything.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

// writable values belong to the state, except pause, speed and appearance; readouts are derived from it
bool is_hashed(const PropertyTable& table, const Property& property) {
  if (!property.stored() || !property.writable() || &table == &Transport::table() || &table == &CounterNode::table())
    return false;
  if (&table == &sim::Appearance::table() && property.name == "overlay") return false;
  if (table.path() == "/lighting") return false;  // part of it with fixtures only, see tests/sim/fixture_test.cpp
  return !(&table == &sim::World::table() &&
           (property.name == "paused" || property.name == "speed" || property.name == "history"));
}

TEST(Hash, ChangesWithEveryBit) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(3);
  Store& store = show.engine.store();
  const std::uint64_t hash = show.engine.state_hash();
  int numbers = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Property& property : store.table(id).properties()) {
      if (!is_hashed(store.table(id), property)) continue;
      for (std::uint32_t i = 0; i < property.width; i++) {
        double& value = store.mutable_values(id, property)[i];
        const double was = value;
        // the smallest change of a count or a flag is 1; that of a measure is the last bit
        const bool whole = property.type == PropertyType::boolean || property.type == PropertyType::flags3 ||
                           property.type == PropertyType::integer || property.type == PropertyType::choice;
        value = whole ? (was == 0 ? 1 : was - 1) : std::bit_cast<double>(std::bit_cast<std::uint64_t>(was) ^ 1u);
        EXPECT_NE(show.engine.state_hash(), hash) << store.path(id) << "/" << property.name << " [" << i << "]";
        value = was;
        numbers++;
      }
    }
  });
  EXPECT_EQ(show.engine.state_hash(), hash);
  EXPECT_GT(numbers, 500);
}

TEST(Hash, DependsOnSeedNamesAndDraws) {
  const auto hash_of = [](const std::string& text, std::uint64_t seed, int ticks) {
    const SceneFile scene(text);
    EngineOptions options = fast_options(scene.path());
    options.scene_options.seed = seed;
    Show show(options);
    show.ticks(ticks);
    return show.engine.state_hash();
  };
  const std::string one = "sim:add_body('a')\nsim:at(0.05, function() rng:uniform() end)\n";
  const std::string two = "sim:add_body('b')\nsim:at(0.05, function() rng:uniform() end)\n";
  const std::string three = "sim:add_body('a')\nsim:at(0.05, function() end)\n";
  EXPECT_EQ(hash_of(one, 1, 9), hash_of(one, 1, 9));
  EXPECT_NE(hash_of(one, 1, 9), hash_of(one, 2, 9));
  EXPECT_NE(hash_of(one, 1, 9), hash_of(one, 1, 10));
  EXPECT_NE(hash_of(one, 1, 9), hash_of(two, 1, 9));
  EXPECT_NE(hash_of(one, 1, 9), hash_of(three, 1, 9)) << "one more random draw";
}

// Returns the state hash after 20 ticks of a scene with a behavior file. `name`: file name of the scene.
std::uint64_t hash_of_show(const std::string& scene, const std::string& behavior, const std::string& name,
                           bool hash_each_tick = false) {
  const ShowFolder folder;
  folder.write("scripts/" + name, scene);
  folder.write("behaviors_lua/nod.lua", behavior);
  Show show(folder.path("scripts/" + name));
  for (int i = 0; i < 20; i++) {
    if (hash_each_tick) (void)show.engine.state_hash();
    show.ticks(1);
  }
  return show.engine.state_hash();
}

constexpr const char* kNodScene = R"(
params { { "wind", 0.5, min = 0, max = 2 }, --NEW
}
local arm = sim:load_urdf(")" LIMBER_SOURCE_DIR R"(/urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("nod", "nod", { depth = 0.3 })
sim:at(0.1, function() params.wind = 0.75 end)
)";
constexpr const char* kNod = R"(return behavior {
  params = { --NEW
    { "depth", 0.1, min = 0, max = 1 } },
  step = function(self) for _, motor in ipairs(self.motors) do motor.target = self.depth end end,
}
)";

std::string with_parameters(std::string text, const std::string& added) {
  return text.replace(text.find("--NEW"), 5, added);
}

TEST(Hash, IgnoresNewParametersAtTheirDefaults) {
  const std::uint64_t before = hash_of_show(kNodScene, kNod, "nod.lua");
  const std::string added = R"({ "lift", vec3(1, 2, 3) }, { "style", "calm", choices = { "calm", "wild" } },)";
  EXPECT_EQ(hash_of_show(with_parameters(kNodScene, added), kNod, "nod.lua"), before);
  EXPECT_EQ(hash_of_show(kNodScene, with_parameters(kNod, added), "nod.lua"), before);
  const std::string other = "arm:behavior('nod').style = 'wild'\n";
  EXPECT_NE(hash_of_show(kNodScene + other, with_parameters(kNod, added), "nod.lua"), before);
  EXPECT_NE(hash_of_show(with_parameters(kNodScene, added) + "sim:at(0.2, function() params.style = 'wild' end)\n",
                         kNod, "nod.lua"),
            before);
}

TEST(Hash, IgnoresUnusedGenerators) {
  // a scene's generator is seeded with the name of its file
  EXPECT_EQ(hash_of_show(kNodScene, kNod, "a.lua"), hash_of_show(kNodScene, kNod, "b.lua"));
  const std::string draws = std::string(kNodScene) + "sim:at(0.1, function() rng:uniform() end)\n";
  EXPECT_NE(hash_of_show(draws, kNod, "a.lua"), hash_of_show(kNodScene, kNod, "a.lua"));
  EXPECT_NE(hash_of_show(draws, kNod, "a.lua"), hash_of_show(draws, kNod, "b.lua"));
}

TEST(Hash, ComputingItChangesNothing) {
  // the seed at the time of the first draw counts
  const std::string scene = std::string(kNodScene) + R"(
sim:at(0.1, function() sim.seed = 5 end)
sim:at(0.2, function() arm:part("tip"):apply_impulse(rng:direction()) end)
)";
  EXPECT_EQ(hash_of_show(scene, kNod, "a.lua", true), hash_of_show(scene, kNod, "a.lua", false));
}

}  // namespace
}  // namespace limber::engine::test
