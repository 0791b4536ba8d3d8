// The built-in behaviours and their twins in Lua: the same rows, the same motion. The twins prove that the interface of
// behaviors_lua/ is complete.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "behavior_stage.h"

namespace limber {
namespace {

// what each type is given, other than the defaults; `group`: attached to all bodies
struct Twin {
  const char* type;
  const char* opts;
  bool group = false;
};

std::ostream& operator<<(std::ostream& out, const Twin& twin) { return out << twin.type; }

constexpr Twin kTwins[] = {
    {"force", "{ parts = '*[123]', dir = vec3(1, 2, -1), amp = 0.4, max_amp = 0.3, app_interval = 40 }"},
    {"torque", "{ torque = vec3(0.002, -0.001, 0.003), scale = -1.5, app_interval = 25 }"},
    {"random_force",
     "{ parts = '*2', min_dir = vec3(-1, 0, -1), min_amp = -0.2, max_amp = 0.5, rand_interval = 330, "
     "app_interval = 50 }"},
    {"random_torque", "{ min_torque = vec3(-2, -1, 0), scale = 0.002, rand_interval = 450, app_interval = 20 }"},
    {"speed", "{ speed = 0.7, amount = 0.6 }"},
    {"target_attraction",
     "{ target_pos = vec3(0.5, -0.3, 0.8), min_dist = 0.2, max_dist = 6, min_amp = -0.1, max_amp "
     "= 1.5, app_interval = 30 }"},
    {"volume", "{ max_dist = 2, min_amp = -0.1, max_amp = 0.4, app_interval = 35 }"},
    {"rotation_target", "{ target = vec3(0, 0, 2), speed = 0.05, app_interval = 30 }"},
    {"random_rotation_target",
     "{ min_target = vec3(0, 0, -1.2), max_target = vec3(0, 0, 4), speed = 0.2, "
     "rand_interval = 700, app_interval = 40 }"},
    {"cohesion", "{ min_dist = 0.4, max_dist = 3, amount = -0.3 }", true},
    {"alignment", "{ min_dist = 0.1, max_dist = 4, linear_amount = 0.8, angular_amount = 0.02, amount = 0.5 }", true},
    {"separation", "{ min_dist = 0.05, max_dist = 2.5, amount = 0.6 }", true},
};

// Three bodies of four free parts each, that drift and turn, and two arms: of servos, and of springs on one joint.
constexpr const char* kScene = R"(
sim.gravity = vec3()
local shapes = { sim:add_box_shape("brick", vec3(0.2, 0.1, 0.05)), sim:add_sphere_shape("ball", 0.06) }
for i = 1, 3 do
  local body = sim:add_body("cloud" .. i)
  for k = 1, 4 do
    body:add_part("part_" .. k, shapes[k % 2 + 1], { mass = 0.2 * k, linear_damping = 0.3, angular_damping = 0.4,
      position = vec3(0.8 * i, 0.7 * k, 0.3 * (i * k % 3)) })
  end
end
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm", position = vec3(0, -2, 0) })
local spring = arm:motor("joint_4")
spring.angular_spring_active, spring.angular_spring_stiffness = { false, false, true }, 30
spring.angular_spring_damping = 3
arm:copy("arm2", { position = vec3(2, -2, 0) })
for _, body in ipairs(sim.bodies) do attach(body) end
sim:on_start(function()
  for i, name in ipairs { "cloud1", "cloud2", "cloud3" } do
    for k, part in ipairs(sim:body(name).parts) do
      part.linear_velocity = vec3(0.3 * (k - 2), 0.2 * (i - 2), 0.1 * (k - i))
      part.angular_velocity = vec3(k - 2, i - 2, 0.5 * (k - i))
    end
  end
end)
)";

using Trajectory = std::vector<Vec3>;

// all parts' positions every ten ticks
Trajectory played(const std::string& type, const Twin& twin) {
  BehaviorStage stage(with_data(LIMBER_SOURCE_DIR), true);
  const std::string attach =
      twin.group ? "local function attach() end\n"
                 : "local function attach(body) body:add_behavior('" + type + "', 'it', " + twin.opts + ") end\n";
  const std::string group =
      twin.group ? "\nsim:add_group_behavior('" + type + "', 'it', " + std::string(twin.opts) + ")" : "";
  const std::string fault = stage.play(attach + kScene + group);
  EXPECT_EQ(fault, "");
  Trajectory places;
  for (int i = 0; fault.empty() && i < 60; i++) {
    stage.tick(10);
    for (const auto& body : stage.world.bodies()) {
      for (const Behavior* behavior : body->behaviors()) EXPECT_EQ(behavior->error(), "");
      for (const auto& part : body->parts()) places.push_back(part->center());
    }
  }
  return places;
}

class Twins : public ::testing::TestWithParam<Twin> {};

TEST_P(Twins, MoveAlike) {
  const Twin& twin = GetParam();
  const Trajectory built_in = played(twin.type, twin);
  const Trajectory lua = played(std::string("lua_") + twin.type, twin);
  ASSERT_EQ(built_in.size(), lua.size());
  double farthest = 0, way = 0;
  const std::size_t parts = built_in.size() / 60;
  for (std::size_t i = 0; i < built_in.size(); i++) {
    farthest = std::max(farthest, glm::distance(built_in[i], lua[i]));
    way = std::max(way, glm::distance(built_in[i], built_in[i % parts]));
  }
  EXPECT_GT(way, 0.05) << "something moves";
  EXPECT_LT(farthest, 1e-4);
  RecordProperty("deviation", std::to_string(farthest));
  std::cout << "deviation " << farthest << " m of " << way << " m\n";
}

TEST_P(Twins, HaveTheSameRows) {
  const Twin& twin = GetParam();
  BehaviorStage stage(with_data(LIMBER_SOURCE_DIR));
  const std::string type = std::string("lua_") + twin.type;
  ASSERT_EQ(stage.run(kBall + std::string(twin.group ? "sim:add_group_behavior('" + type + "', 'it', {})"
                                                     : "ball:add_behavior('" + type + "', 'it')")),
            "");
  const auto& types = stage.world.behaviors().types();
  const auto built_in = types.find(twin.type);
  const auto lua = types.find(type);
  ASSERT_NE(lua, nullptr);
  EXPECT_EQ(built_in->is_group, lua->is_group);
  ASSERT_EQ(built_in->table->row_names(), lua->table->row_names());
  for (std::uint32_t i = kCommonBehaviorRows; i < built_in->table->rows().size(); i++) {
    const Row& a = built_in->table->row(i);
    const Row& b = lua->table->row(i);
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(range_text(a), range_text(b));
    EXPECT_EQ(a.initial, b.initial);
    EXPECT_EQ(a.choices, b.choices);
    EXPECT_FALSE(b.doc.empty());
  }
}

// a built-in type without a twin shows a gap in the interface
TEST(TwinList, IsWhole) {
  BehaviorStage stage;
  for (const auto& type : stage.world.behaviors().types().all()) {
    if (!type->is_built_in) continue;
    EXPECT_TRUE(std::ranges::any_of(kTwins, [&](const Twin& t) { return t.type == type->name; })) << type->name;
  }
}

INSTANTIATE_TEST_SUITE_P(, Twins, ::testing::ValuesIn(kTwins), [](const auto& info) {
  std::string name = info.param.type;
  std::erase(name, '_');
  return name;
});

}  // namespace
}  // namespace limber
