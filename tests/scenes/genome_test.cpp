// The library genome, and scripts/morphology.lua.
#include <algorithm>
#include <cmath>
#include <string>

#include "player.h"
#include "sim/world/joint.h"

namespace limber {
namespace {

/// Plays a scene for a moment. The scene checks itself with assert().
std::string error_of(const std::string& text) {
  const ShowFolder files;
  const std::string path = files.write("check.lua", text);
  const Player player(path, Player::MayFail());
  return player.started.ok() ? "" : player.started.error();
}

// Two rules: a trunk with two limbs of the second rule, each of which has one limb of the same rule, and so on.
constexpr const char* kTwoRules = R"(
local genome = require "genome"
local trunk = { 0.3, 0.05, 0, 0, 0, 0, 0, 2, 1, 1 }
local limb = { 0.2, 0.03, 1, 0.5, 1, 0.4, 0.1, 1, 1, 0 }
local numbers = {}
for _, list in ipairs { trunk, limb } do
  for _, number in ipairs(list) do numbers[#numbers + 1] = number end
end
local function parents(tree)
  local list = {}
  for i, limb in ipairs(tree) do list[i] = limb.parent end
  return table.concat(list, " ")
end
local function expect(a, b) if a ~= b then error(tostring(a) .. " instead of " .. tostring(b), 2) end end
)";

TEST(Genome, GrowsTheLimbsOfItsRules) {
  EXPECT_EQ(error_of(std::string(kTwoRules) + R"(
expect(parents(genome.grow(numbers)), "0 1 1 2 3 4 5 6 7")        -- depth 4
expect(parents(genome.grow(numbers, { depth = 1 })), "0 1 1")
expect(parents(genome.grow(numbers, { parts = 4 })), "0 1 1 2")  -- the nearest to the trunk grow first
local tree = genome.grow(numbers)
expect(tree[1].length, 0.3)
expect(tree[4].rule, 2)
expect(tree[4].depth, 2)
expect(tree[9].radius, 0.03)
)"),
            "");
}

TEST(Genome, PrunesALimbWithAllThatGrowsFromIt) {
  EXPECT_EQ(error_of(std::string(kTwoRules) + R"(
local tree = genome.grow(numbers, { depth = 2 })
expect(parents(tree), "0 1 1 2 3")
expect(parents(genome.prune(tree, function(limb, i) return i ~= 2 end)), "0 1 2")
expect(parents(genome.prune(tree, function() return false end)), "0")
expect(parents(tree), "0 1 1 2 3")  -- the tree itself stays
)"),
            "");
}

// The mirrored body is symmetrical: for each part at y there is one at -y.
TEST(Genome, MirrorsRightAndLeft) {
  const ShowFolder files;
  const Player player(files.write("mirror.lua", std::string(kTwoRules) + R"(
local tree = genome.mirror(genome.grow(numbers, { depth = 2 }), 0.25)
expect(parents(tree), "0 1 1 2 3 1 1 6 7")
expect(tree[6].turn, -1)
expect(tree[6].lag, 0.25)
genome.build("body", tree)
)"));
  const sim::Body& body = player.body("body");
  ASSERT_EQ(body.parts().size(), 9u);
  double lowest = 1;
  for (std::size_t i = 1; i < 5; i++) {
    const Pose right = body.parts()[i]->pose();
    const Pose left = body.parts()[i + 4]->pose();
    EXPECT_GT(std::abs(right.position.y), 0.01);
    EXPECT_LT(glm::length(left.position - right.position * Vec3(1, -1, 1)), 1e-9);
    EXPECT_LT(glm::length(left.rotation * Vec3(0, 0, 1) - (right.rotation * Vec3(0, 0, 1)) * Vec3(1, -1, 1)), 1e-6);
  }
  for (const auto& part : body.parts()) {
    const Pose pose = part->pose();
    const double half = part->name() == "limb1" ? 0.15 : 0.1;
    const double radius = part->name() == "limb1" ? 0.05 : 0.03;
    lowest = std::min(lowest, pose.position.z - half * std::abs((pose.rotation * Vec3(0, 0, 1)).z) - radius);
  }
  EXPECT_NEAR(lowest, 0.01, 1e-6);
}

TEST(Genome, MutatesAndCrossesWithinTheRanges) {
  EXPECT_EQ(error_of(std::string(kTwoRules) + R"(
for i, number in ipairs(genome.mutate(numbers, 0)) do expect(number, numbers[i]) end
local other = genome.mutate(numbers, 3)
local changed = 0
for i, number in ipairs(other) do
  local gene = genome.genes[(i - 1) % #genome.genes + 1]
  assert(number >= gene[3] and number <= gene[4])
  if number ~= numbers[i] then changed = changed + 1 end
end
assert(changed >= 10, changed)
for _ = 1, 20 do
  local child = genome.cross(numbers, other)
  for rule = 0, 1 do  -- each rule is that of one parent
    local from = child[rule * 10 + 1] == numbers[rule * 10 + 1] and numbers or other
    for i = 1, 10 do expect(child[rule * 10 + i], from[rule * 10 + i]) end
  end
end
)"),
            "");
}

TEST(Genome, WrongListsAreExplained) {
  EXPECT_NE(error_of("local genome = require 'genome'\ngenome.grow({ 1, 2 })")
                .find("check.lua:2: genome.grow: the list must have 10 numbers per rule, not 2"),
            std::string::npos);
  EXPECT_NE(error_of("local genome = require 'genome'\ngenome.mutate(3)").find("not a number"), std::string::npos);
  EXPECT_NE(
      error_of("local genome = require 'genome'\nparams(genome.params(1, { 1 }))").find("check.lua:2: genome.params"),
      std::string::npos);
}

TEST(Genome, TheCreatureOfTheSceneWalks) {
  Player player("morphology.lua");
  const auto place = [&] { return player.body("creature").root()->pose().position; };
  player.play(2);
  const Vec3 rest = place();
  player.play(5);
  EXPECT_GT(glm::length(place() - rest), 2);
  EXPECT_EQ(player.engine->faults(), 0u);
  const std::size_t limbs = player.body("creature").parts().size();
  // another body while it plays
  player.send("/scene/limb1_branches", {Arg::of(0.0)});
  player.play(0.2);
  EXPECT_EQ(limbs, 5u);
  EXPECT_EQ(player.body("creature").parts().size(), 1u);
  EXPECT_EQ(player.engine->faults(), 0u);
}

}  // namespace
}  // namespace limber
