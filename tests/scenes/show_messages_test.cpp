// The vocabulary of the shows that were made with ofxDabPhysics: every message that their control patches send to the
// simulation (the repositories bisnad/Incubatio and bisnad/MotionSimulation), with its effect in a scene of that kind.
#include <fmt/format.h>

#include "player.h"
#include "sim/behavior/behavior_list.h"

namespace limber {
namespace {

// One arm with the behaviors of those shows.
constexpr const char* kShow = R"(
sim.gravity = vec3()
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "onshape" })
local function add(type, name, opts)
  opts.active = false
  arm:add_behavior(type, name, opts)
end
for i, motor in ipairs(arm.motors) do
  add("rotation_target", "rotation_" .. i - 1, { motors = motor })
  add("rotation_target_oscil", "rotation_oscil_" .. i - 1, { motors = motor })
end
for _, name in ipairs { "levitation", "particles", "random_tip", "random_all" } do
  add("random_force", name, { parts = "tip" })
end
for _, name in ipairs { "thrusting", "staccato", "fluidity" } do add("random_rotation_target", name, {}) end
for _, name in ipairs { "speed_tip", "speed_all" } do add("speed", name, { parts = "tip" }) end
for _, name in ipairs { "targetpos_tip", "targetpos_all" } do add("target_attraction", name, { parts = "tip" }) end
add("force", "force_tip", { parts = "tip" })
)";

struct Family {
  const char* names;       // the objects
  const char* properties;  // as the patches spell them
  int numbers;
};

// Parameters of behaviors: with a body, and without one.
constexpr Family kParameters[] = {
    {"fluidity staccato thrusting", "active appInterval randInterval speed", 1},
    {"fluidity staccato thrusting", "minTarget maxTarget", 3},
    {"levitation particles", "active appInterval randInterval minAmp maxAmp", 1},
    {"levitation particles", "minDir maxDir", 3},
    {"speed_tip speed_all", "active amount speed", 1},
    {"targetpos_all", "active appInterval minAmp maxAmp maxDist", 1},
    {"targetpos_all", "targetPos", 3},
    {"rotation_oscil_0 rotation_oscil_1 rotation_oscil_2 rotation_oscil_3", "active appInterval oscilInterval speed",
     1},
    {"rotation_oscil_0 rotation_oscil_1 rotation_oscil_2 rotation_oscil_3", "target1 target2", 3},
};

// Properties of all parts, joints and motors, of those of a body, and of some, of a joint's motor.
constexpr Family kObjects[] = {
    {"part", "angulardamping friction lineardamping mass restitution rollingfriction", 1},
    {"joint", "angularlowerlimit angularupperlimit angularstopcfm angularstoperp", 3},
    {"motor", "angularactive angularservoactive angularspringactive", 3},
    {"motor",
     "angularservoposition angularspringdamping angularspringrestlength angularspringstiffness angularvelocity "
     "maxangularforce",
     3},
    {"motor", "bounce damping", 1},
};

struct Single {
  const char* address;
  std::vector<double> values;
};
const std::vector<Single> kSingles = {
    {"/physics/sim/gravity", {-1.5}},
    {"/physics/sim/substeps", {10}},
    {"/physics/sim/timestep", {0.05}},
    {"/visuals/camera/position", {1, 2, 3}},
    {"/visuals/camera/rotation", {10, 20, 30}},
    {"/visuals/camera/projection", {50, 1.5, 0.2, 90}},
    {"/visuals/shape/transparency", {0.5}},
    {"/visuals/shape/ambientscale", {0.5}},
    {"/visuals/shape/diffusescale", {0.5}},
    {"/visuals/shape/specularscale", {0.5}},
    {"/visuals/shape/specularpow", {5}},
    {"/visuals/shape/ambientcolor", {0.25, 0.5, 0.75}},
    {"/visuals/shape/diffusecolor", {0.25, 0.5, 0.75}},
};

std::vector<std::string> word_list(const char* text) {
  std::vector<std::string> list;
  for (const std::string_view word : split(text, ' ')) list.emplace_back(word);
  return list;
}

std::vector<Arg> args_of(const std::vector<std::string>& names, int numbers, double value) {
  std::vector<Arg> args;
  for (const std::string& name : names) args.push_back(Arg::of(std::string_view(name)));
  for (int i = 0; i < numbers; i++) args.push_back(Arg::of(i == numbers - 1 ? value : 0));
  return args;
}

struct ShowMessages : testing::Test {
  ShowMessages() : player(show.write("scripts/scene.lua", kShow)) { (void)player.sent(); }
  // Sends a message; expects that nothing is rejected.
  void send(const std::string& address, const std::vector<Arg>& args) {
    player.send(address, args);
    player.engine->tick();
    for (const Message& message : player.sent()) {
      if (message.address == "/error")
        ADD_FAILURE() << engine::message_text({address, args}) << ": rejected: " << engine::message_text(message);
    }
  }
  ShowFolder show;
  Player player;
};

TEST_F(ShowMessages, ParametersOfBehaviors) {
  double value = 0;
  for (const Family& family : kParameters) {
    for (const std::string& behavior : word_list(family.names)) {
      for (const std::string& parameter : word_list(family.properties)) {
        for (const bool with_body : {false, true}) {
          std::vector<std::string> names{behavior, parameter};
          if (with_body) names.insert(names.begin(), "onshape");
          value = parameter == "active" ? (with_body ? 0 : 1) : value < 0.9 ? value + 0.0625 : 0.125;
          send("/physics/behavior/parameter", args_of(names, family.numbers, value));
          const std::string path = fmt::format("/physics/body/onshape/behavior/{}/{}", behavior, parameter);
          EXPECT_EQ(player.value(path, static_cast<std::size_t>(family.numbers) - 1), value) << path;
        }
      }
    }
  }
}

TEST_F(ShowMessages, PropertiesOfObjects) {
  for (const Family& family : kObjects) {
    for (const std::string& property : word_list(family.properties)) {
      const std::string address = fmt::format("/physics/{}/{}", family.names, property);
      const bool is_flag = property.ends_with("active");
      send(address, args_of({}, family.numbers, is_flag ? 1 : 0.5));
      send(address, args_of({"onshape"}, family.numbers, is_flag ? 1 : 0.25));
      const std::string object = family.names == std::string("part") ? "tip" : "joint_2";
      const std::string path = fmt::format("/physics/body/onshape/{}/{}/{}", family.names, object, property);
      EXPECT_EQ(player.value(path, static_cast<std::size_t>(family.numbers) - 1), is_flag ? 1 : 0.25) << path;
    }
  }
  send("/physics/motor/maxangularforce", args_of({"joint_1"}, 3, 80));
  send("/physics/motor/maxangularforce", args_of({"onshape", "joint_2"}, 3, 90));
  EXPECT_EQ(player.value("/physics/body/onshape/motor/joint_1/max_angular_force", 2), 80);
  EXPECT_EQ(player.value("/physics/body/onshape/motor/joint_2/max_angular_force", 2), 90);
}

TEST_F(ShowMessages, TheWorldTheCameraAndShapes) {
  for (const Single& single : kSingles) {
    std::vector<Arg> args;
    for (const double value : single.values) args.push_back(Arg::of(value));
    send(single.address, args);
  }
  EXPECT_EQ(player.value("/physics/sim/gravity", 2), -1.5);
  EXPECT_EQ(player.value("/physics/sim/substeps"), 10);
  EXPECT_EQ(player.value("/physics/sim/timestep"), 0.05);
  EXPECT_EQ(player.value("/visuals/camera/position", 2), 3);
  EXPECT_EQ(player.value("/visuals/camera/rotation", 1), 20);
  EXPECT_EQ(player.value("/visuals/camera/far"), 90);
}

}  // namespace
}  // namespace limber
