// The tree as JSON beside the store that it shows.
#include "query/tree_json.h"

#include <gtest/gtest.h>

#include <functional>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "query/row_face.h"

namespace limber {
namespace {

using engine_test::image_of;
using engine_test::Show;
using nlohmann::json;

struct TreeStage {
  engine_test::SceneFile file{std::string(engine_test::kEverything) + "sim:add_body('my body')\n"};
  Show show{file.path()};
  std::shared_ptr<const Image> image;

  TreeStage() {
    show.ticks(3);
    image = image_of(show);
  }
  json get(const std::string& path, int depth = 64) const {
    return json::parse(node_json(*image, *image->tree->find(path), depth));
  }
};

// the node of a path, going down the CONTENTS
const json* below(const json& root, const std::string& path) {
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

std::size_t leaves(const json& node) {
  if (!node.contains("CONTENTS")) return 1;
  std::size_t count = 0;
  for (const auto& [name, child] : node["CONTENTS"].items()) count += leaves(child);
  return count;
}

TEST(TreeJson, HoldsEveryRowOfTheCatalogWithItsValue) {
  TreeStage stage;
  const json root = stage.get("/");
  EXPECT_EQ(root["FULL_PATH"], "/");
  const Store& store = stage.show.engine.store();
  std::size_t rows = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Row& row : store.table(id).rows()) {
      rows++;
      const std::string path = (id == store.root() ? "" : store.path(id)) + "/" + row.name;
      const json* node = below(root, path);
      ASSERT_NE(node, nullptr) << path;
      EXPECT_EQ(node->at("FULL_PATH"), path);
      EXPECT_EQ(node->at("TYPE"), tags_of(row)) << path;
      EXPECT_EQ(node->at("ACCESS"), row.kind == RowKind::action ? 2 : row.writable() ? 3 : 1) << path;
      EXPECT_EQ(node->contains("VALUE"), row.kind != RowKind::action) << path;
      if (row.type != RowType::number) continue;
      double value = 0;
      store.get(id, row, &value);
      EXPECT_EQ(node->at("VALUE"), json::array({value})) << path;
    }
  });
  EXPECT_GT(rows, 500u);
  EXPECT_EQ(leaves(root), rows) << "and nothing else";
}

TEST(TreeJson, ValuesOfEachKind) {
  const TreeStage stage;
  EXPECT_EQ(stage.get("/scene/style")["VALUE"], json::array({"calm"}));
  EXPECT_EQ(stage.get("/scene/lively")["VALUE"], json::array({true}));
  EXPECT_EQ(stage.get("/scene/where")["VALUE"], json::array({0, 0, 1}));
  EXPECT_EQ(stage.get("/scene/wind")["UNIT"], json::array({"N"}));
  EXPECT_EQ(stage.get("/physics/sim/gravity")["VALUE"], json::array({0, 0, -9.81}));
  EXPECT_EQ(stage.get("/physics/body/arm/part/base/rotation")["VALUE"][0].size(), 4u);
  EXPECT_EQ(stage.get("/physics/body/arm/motor/revolute/mode")["TYPE"], "s") << "computed rows too";
  EXPECT_FALSE(stage.get("/transport/play").contains("VALUE"));
}

TEST(TreeJson, NamesAreWrittenAsInAddresses) {
  const TreeStage stage;
  EXPECT_EQ(stage.get("/physics/body/my body")["FULL_PATH"], "/physics/body/my%20body");
  EXPECT_TRUE(stage.get("/physics/body")["CONTENTS"].contains("my%20body"));
}

TEST(TreeJson, DepthLeavesOutWhatLiesDeeper) {
  const TreeStage stage;
  EXPECT_EQ(stage.get("/physics", 0), json::parse(R"({"FULL_PATH":"/physics","ACCESS":0,"CONTENTS":{}})"));
  const json one = stage.get("/physics", 1);
  EXPECT_TRUE(one["CONTENTS"].contains("body"));
  EXPECT_TRUE(one["CONTENTS"]["body"]["CONTENTS"].empty());
  EXPECT_FALSE(stage.get("/physics", 2)["CONTENTS"]["body"]["CONTENTS"].empty());
  EXPECT_TRUE(stage.get("/scene", 1)["CONTENTS"]["wind"].contains("VALUE")) << "a thing's rows are one level below it";
}

TEST(TreeJson, AHugeTreeIsCutByWholeLevels) {
  // more rows than an answer holds: nodes of eight rows in a store of our own
  static const Table table = [] {
    std::vector<Row> rows;
    for (int i = 0; i < 8; i++) rows.push_back(rows::number("r" + std::to_string(i), "", 0, 0, 1, "A row."));
    return Table("crowd", "/crowd/<crowd>", "", std::move(rows));
  }();
  Store store;
  const NodeId group = store.add_group(store.root(), "crowd");
  for (std::size_t i = 0; i < kMostRows / 16; i++) {
    const NodeId one = store.add(table, group, "n" + std::to_string(i), nullptr);
    store.add(table, store.add_group(one, "in"), "x", nullptr);
  }
  Image image;
  image.tree = std::make_shared<const Tree>(store);
  image.snapshot = std::make_shared<const Snapshot>();
  image.kept.assign(store.kept().begin(), store.kept().end());
  const json cut = json::parse(node_json(image, {}));
  EXPECT_EQ(cut["CONTENTS"]["crowd"]["CONTENTS"].size(), kMostRows / 16);
  const json& one = cut["CONTENTS"]["crowd"]["CONTENTS"]["n7"];
  EXPECT_TRUE(one["CONTENTS"].contains("r7"));
  EXPECT_EQ(one["CONTENTS"]["in"]["CONTENTS"]["x"]["CONTENTS"], json::object()) << "who is there, but no rows";
  // one of them is given whole
  const json whole = json::parse(node_json(image, *image.tree->find("/crowd/n7")));
  EXPECT_EQ(leaves(whole), 16u);
}

TEST(TreeJson, FindsByWordsOfThePath) {
  const TreeStage stage;
  const auto find = [&](const std::string& words, std::size_t limit = 100) {
    return json::parse(find_json(*stage.image, words, limit));
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

TEST(TreeJson, ValueAlone) {
  const TreeStage stage;
  const auto value = [&](const char* path) { return place_value_json(*stage.image, *stage.image->tree->find(path)); };
  EXPECT_EQ(value("/scene/where"), "[0,0,1]");
  EXPECT_EQ(value("/transport/play"), "");
  EXPECT_EQ(value("/scene"), "");
}

}  // namespace
}  // namespace limber
