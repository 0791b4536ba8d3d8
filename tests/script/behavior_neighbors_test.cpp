// self:neighbors and self.neighbor_parts of a group's members in Lua.
#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber::script {
namespace {

// bodies with one ball each at x = 1, 2, 3 … m; a group of the type "test" on all of them
std::string row_of_balls(int count, const std::string& opts = "{}") {
  return "sim.gravity = vec3()\nlocal ball = sim:add_sphere_shape('ball', 0.1)\nfor i = 1, " + std::to_string(count) +
         " do sim:add_body('b' .. i):add_part('ball', ball, { mass = i, position = vec3(i, 0, 0) }) end\n"
         "local group = sim:add_group_behavior('test', 'swarm', " +
         opts + ")\n";
}

std::string group(const std::string& step) {
  return "return behavior { group = true, params = { { 'radius', 1.5 } }, step = function(self)\n" + step + "\nend }";
}

std::vector<std::string> output_of_step(const std::string& step, const std::string& opts = "{}") {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", group(step));
  EXPECT_EQ(fixture.play(row_of_balls(4, opts), 1), "");
  for (const auto& body : fixture.world.bodies()) {
    for (const sim::Behavior* behavior : body->behaviors().list()) EXPECT_EQ(behavior->error(), "");
  }
  return fixture.host.printed;
}

using Lines = std::vector<std::string>;

TEST(BehaviorNeighbors, AreSortedAndWithinTheRadius) {
  EXPECT_EQ(
      output_of_step("local text = self.body.name .. ':' for other, offset, distance in self:neighbors(self.parts[1], "
                     "self.radius) do text = text .. ' ' .. other.body.name .. ' ' .. offset.x .. ' ' .. distance end "
                     "print(text)"),
      (Lines{"b1: b2 1 1", "b2: b1 -1 1 b3 1 1", "b3: b2 -1 1 b4 1 1", "b4: b3 -1 1"}));
}

TEST(BehaviorNeighbors, RadiusZeroFindsNone) {
  EXPECT_EQ(output_of_step("local n = 0 for _ in self:neighbors(self.parts[1], -1) do n = n + 1 end print(n)"),
            (Lines{"0", "0", "0", "0"}));
}

TEST(BehaviorNeighbors, LoopsCanBeNested) {
  // the neighbors of each neighbor, excluding its own body at both levels
  EXPECT_EQ(
      output_of_step(
          "if self.body.name ~= 'b2' then return end local names = {}\n"
          "for other in self:neighbors(self.parts[1], 1.5) do\n"
          "  for next in self:neighbors(other, 1.5) do names[#names + 1] = other.body.name .. next.body.name end\n"
          "end print(table.concat(names, ' '))"),
      (Lines{"b1b2 b3b2 b3b4"}));
}

TEST(BehaviorNeighbors, NeighborPartsExcludeTheOwnBody) {
  EXPECT_EQ(
      output_of_step("local names = {} for i, part in ipairs(self.neighbor_parts) do names[i] = part.body.name end "
                     "print(#self.neighbor_parts, table.concat(names, ' '))",
                     "{ bodies = { 'b1', 'b2', 'b4' } }"),
      (Lines{"2\tb2 b4", "2\tb1 b4", "2\tb1 b2"}));
}

TEST(BehaviorNeighbors, FollowAddedAndRemovedBodies) {
  BehaviorFixture fixture;
  fixture.write(
      "behaviors_lua/test.lua",
      group("local text = self.body.name .. ':' for other in self:neighbors(self.parts[1], 1.5) do text = text "
            ".. ' ' .. other.body.name end print(text .. ' of ' .. #self.neighbor_parts)"));
  ASSERT_EQ(fixture.play(row_of_balls(2) + R"(
sim:after(0.01, function() sim:body("b2"):copy("b3", { position = vec3(3, 0, 0) }) end)
sim:after(0.03, function() sim:body("b2"):remove() end)
)",
                         3),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"b1: b2 of 1", "b2: b1 of 1",                    //
                                         "b1: b2 of 2", "b2: b1 b3 of 2", "b3: b2 of 2",  //
                                         "b1: of 1", "b3: of 1"}));
}

// compares neighbor_means and neighbor_push with sums over an iteration
constexpr const char* kCompareMeans = R"(
local part, wrong = self.parts[1], {}
local function same(what, a, b) if (a - b):length() > 1e-4 then wrong[#wrong + 1] = what end end
local asked = 0
for _, range in ipairs { vec3(0, 1.5, 0), vec3(0.5, 2.2, 0), vec3(0, 100, 0), vec3(2, 1, 0) } do
  local near, far = range.x, range.y
  local n, offset, velocity, spin, push = 0, vec3(), vec3(), vec3(), vec3()
  for other, way, distance in self:neighbors(part, far) do
    if distance >= near then
      n, offset, push = n + 1, offset + way, push + way:normalized() * (1 - distance / far)
      velocity = velocity + other.linear_velocity - part.linear_velocity
      spin = spin + other.angular_velocity - part.angular_velocity
    end
  end
  local m, middle, motion, turning = self:neighbor_means(part, near, far)
  if m ~= n then wrong[#wrong + 1] = m .. " of " .. n end
  local share = 1 / math.max(n, 1)
  same("offset", middle, offset * share)
  same("velocity", motion, velocity * share)
  same("spin", turning, spin * share)
  same("push", self:neighbor_push(part, near, far), push * share)
  asked = asked + n
end
print(self.body.name .. ' ' .. asked .. ' ' .. table.concat(wrong, ' ')))";

Lines compare_with_iteration(const std::string& opts) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", group(kCompareMeans));
  EXPECT_EQ(fixture.play(R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape('ball', 0.1)
for i = 1, 4 do
  local body = sim:add_body('b' .. i)
  for k, name in ipairs { 'ball', 'eye' } do
    local part = body:add_part(name, ball, { mass = i, position = vec3(i, k / 3, i * i / 9) })
    part.linear_velocity, part.angular_velocity = vec3(i, -k, 0.5), vec3(0, i * k, 2)
  end
end
sim:add_group_behavior('test', 'swarm', )" +
                             opts + ")",
                         2),
            "");
  for (const auto& body : fixture.world.bodies()) EXPECT_EQ(body->behaviors().list()[0]->error(), "");
  return fixture.host.printed;
}

TEST(BehaviorNeighbors, MeansMatchAnIteration) {
  for (const std::string opts : {"{ parts = 'ball' }", "{}"}) {
    const Lines all = compare_with_iteration(opts);
    ASSERT_EQ(all.size(), 8u);
    for (const std::string& line : all) EXPECT_TRUE(line.ends_with(" ") && !line.ends_with(" 0 ")) << line;
  }
  // a part that is not a neighbor of others itself
  const Lines eyes = compare_with_iteration("{ parts = 'ball', neighbor_parts = 'eye' }");
  ASSERT_EQ(eyes.size(), 8u);
  for (const std::string& line : eyes) EXPECT_TRUE(line.ends_with(" ")) << line;
}

// two bodies with two balls each, and an eye on each; two groups use them as neighbors, one the balls, one the eyes
Lines seen_by_two_groups(const std::string& step) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", "local seen = {}\n" + group(R"(
local function show(of)
  local n, way = of:neighbor_means(of.parts[1], 0, 2.5)
  print(string.format('%s/%s %d %.17g %.17g', of.name, of.body.name, n, way.x, way.y))
end
)" + step));
  EXPECT_EQ(fixture.play(R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape('ball', 0.1)
for i = 1, 5 do
  local body = sim:add_body('b' .. i)
  body:add_part('ball', ball, { position = vec3(i, i * i / 10, 0) })
  body:add_part('eye', ball, { position = vec3(i + 0.3, 1, 0) })
end
sim:add_group_behavior('test', 'balls', { parts = 'ball' })
sim:add_group_behavior('test', 'eyes', { parts = 'ball', neighbor_parts = 'eye' })
)",
                         2),
            "");
  for (const auto& body : fixture.world.bodies()) {
    for (const sim::Behavior* behavior : body->behaviors().list()) EXPECT_EQ(behavior->error(), "");
  }
  return fixture.host.printed;
}

TEST(BehaviorNeighbors, MeansAreReadFromTheCachedGroupResult) {
  const Lines lines = seen_by_two_groups("show(self)");
  ASSERT_EQ(lines.size(), 20u);
  EXPECT_NE(lines[0].substr(lines[0].find(' ')), lines[5].substr(lines[5].find(' ')));
  // a query with other arguments calls the API
  EXPECT_EQ(seen_by_two_groups("self:neighbor_means(self.parts[1], 0, 1) show(self)"), lines);
  EXPECT_EQ(seen_by_two_groups("self:neighbor_push(self.parts[1], 0, 2.5) show(self)"), lines);
  // a query by another member uses its own group
  const Lines mixed = seen_by_two_groups(
      "seen[self.name .. self.body.name] = self show(self) "
      "if self.name == 'eyes' then show(seen['balls' .. self.body.name]) end");
  ASSERT_EQ(mixed.size(), 30u);
  for (std::size_t i = 0; i < 5; i++) {
    EXPECT_EQ(mixed[5 + 2 * i], lines[5 + i]);
    EXPECT_EQ(mixed[6 + 2 * i], lines[i]);
  }
}

TEST(BehaviorNeighbors, MeansOfARemovedPartAreErrors) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", "local first\n" + group(R"(
first = first or self.parts[1]
self:neighbor_means(self.parts[1], 0, 2)
if self.body.name == 'b2' then sim:body('b1'):remove() end
if self.body.name == 'b3' then self:neighbor_means(first, 0, 2) end
)"));
  EXPECT_EQ(fixture.play(row_of_balls(3), 1), "");
  EXPECT_EQ(first_line(fixture.world.find_body("b3")->behaviors().find("swarm")->error()),
            "behaviors_lua/test.lua:7: part 'b1/ball' no longer exists (check its .alive)");
  EXPECT_EQ(fixture.world.find_body("b2")->behaviors().find("swarm")->error(), "");
}

TEST(BehaviorNeighbors, MistakesAreExplained) {
  const auto error = [](const std::string& step) {
    BehaviorFixture fixture;
    fixture.write("behaviors_lua/test.lua", group(step));
    EXPECT_EQ(fixture.play(row_of_balls(1), 1), "");
    return first_line(fixture.world.find_body("b1")->behaviors().find("swarm")->error());
  };
  const std::string at = "behaviors_lua/test.lua:2: ";
  EXPECT_EQ(error("self:neighbors(3, 1)"), at + "behavior 'b1/swarm': neighbors are those of a part, not of 3");
  EXPECT_EQ(error("self:neighbors(self.body, 1)"),
            at + "behavior 'b1/swarm': neighbors are those of a part, not of body 'b1'");
  EXPECT_EQ(error("self:neighbors(self.parts[1])"), at + "neighbors: the radius takes a number, not nothing");
  EXPECT_EQ(error("self:neighbors(self.parts[1], 0/0)"), at + "neighbors: the radius takes a finite number, not nan");
  EXPECT_EQ(error("self:neighbor_means(self.parts[1], 1)"),
            at + "neighbor_means: a distance takes a number, not nothing");
  EXPECT_EQ(error("self:neighbor_push(self.parts[1], 0, 0/0)"),
            at + "neighbor_push: a distance takes a finite number, not nan");
  EXPECT_EQ(error("self:neighbor_means(self, 0, 1)"),
            at + "behavior 'b1/swarm': neighbors are those of a part, not of behavior 'b1/swarm'");
  EXPECT_EQ(error("self.neighbors(self.parts[1], 1)"),
            at + "neighbors is a method of a behavior: write it with a colon, behavior:neighbors(…), not with a dot");
  EXPECT_EQ(step_output("self:neighbors(self.parts[1], 1)").substr(0, 72),
            "behaviors_lua/test.lua:2: behavior 'ball/it' has no property 'neighbors'")
      << "only members of a group have neighbors";
}

}  // namespace
}  // namespace limber::script
