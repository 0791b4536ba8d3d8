// glTF writer: counts checked in the JSON, poses with assimp.
#include "export/writers.h"

#include <cstring>
#include <set>

#include <nlohmann/json.hpp>

#include "export/loaded.h"
#include "export/rig.h"

namespace limber::exporter::test {
namespace {

using GltfTest = MotionTest;
using Json = nlohmann::json;

// the JSON of a .glb file; checks the chunk lengths
Json json_of(const std::string& glb) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, 4);
    return value;
  };
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), glb.size());
  const std::uint32_t text = word(12);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  Json json = Json::parse(glb.substr(20, text));
  if (json.contains("buffers")) {
    EXPECT_EQ(word(20 + text) + 28 + text, glb.size());
    EXPECT_EQ(json["buffers"][0]["byteLength"], word(20 + text));
  }
  return json;
}

std::size_t keys_of(const Json& json, const std::string& node, const std::string& path) {
  for (const Json& channel : json["animations"][0]["channels"]) {
    const Json& target = channel["target"];
    if (json["nodes"][target["node"].get<std::size_t>()]["name"] != node || target["path"] != path) continue;
    const Json& sampler = json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    const Json& input = json["accessors"][sampler["input"].get<std::size_t>()];
    const Json& output = json["accessors"][sampler["output"].get<std::size_t>()];
    EXPECT_EQ(input["count"], output["count"]);
    EXPECT_EQ(input["min"].size(), 1u);
    return input["count"];
  }
  return 0;
}

TEST_F(GltfTest, WritesANodePerLinkAndAKeyPerFrame) {
  const auto writer = opened(make_gltf_writer(path("a.glb")));
  const auto seen = triangle({1, 0, 0});
  for (const char* name : {"one", "two"}) ASSERT_EQ(error_text(writer->add_body(three_links(name, seen))), "");
  std::vector<std::vector<MotionSample>> truth;
  for (int i = 0; i <= 50; i++) {
    truth.push_back({posed(0.2 * i, 0.3 * i), posed(-0.1 * i, std::cos(i), {0.1 * i, 0, 0}, -i)});
    ASSERT_EQ(error_text(writer->add_frame(2 + i / 25.0, truth.back())), "");
  }
  ASSERT_EQ(error_text(writer->finish()), "");
  EXPECT_EQ(files(), std::vector<std::string>{"a.glb"});
  const Json json = json_of(text("a.glb"));
  EXPECT_EQ(json["nodes"].size(), 1u + 2 + 6) << "the scene's root, two bodies, three links each";
  EXPECT_EQ(json["meshes"].size(), 1u) << "shared by four links";
  EXPECT_EQ(json["materials"].size(), 1u);
  EXPECT_EQ(json["animations"][0]["channels"].size(), 10u)
      << "position and rotation of five links: the base of `one` does not move";
  EXPECT_EQ(keys_of(json, "one.base", "translation"), 0u);
  for (const char* node : {"one.arm", "one.tip", "two.base", "two.arm", "two.tip"}) {
    EXPECT_EQ(keys_of(json, node, "translation"), 51u) << node;
    EXPECT_EQ(keys_of(json, node, "rotation"), 51u) << node;
  }
  const Loaded loaded(path("a.glb"));
  EXPECT_EQ(Loaded::count(loaded.scene().mRootNode), 9u);
  EXPECT_EQ(loaded.scene().mNumMeshes, 1u);
  EXPECT_NEAR(loaded.animation().mDuration / loaded.animation().mTicksPerSecond, 2, 1e-4) << "from 0 to 2 s";
  for (const unsigned frame : {0u, 23u, 50u}) {
    for (std::size_t b = 0; b < 2; b++) {
      for (const auto& [link, name] : {std::pair(0u, "base"), {1u, "arm"}, {2u, "tip"}}) {
        const Pose actual = loaded.z_up(std::string(b == 0 ? "one." : "two.") + name, frame);
        const Pose& expected = truth[frame][b].links[link];
        EXPECT_LT(glm::length(actual.position - expected.position), 1e-5) << name << frame;
        EXPECT_LT(angle_between(actual.rotation, expected.rotation), 1e-3) << name << frame;
      }
    }
  }
}

TEST_F(GltfTest, RotationsTakeTheShortWay) {
  const auto writer = opened(make_gltf_writer(path("a.glb")));
  ASSERT_EQ(error_text(writer->add_body(three_links("a"))), "");
  // after a full turn, the same rotation has the opposite quaternion
  for (int i = 0; i <= 100; i++)
    ASSERT_EQ(error_text(writer->add_frame(i, std::vector{posed(std::remainder(0.5 * i, 2 * kPi), 0)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Loaded loaded(path("a.glb"));
  const aiNodeAnim* const arm = loaded.channel("a.arm");
  ASSERT_NE(arm, nullptr);
  ASSERT_EQ(arm->mNumRotationKeys, 101u);
  for (unsigned i = 1; i <= 100; i++) {
    const aiQuaternion& a = arm->mRotationKeys[i - 1].mValue;
    const aiQuaternion& b = arm->mRotationKeys[i].mValue;
    ASSERT_NEAR(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, std::cos(0.25), 1e-4) << i;
  }
}

TEST_F(GltfTest, AbsentBodiesHaveScaleZero) {
  const auto writer = opened(make_gltf_writer(path("a.glb")));
  ASSERT_EQ(error_text(writer->add_body(three_links("goes"))), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{posed(0, 0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(1, std::vector{posed(1, 0)})), "");
  ASSERT_EQ(error_text(writer->add_body(three_links("comes"))), "");
  ASSERT_EQ(error_text(writer->add_frame(2, std::vector{absent(), posed(2, 0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(3, std::vector{posed(3, 0), posed(3, 0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(4, std::vector{absent(), posed(4, 0)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Json json = json_of(text("a.glb"));
  EXPECT_EQ(keys_of(json, "goes.arm", "rotation"), 4u) << "up to the last frame in which it is present";
  EXPECT_EQ(keys_of(json, "comes.arm", "rotation"), 3u);
  EXPECT_EQ(json["animations"][0]["samplers"][0]["interpolation"], "STEP");
  const Loaded loaded(path("a.glb"));
  const auto sizes = [&](const char* node) {
    std::vector<std::pair<double, double>> all;
    const aiNodeAnim* const keys = loaded.channel(node);
    for (unsigned i = 0; keys != nullptr && i < keys->mNumScalingKeys; i++)
      all.emplace_back(keys->mScalingKeys[i].mTime / loaded.animation().mTicksPerSecond,
                       keys->mScalingKeys[i].mValue.x);
    return all;
  };
  using Sizes = std::vector<std::pair<double, double>>;
  EXPECT_EQ(sizes("goes"), (Sizes{{0, 1}, {2, 0}, {3, 1}, {4, 0}}));
  EXPECT_EQ(sizes("comes"), (Sizes{{0, 0}, {2, 1}}));
  EXPECT_NEAR(loaded.channel("comes.arm")->mRotationKeys[0].mTime / loaded.animation().mTicksPerSecond, 2, 1e-6);
}

TEST_F(GltfTest, SharesEqualMaterialsAndMeshes) {
  const auto writer = opened(make_gltf_writer(path("a.gltf")));
  MotionBody body = three_links("a", triangle({0.5, 0.25, 1}, 0.5));
  body.links[1].surfaces = triangle({0.5, 0.25, 1}, 0.5);
  body.links[2].surfaces = triangle({0, 1, 0});
  ASSERT_EQ(error_text(writer->add_body(body)), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{posed(0, 0)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.bin", "a.gltf"}));
  const Json json = Json::parse(text("a.gltf"));
  EXPECT_EQ(json["buffers"][0]["uri"], "a.bin");
  EXPECT_EQ(json["buffers"][0]["byteLength"], text("a.bin").size());
  EXPECT_EQ(json["meshes"].size(), 3u);
  ASSERT_EQ(json["materials"].size(), 2u);
  EXPECT_EQ(json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 0.25, 1.0, 0.5}));
  EXPECT_EQ(json["materials"][0]["alphaMode"], "BLEND");
  EXPECT_FALSE(json.contains("animations")) << "a single frame has no motion";
  const Loaded loaded(path("a.gltf"));
  EXPECT_EQ(loaded.scene().mNumMeshes, 3u);
  EXPECT_NEAR(loaded.scene().mMeshes[0]->mVertices[2].z, 0.3, 1e-6);
}

TEST_F(GltfTest, MakesNamesUnique) {
  const auto writer = opened(make_gltf_writer(path("my show & 雪.gltf")));
  for (const char* name : {"limber", "a b", "a b", "größe \"x\""})
    ASSERT_EQ(error_text(writer->add_body(three_links(name))), "");
  const std::vector<MotionSample> four(4, posed(0, 0));
  const std::vector<MotionSample> turned(4, posed(1, 0));
  ASSERT_EQ(error_text(writer->add_frame(0, four)), "");
  ASSERT_EQ(error_text(writer->add_frame(1, turned)), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Json json = Json::parse(text("my show & 雪.gltf"));
  EXPECT_EQ(json["buffers"][0]["uri"], "my%20show%20%26%20%E9%9B%AA.bin");
  std::set<std::string> names;
  for (const Json& node : json["nodes"]) names.insert(node["name"].get<std::string>());
  EXPECT_EQ(names.size(), 17u);
  for (const char* name : {"limber-2", "a b", "a b-2", "a b.arm-2", "größe \"x\".tip"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(GltfTest, WritesASceneWithoutBodies) {
  const auto writer = opened(make_gltf_writer(path("a.glb")));
  ASSERT_EQ(error_text(writer->add_frame(0, {})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Json json = json_of(text("a.glb"));
  EXPECT_EQ(json["nodes"].size(), 1u);
  EXPECT_FALSE(json.contains("animations"));
}

TEST_F(GltfTest, ReportsTooManyKeys) {
  auto writer = make_gltf_writer(path("a.glb"), 28 * 3 * 2);
  ASSERT_TRUE(writer) << writer.error();
  ASSERT_EQ(error_text((*writer)->add_body(three_links("a"))), "");
  ASSERT_EQ(error_text((*writer)->add_frame(0, std::vector{posed(0, 0)})), "");
  ASSERT_EQ(error_text((*writer)->add_frame(1, std::vector{posed(0, 0)})), "");
  EXPECT_EQ(error_text((*writer)->add_frame(2, std::vector{posed(0, 0)})),
            path("a.glb") +
                ": the keys of 3 frames take 0 MB, more than most programs read. Choose bodies with --body, fewer "
                "frames with --rate, or a range with --from and --to");
}

TEST_F(GltfTest, ReportsAFullDiskAndLeavesNoFile) {
  for (const char* name : {"a.glb", "a.gltf"}) {
    const auto writer = opened(make_gltf_writer(path(name)));
    ASSERT_EQ(error_text(writer->add_body(three_links("a"))), "");
    for (int i = 0; i < 2000; i++) ASSERT_EQ(error_text(writer->add_frame(i, std::vector{posed(0.01 * i, 0)})), "");
    const FullDisk full(50000);
    EXPECT_NE(error_text(writer->finish()).find("can't be written: File too large"), std::string::npos);
  }
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(GltfTest, WritesColorsOfPoints) {
  const auto writer = opened(make_gltf_writer(path("a.glb")));
  Surfaces surfaces = *triangle({1, 1, 1});
  surfaces[0].colors.assign(surfaces[0].points.size(), {0.25F, 0.5F, 1});
  const auto seen = std::make_shared<const Surfaces>(surfaces);
  ASSERT_EQ(error_text(writer->add_body(three_links("one", seen))), "");
  const std::vector<MotionSample> frame{posed(0, 0)};
  ASSERT_EQ(error_text(writer->add_frame(0, frame)), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const std::string glb = text("a.glb");
  const Json json = json_of(glb);
  const Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  const Json& colors = json["accessors"][attributes["COLOR_0"].get<std::size_t>()];
  EXPECT_EQ(colors["count"], json["accessors"][attributes["POSITION"].get<std::size_t>()]["count"]);
  const Json& view = json["bufferViews"][colors["bufferView"].get<std::size_t>()];
  const std::size_t binary = glb.size() - json["buffers"][0]["byteLength"].get<std::size_t>();
  std::array<float, 3> first{};
  std::memcpy(first.data(), glb.data() + binary + view.value("byteOffset", std::size_t{0}), sizeof first);
  EXPECT_EQ(first, (std::array<float, 3>{0.25F, 0.5F, 1}));
}

}  // namespace
}  // namespace limber::exporter::test
