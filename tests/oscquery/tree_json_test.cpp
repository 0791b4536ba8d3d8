// The tree as JSON, compared with the store.
#include "net/oscquery/tree_json.h"

#include <gtest/gtest.h>

#include <functional>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "net/oscquery/attributes.h"
#include "support/skip.h"

namespace limber::oscquery {
namespace {

using engine::test::make_value_snapshot;
using engine::test::Show;
using nlohmann::json;

struct TreeFixture {
  engine::test::SceneFile file{std::string(engine::test::kEverything) + "sim:add_body('my body')\n"};
  Show show{file.path()};
  std::shared_ptr<const engine::ValueSnapshot> snapshot;

  TreeFixture() {
    show.ticks(3);
    snapshot = make_value_snapshot(show);
  }
  json get(const std::string& path, int depth = 64) const {
    return json::parse(node_json(*snapshot, *snapshot->tree->find(path), depth));
  }
};

// Returns the node of a path by following CONTENTS.
const json* find_node(const json& root, const std::string& path) {
  const json* at = &root;
  for (std::size_t begin = 1; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const auto& contents = at->at("CONTENTS");
    const auto found = contents.find(path.substr(begin, end - begin));
    if (found == contents.end()) return nullptr;
    at = &*found;
    begin = end + 1;
  }
  return at;
}

std::size_t count_properties(const json& node) {
  if (!node.contains("CONTENTS")) return 1;
  std::size_t count = 0;
  for (const auto& [name, child] : node["CONTENTS"].items()) count += count_properties(child);
  return count;
}

TEST(TreeJson, ContainsEveryProperty) {
  TreeFixture fixture;
  const json root = fixture.get("/");
  EXPECT_EQ(root["FULL_PATH"], "/");
  const Store& store = fixture.show.engine.store();
  std::size_t property_count = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Property& property : store.table(id).properties()) {
      property_count++;
      const std::string path = (id == store.root() ? "" : store.path(id)) + "/" + property.name;
      const json* node = find_node(root, path);
      ASSERT_NE(node, nullptr) << path;
      EXPECT_EQ(node->at("FULL_PATH"), path);
      EXPECT_EQ(node->at("TYPE"), tags_of(property)) << path;
      EXPECT_EQ(node->at("ACCESS"), property.kind == PropertyKind::action ? 2 : property.writable() ? 3 : 1) << path;
      EXPECT_EQ(node->contains("VALUE"), property.kind != PropertyKind::action) << path;
      if (property.type != PropertyType::number) continue;
      double value = 0;
      store.get(id, property, &value);
      EXPECT_EQ(node->at("VALUE"), json::array({value})) << path;
    }
  });
  EXPECT_GT(property_count, 500u);
  EXPECT_EQ(count_properties(root), property_count) << "and nothing else";
}

TEST(TreeJson, WritesValuesOfEachType) {
  const TreeFixture fixture;
  EXPECT_EQ(fixture.get("/scene/style")["VALUE"], json::array({"calm"}));
  EXPECT_EQ(fixture.get("/scene/lively")["VALUE"], json::array({true}));
  EXPECT_EQ(fixture.get("/scene/where")["VALUE"], json::array({0, 0, 1}));
  EXPECT_EQ(fixture.get("/scene/wind")["UNIT"], json::array({"N"}));
  EXPECT_EQ(fixture.get("/physics/sim/gravity")["VALUE"], json::array({0, 0, -9.81}));
  EXPECT_EQ(fixture.get("/physics/body/arm/part/base/rotation")["VALUE"][0].size(), 4u);
  EXPECT_EQ(fixture.get("/physics/body/arm/motor/revolute/mode")["TYPE"], "s") << "computed properties too";
  EXPECT_FALSE(fixture.get("/transport/play").contains("VALUE"));
}

TEST(TreeJson, EscapesNamesLikeAddresses) {
  const TreeFixture fixture;
  EXPECT_EQ(fixture.get("/physics/body/my body")["FULL_PATH"], "/physics/body/my%20body");
  EXPECT_TRUE(fixture.get("/physics/body")["CONTENTS"].contains("my%20body"));
}

TEST(TreeJson, LimitsDepth) {
  const TreeFixture fixture;
  EXPECT_EQ(fixture.get("/physics", 0), json::parse(R"({"FULL_PATH":"/physics","ACCESS":0,"CONTENTS":{}})"));
  const json one = fixture.get("/physics", 1);
  EXPECT_TRUE(one["CONTENTS"].contains("body"));
  EXPECT_TRUE(one["CONTENTS"]["body"]["CONTENTS"].empty());
  EXPECT_FALSE(fixture.get("/physics", 2)["CONTENTS"]["body"]["CONTENTS"].empty());
  EXPECT_TRUE(fixture.get("/scene", 1)["CONTENTS"]["wind"].contains("VALUE"))
      << "properties are one level below their object";
}

TEST(TreeJson, OmitsDeepestLevelsOfHugeTree) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  // more properties than the limit of a response: nodes of eight properties in a separate store
  static const PropertyTable table = [] {
    std::vector<Property> properties;
    for (int i = 0; i < 8; i++)
      properties.push_back(properties::number("r" + std::to_string(i), "", 0, 0, 1, "A property."));
    return PropertyTable("crowd", "/crowd/<crowd>", "", std::move(properties));
  }();
  Store store;
  const NodeId group = store.add_group(store.root(), "crowd");
  for (std::size_t i = 0; i < kMaxProperties / 16; i++) {
    const NodeId one = store.add(table, group, "n" + std::to_string(i), nullptr);
    store.add(table, store.add_group(one, "in"), "x", nullptr);
  }
  engine::ValueSnapshot values;
  values.tree = std::make_shared<const TreeSnapshot>(store);
  values.snapshot = std::make_shared<const engine::Snapshot>();
  values.persistent.assign(store.persistent_values().begin(), store.persistent_values().end());
  const json cut = json::parse(node_json(values, {}));
  EXPECT_EQ(cut["CONTENTS"]["crowd"]["CONTENTS"].size(), kMaxProperties / 16);
  const json& one = cut["CONTENTS"]["crowd"]["CONTENTS"]["n7"];
  EXPECT_TRUE(one["CONTENTS"].contains("r7"));
  EXPECT_EQ(one["CONTENTS"]["in"]["CONTENTS"]["x"]["CONTENTS"], json::object()) << "the object without its properties";
  // a single one of them is complete
  const json whole = json::parse(node_json(values, *values.tree->find("/crowd/n7")));
  EXPECT_EQ(count_properties(whole), 16u);
}

TEST(TreeJson, FindsPathsByWords) {
  const TreeFixture fixture;
  const auto find = [&](const std::string& words, std::size_t limit = 100) {
    return json::parse(find_json(*fixture.snapshot, words, limit));
  };
  const json wind = find("scene wind");
  ASSERT_EQ(wind["FOUND"].size(), 1u);
  EXPECT_EQ(wind["FOUND"][0]["FULL_PATH"], "/scene/wind");
  EXPECT_EQ(wind["FOUND"][0]["VALUE"], json::array({0}));
  EXPECT_EQ(wind["MORE"], false);
  EXPECT_EQ(find("twin HAT Linear_Damping")["FOUND"][0]["FULL_PATH"], "/physics/body/twin/part/hat/linear_damping");
  const json few = find("friction", 3);
  EXPECT_EQ(few["FOUND"].size(), 3u);
  EXPECT_EQ(few["MORE"], true);
  EXPECT_EQ(find("  ")["FOUND"].size(), 0u);
  EXPECT_EQ(find("\"}<script>")["FOUND"].size(), 0u);
}

TEST(TreeJson, WritesSingleValue) {
  const TreeFixture fixture;
  const auto value = [&](const char* path) {
    return property_value_json(*fixture.snapshot, *fixture.snapshot->tree->find(path));
  };
  EXPECT_EQ(value("/scene/where"), "[0,0,1]");
  EXPECT_EQ(value("/transport/play"), "");
  EXPECT_EQ(value("/scene"), "");
}

}  // namespace
}  // namespace limber::oscquery
