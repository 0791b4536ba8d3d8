// Behaviors in the tree: built-in, Lua and group behaviors; their properties, and notifications when they are added,
// removed, changed or fail.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/image_of.h"
#include "net/oscquery/hub.h"
#include "net/oscquery/tree_json.h"
#include "oscquery/fake_doors.h"

namespace limber::oscquery::test {
namespace {

using Frames = std::vector<std::string>;
using engine::test::make_value_snapshot;
using nlohmann::json;

constexpr const char* kScene = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i, name in ipairs { "one", "two" } do
  local body = sim:add_body(name)
  body:add_part("base", ball, { mass = 0, position = vec3(i, 0, 2) })
  body:add_part("tip", ball, { position = vec3(i, 0, 1) })
  body:add_motor(body:add_joint("elbow", "base", "tip", { position = vec3(i, 0, 2), axis = vec3(0, 1, 0) }))
end
sim:body("one"):add_behavior("random_force", "wind", { parts = "tip", max_amp = 3 })
sim:body("one"):add_behavior("wobble", "own", { depth = 0.25 })
sim:add_group_behavior("cohesion", "swarm", { amount = 2 })
osc:on("/more", function() sim:body("two"):add_behavior("speed", "late") end)
osc:on("/less", function() sim:body("two"):behavior("late"):remove() end)
)";
constexpr const char* kWobble = R"(
return behavior {
  doc = "Moves the motors a little.",
  params = { { "depth", 0.5, min = 0, max = 1, unit = "rad", doc = "How far." }, { "fails", false } },
  step = function(self)
    if self.fails then error("failed on request") end
    for motor in self.body:motors() do motor.target = self.depth end
  end,
}
)";

// A folder with a scene, and behaviors_lua beside the scripts.
struct BehaviorScene {
  BehaviorScene() {
    std::filesystem::create_directories(folder + "/behaviors_lua");
    std::ofstream(folder + "/behaviors_lua/wobble.lua") << kWobble;
    std::ofstream(scene) << kScene;
    show = std::make_unique<engine::test::Show>(scene);
  }
  ~BehaviorScene() {
    show.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  json get(const std::string& path) const {
    const auto values = make_value_snapshot(*show);
    const Result<TreePropertyRef> ref = values->tree->find(path);
    EXPECT_TRUE(ref.ok()) << path;
    return ref ? json::parse(node_json(*values, *ref, 64)) : json();
  }
  std::string folder = std::filesystem::path(::testing::TempDir()) / fmt::format("limber_query_{}", ::getpid());
  std::string scene = folder + "/scene.lua";
  std::unique_ptr<engine::test::Show> show;
};

TEST(BehaviorsInTheTree, HaveAttributesOfProperties) {
  const BehaviorScene fixture;
  const json wind = fixture.get("/physics/body/one/behavior/wind");
  EXPECT_EQ(wind["CONTENTS"]["max_amp"]["VALUE"], json::array({3.0}));
  EXPECT_EQ(wind["CONTENTS"]["max_amp"]["UNIT"], json::array({"N"}));
  EXPECT_EQ(wind["CONTENTS"]["min_dir"]["TYPE"], "fff");
  EXPECT_EQ(wind["CONTENTS"]["active"]["TYPE"], "T");
  EXPECT_EQ(wind["CONTENTS"]["remove"]["ACCESS"], 2);
  EXPECT_EQ(wind["CONTENTS"]["error"]["VALUE"], json::array({""}));
  const json own = fixture.get("/physics/body/one/behavior/own");
  EXPECT_EQ(own["CONTENTS"]["depth"]["VALUE"], json::array({0.25}));
  EXPECT_EQ(own["CONTENTS"]["depth"]["RANGE"][0]["MAX"], 1.0);
  EXPECT_EQ(own["CONTENTS"]["depth"]["DESCRIPTION"], "How far");
  const json swarm = fixture.get("/physics/group/swarm");
  EXPECT_EQ(swarm["CONTENTS"]["amount"]["VALUE"], json::array({2.0}));
  EXPECT_EQ(fixture.get("/physics/body/two/behavior/swarm")["CONTENTS"]["amount"]["VALUE"], json::array({2.0}));
}

struct SortingSink : ClientSink {
  Frames texts;
  Frames values;
  void send(bool text, std::string frame) override { (text ? texts : values).push_back(std::move(frame)); }
  std::size_t queued_bytes() const override { return 0; }
};

TEST(BehaviorsInTheTree, SendPathEventsAndValues) {
  const BehaviorScene fixture;
  engine::test::Show& show = *fixture.show;
  const QueryHost host = fake_query_host();
  QueryHub hub(show.link, host, {});
  SortingSink line;
  QueryClient client({CommandSource::oscquery, 0x7f000001, 5}, line, hub.host());
  hub.add_client(client);
  const auto update = [&] {
    hub.request_values();
    make_value_snapshot(show);
    hub.on_link_event();
    hub.request_values();
    make_value_snapshot(show);
    hub.on_link_event();
  };
  for (const char* path : {"/physics/group/swarm/amount", "/physics/body/two/behavior/swarm/amount",
                           "/physics/body/one/behavior/own/error", "/physics/body/two/behavior/late/speed"}) {
    client.on_text(fmt::format(R"({{"COMMAND":"LISTEN","DATA":"{}"}})", path));
  }
  update();
  const auto consume = [](Frames& frames) {
    std::string all;
    for (const std::string& f : std::exchange(frames, {})) all += f + "\n";
    return all;
  };
  const std::string first = consume(line.values);
  EXPECT_NE(first.find("/physics/group/swarm/amount"), std::string::npos) << first;
  // the group's value is applied to its members, and each change is sent once
  show.send("/physics/group/swarm/amount", 5);
  update();
  const std::string group = consume(line.values);
  EXPECT_NE(group.find("/physics/group/swarm/amount"), std::string::npos) << group;
  EXPECT_NE(group.find("/physics/body/two/behavior/swarm/amount"), std::string::npos) << group;
  EXPECT_EQ(consume(line.texts), "");
  // a behavior is added, with a value that was listened to before, and removed
  show.send("/more");
  update();
  EXPECT_EQ(consume(line.texts), R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/two/behavior/late"})"
                                 "\n");
  EXPECT_NE(consume(line.values).find("/physics/body/two/behavior/late/speed"), std::string::npos);
  show.send("/less");
  update();
  EXPECT_EQ(consume(line.texts), R"({"COMMAND":"PATH_REMOVED","DATA":"/physics/body/two/behavior/late"})"
                                 "\n");
  // an error is an ordinary value
  consume(line.values);
  show.send("/physics/body/one/behavior/own/fails", true);
  update();
  EXPECT_NE(consume(line.values).find("failed on request"), std::string::npos);
  hub.remove_client(client);
}

}  // namespace
}  // namespace limber::oscquery::test
