// The built-in behaviors and their counterparts in Lua: same properties, same motion. This proves that the interface of
// behaviors_lua/ is complete.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string_view>
#include <utility>
#include <vector>

#include "base/sanitized.h"
#include "behavior_stage.h"
#include "support/skip.h"

namespace limber::script {
namespace {

// non-default settings for each type; `group`: attached to all bodies
struct Twin {
  const char* type;
  std::vector<const char*> sets;
  bool group = false;
};

std::ostream& operator<<(std::ostream& out, const Twin& twin) { return out << twin.type; }

const std::vector<Twin>& twins() {
  static const std::vector<Twin> list = {
      {"force",
       {"parts = '*[123]', dir = vec3(1, 2, -1), amp = 0.4, max_amp = 0.3, app_interval = 40",
        "dir = vec3(0, 0, -3), amp = -0.02, app_interval = 0", "dir = vec3(), amp = 5", "amp = 3, app_interval = 12345",
        "amp = 1, active = false"}},
      {"torque",
       {"torque = vec3(0.002, -0.001, 0.003), scale = -1.5, app_interval = 25",
        "parts = 'part_*', torque = vec3(0, 0, 0.0005), app_interval = 0", "torque = vec3(1, 0, 0), scale = 0"}},
      {"random_force",
       {"parts = '*2', min_dir = vec3(-1, 0, -1), min_amp = -0.2, max_amp = 0.5, rand_interval = 330, app_interval = "
        "50",
        "max_amp = 0.2", "min_dir = vec3(), max_dir = vec3(), max_amp = 5",
        "min_dir = vec3(1, 1, 1), max_dir = vec3(-1, -1, -1), min_amp = 0.3, max_amp = 0.1, rand_interval = 0"}},
      {"random_torque",
       {"min_torque = vec3(-2, -1, 0), scale = 0.002, rand_interval = 450, app_interval = 20",
        "scale = -0.001, rand_interval = 0", "scale = 0.003, rand_interval = 1e9"}},
      {"speed", {"speed = 0.7, amount = 0.6", "speed = -0.2, amount = 0.3", "speed = 0, amount = -0.02"}},
      {"target_attraction",
       {"target_pos = vec3(0.5, -0.3, 0.8), min_dist = 0.2, max_dist = 6, min_amp = -0.1, max_amp = 1.5, "
        "app_interval = 30",
        "target_pos = vec3(1, 1, 1), max_dist = 4, min_amp = 0.4, max_amp = -0.2, app_interval = 0",
        "min_dist = 3, max_dist = 2, max_amp = 9", "max_dist = 0, max_amp = 9"}},
      {"volume",
       {"max_dist = 2, min_amp = -0.1, max_amp = 0.4, app_interval = 35",
        "parts = { 'part_[13]', 'link*' }, max_dist = 5, max_amp = -0.2", "max_dist = 0"}},
      {"rotation_target",
       {"target = vec3(0, 0, 2), speed = 0.05, app_interval = 30", "target = vec3(1, 2, -0.7), speed = 0.4",
        "motors = 'joint_[14]', target = vec3(0, 0, 9), speed = 3, app_interval = 500",
        "target = vec3(0, 0, 1), speed = 0"}},
      {"random_rotation_target",
       {"min_target = vec3(0, 0, -1.2), max_target = vec3(0, 0, 4), speed = 0.2, rand_interval = 700, app_interval = "
        "40",
        "min_target = vec3(0, 0, 1), max_target = vec3(0, 0, -1), speed = 0.05, rand_interval = 0",
        "motors = { 'joint_[2]', 'joint_[4-6]' }, max_target = vec3(1, 1, 1), rand_interval = 2500"}},
      {"cohesion",
       {"min_dist = 0.4, max_dist = 3, amount = -0.3", "max_dist = 20, amount = -0.1",
        "parts = '*_2', neighbor_parts = '*_[13]', amount = -0.1",
        "bodies = 'cloud[12]', min_dist = 0.3, max_dist = 4, amount = 0.05", "min_dist = 3, max_dist = 2"},
       true},
      {"alignment",
       {"min_dist = 0.1, max_dist = 4, linear_amount = 0.8, angular_amount = 0.02, amount = 0.5",
        "max_dist = 3, linear_amount = 1e4, angular_amount = 1e4",  // far more than necessary
        "max_dist = 5, linear_amount = -0.02, angular_amount = 0.0002",
        "parts = 'part_[13]', angular_amount = 1, amount = 0.3"},
       true},
      {"separation",
       {"min_dist = 0.05, max_dist = 2.5, amount = 0.6", "max_dist = 4, amount = -0.1",
        "bodies = { 'cloud1', 'cloud3' }, max_dist = 3, amount = 0.3", "max_dist = 0"},
       true},
  };
  return list;
}

// Three bodies of four free parts each that drift and rotate, and two arms: one with servos, one with springs.
constexpr const char* kTwinScene = R"(
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

// the position of all parts every ten ticks, and of a point off center of each, which shows the rotation
Trajectory played(const std::string& type, const std::string& opts, bool group) {
  BehaviorFixture fixture(with_data(LIMBER_SOURCE_DIR), true);
  const std::string attach =
      group ? "local function attach() end\n"
            : "local function attach(body) body:add_behavior('" + type + "', 'it', { " + opts + " }) end\n";
  const std::string all = group ? "\nsim:add_group_behavior('" + type + "', 'it', { " + opts + " })" : "";
  const std::string fault = fixture.play(attach + kTwinScene + all);
  EXPECT_EQ(fault, "");
  Trajectory places;
  for (int i = 0; fault.empty() && i < 60; i++) {
    fixture.tick(10);
    for (const auto& body : fixture.world.bodies()) {
      for (const sim::Behavior* behavior : body->behaviors().list()) EXPECT_EQ(behavior->error(), "");
      for (const auto& part : body->parts()) {
        places.push_back(part->center());
        places.push_back(part->center() + part->pose().rotation * Vec3(0.3, 0.2, 0.1));
      }
    }
  }
  return places;
}

class Twins : public ::testing::TestWithParam<Twin> {};

// all settings are compared if that is fast; with the address sanitizer only the first of each type
constexpr std::size_t kSets = kAddressSanitizer ? 1 : 100;

// the distance between the twins, and the distance that they moved
std::pair<double, double> deviation(const Trajectory& a, const Trajectory& b) {
  double max_deviation = 0, max_travel = 0;
  const std::size_t parts = a.size() / 60;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); i++) {
    max_deviation = std::max(max_deviation, glm::distance(a[i], b[i]));
    max_travel = std::max(max_travel, glm::distance(a[i], a[i % parts]));
  }
  return {max_deviation, max_travel};
}

bool is_quick(const Twin& twin) {
  const auto types = {"force", "torque", "speed", "target_attraction", "cohesion"};
  return std::find(types.begin(), types.end(), std::string_view(twin.type)) != types.end();
}

TEST_P(Twins, MoveAlike) {
  LIMBER_SKIP_IF(kAddressSanitizer && !is_quick(GetParam()), "quicker types execute the same code");
  const Twin& twin = GetParam();
  const Trajectory alone = played("force", "amp = 0", false);
  for (std::size_t set = 0; set < std::min(twin.sets.size(), kSets); set++) {
    const char* opts = twin.sets[set];
    SCOPED_TRACE(opts);
    const Trajectory built_in = played(twin.type, opts, twin.group);
    const Trajectory lua = played(std::string("lua_") + twin.type, opts, twin.group);
    ASSERT_EQ(built_in.size(), lua.size());
    const auto [max_distance, max_travel] = deviation(built_in, lua);
    EXPECT_LT(max_distance, 1e-4) << "of " << max_travel << " m";
    // the first settings must cause a visible effect
    if (set == 0) {
      EXPECT_GT(deviation(built_in, alone).first, 0.05);
    }
  }
}

TEST_P(Twins, HaveTheSameProperties) {
  const Twin& twin = GetParam();
  BehaviorFixture fixture(with_data(LIMBER_SOURCE_DIR));
  const std::string type = std::string("lua_") + twin.type;
  ASSERT_EQ(fixture.run(kBall + std::string(twin.group ? "sim:add_group_behavior('" + type + "', 'it', {})"
                                                       : "ball:add_behavior('" + type + "', 'it')")),
            "");
  const auto& types = fixture.world.behaviors().types();
  const auto built_in = types.find(twin.type);
  const auto lua = types.find(type);
  ASSERT_NE(lua, nullptr);
  EXPECT_EQ(built_in->is_group, lua->is_group);
  ASSERT_EQ(built_in->table->property_names(), lua->table->property_names());
  for (std::uint32_t i = sim::kCommonBehaviorProperties; i < built_in->table->properties().size(); i++) {
    const Property& a = built_in->table->property(i);
    const Property& b = lua->table->property(i);
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(range_text(a), range_text(b));
    EXPECT_EQ(a.initial, b.initial);
    EXPECT_EQ(a.choices, b.choices);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.doc, b.doc);
  }
}

// A built-in type without a counterpart indicates a gap in the interface. Those of motion capture read samples that
// their own tests send, and rotation_target_oscil is compared with its formula.
TEST(TwinList, IncludesEveryBuiltInType) {
  BehaviorFixture fixture;
  for (const auto& type : fixture.world.behaviors().types().all()) {
    if (!type->is_built_in || type->name.starts_with("mocap_") || type->name == "rotation_target_oscil") continue;
    EXPECT_TRUE(std::ranges::any_of(twins(), [&](const Twin& t) { return t.type == type->name; })) << type->name;
  }
}

INSTANTIATE_TEST_SUITE_P(, Twins, ::testing::ValuesIn(twins()), [](const auto& info) {
  std::string name = info.param.type;
  std::erase(name, '_');
  return name;
});

}  // namespace
}  // namespace limber::script
