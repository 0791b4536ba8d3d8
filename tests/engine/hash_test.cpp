// The state hash: the same for the same state, another one for every single bit that is part of it.
#include <bit>
#include <cmath>

#include "engine/everything.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

// what can be set belongs to the state, but whether it is paused, how fast and how it is shown; readouts follow from it
bool is_part(const Table& table, const Row& row) {
  if (!row.stored() || !row.writable() || &table == &Transport::table() || &table == &CounterNode::table())
    return false;
  if (&table == &Look::table() && row.name == "overlay") return false;
  return !(&table == &World::table() && (row.name == "paused" || row.name == "speed" || row.name == "history"));
}

TEST(Hash, EveryChangedBitChangesIt) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(3);
  Store& store = show.engine.store();
  const std::uint64_t hash = show.engine.state_hash();
  int numbers = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Row& row : store.table(id).rows()) {
      if (!is_part(store.table(id), row)) continue;
      for (std::uint32_t i = 0; i < row.width; i++) {
        double& value = store.tell(id, row)[i];
        const double was = value;
        // a count or a switch has no smaller change than one; of a measure it is the last bit
        const bool whole = row.type == RowType::boolean || row.type == RowType::flags3 ||
                           row.type == RowType::integer || row.type == RowType::choice;
        value = whole ? (was == 0 ? 1 : was - 1) : std::bit_cast<double>(std::bit_cast<std::uint64_t>(was) ^ 1u);
        EXPECT_NE(show.engine.state_hash(), hash) << store.path(id) << "/" << row.name << " [" << i << "]";
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
  EXPECT_NE(hash_of(one, 1, 9), hash_of(three, 1, 9)) << "a draw more or less";
}

}  // namespace
}  // namespace limber::engine_test
