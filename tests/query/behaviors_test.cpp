// Behaviours in the tree: built-in ones, Lua's, groups; their rows, and what is told when they come, go, change and
// err.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/image_of.h"
#include "query/fake_doors.h"
#include "query/hall.h"
#include "query/tree_json.h"

namespace limber::query_test {
namespace {

using Frames = std::vector<std::string>;
using engine_test::image_of;
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
    if self.fails then error("I was told to") end
    for motor in self.body:motors() do motor.target = self.depth end
  end,
}
)";

// a show's folder: the scene, and behaviors_lua beside scripts
struct Show {
  Show() {
    std::filesystem::create_directories(folder + "/behaviors_lua");
    std::ofstream(folder + "/behaviors_lua/wobble.lua") << kWobble;
    std::ofstream(scene) << kScene;
    show = std::make_unique<engine_test::Show>(scene);
  }
  ~Show() {
    show.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  json get(const std::string& path) const {
    const auto image = image_of(*show);
    const Result<TreePlace> place = image->tree->find(path);
    EXPECT_TRUE(place.ok()) << path;
    return place ? json::parse(node_json(*image, *place, 64)) : json();
  }
  std::string folder = std::filesystem::path(::testing::TempDir()) / fmt::format("limber_query_{}", ::getpid());
  std::string scene = folder + "/scene.lua";
  std::unique_ptr<engine_test::Show> show;
};

TEST(BehaviorsInTheTree, ShowTheirRowsLikeAnything) {
  const Show stage;
  const json wind = stage.get("/physics/body/one/behavior/wind");
  EXPECT_EQ(wind["CONTENTS"]["max_amp"]["VALUE"], json::array({3.0}));
  EXPECT_EQ(wind["CONTENTS"]["max_amp"]["UNIT"], json::array({"N"}));
  EXPECT_EQ(wind["CONTENTS"]["min_dir"]["TYPE"], "fff");
  EXPECT_EQ(wind["CONTENTS"]["active"]["TYPE"], "T");
  EXPECT_EQ(wind["CONTENTS"]["remove"]["ACCESS"], 2);
  EXPECT_EQ(wind["CONTENTS"]["error"]["VALUE"], json::array({""}));
  const json own = stage.get("/physics/body/one/behavior/own");
  EXPECT_EQ(own["CONTENTS"]["depth"]["VALUE"], json::array({0.25}));
  EXPECT_EQ(own["CONTENTS"]["depth"]["RANGE"][0]["MAX"], 1.0);
  EXPECT_EQ(own["CONTENTS"]["depth"]["DESCRIPTION"], "How far");
  const json swarm = stage.get("/physics/group/swarm");
  EXPECT_EQ(swarm["CONTENTS"]["amount"]["VALUE"], json::array({2.0}));
  EXPECT_EQ(stage.get("/physics/body/two/behavior/swarm")["CONTENTS"]["amount"]["VALUE"], json::array({2.0}));
}

struct SortedLine : ClientLine {
  Frames texts;
  Frames values;
  void send(bool text, std::string frame) override { (text ? texts : values).push_back(std::move(frame)); }
  std::size_t waiting() const override { return 0; }
};

TEST(BehaviorsInTheTree, AreToldOfAsTheyComeGoChangeAndErr) {
  const Show stage;
  engine_test::Show& show = *stage.show;
  const QueryDoors doors = fake_doors();
  Hall hall(show.link, doors, {});
  SortedLine line;
  Client client({Hand::query, 0x7f000001, 5}, line, hall.doors());
  hall.enter(client);
  const auto look = [&] {
    hall.hurry();
    image_of(show);
    hall.bell();
    hall.hurry();
    image_of(show);
    hall.bell();
  };
  for (const char* path : {"/physics/group/swarm/amount", "/physics/body/two/behavior/swarm/amount",
                           "/physics/body/one/behavior/own/error", "/physics/body/two/behavior/late/speed"}) {
    client.text(fmt::format(R"({{"COMMAND":"LISTEN","DATA":"{}"}})", path));
  }
  look();
  const auto taken = [](Frames& frames) {
    std::string all;
    for (const std::string& f : std::exchange(frames, {})) all += f + "\n";
    return all;
  };
  const std::string first = taken(line.values);
  EXPECT_NE(first.find("/physics/group/swarm/amount"), std::string::npos) << first;
  // the group's value goes to its members, and each is told once
  show.send("/physics/group/swarm/amount", 5);
  look();
  const std::string group = taken(line.values);
  EXPECT_NE(group.find("/physics/group/swarm/amount"), std::string::npos) << group;
  EXPECT_NE(group.find("/physics/body/two/behavior/swarm/amount"), std::string::npos) << group;
  EXPECT_EQ(taken(line.texts), "");
  // one comes, with a value that was listened to before it was there; and goes
  show.send("/more");
  look();
  EXPECT_EQ(taken(line.texts), R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/two/behavior/late"})"
                               "\n");
  EXPECT_NE(taken(line.values).find("/physics/body/two/behavior/late/speed"), std::string::npos);
  show.send("/less");
  look();
  EXPECT_EQ(taken(line.texts), R"({"COMMAND":"PATH_REMOVED","DATA":"/physics/body/two/behavior/late"})"
                               "\n");
  // an error is a value like others
  taken(line.values);
  show.send("/physics/body/one/behavior/own/fails", true);
  look();
  EXPECT_NE(taken(line.values).find("I was told to"), std::string::npos);
  hall.leave(client);
}

}  // namespace
}  // namespace limber::query_test
