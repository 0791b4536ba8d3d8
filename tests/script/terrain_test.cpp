// sim:add_heightfield_shape and sim:add_mesh_shape: functions, lists, pictures, files, errors.
#include <string>

#include <gtest/gtest.h>

#include "stage.h"

namespace limber::script {
namespace {

// a gray picture of 2 × 2 pixels: 0 51 above 102 255
const std::string kPng(
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00\x00\x02"
    "\x08\x00\x00\x00\x00\x57\xdd\x52\xf8\x00\x00\x00\x0e\x49\x44\x41\x54\x78\xda\x63\x60\x30\x66\x48"
    "\xfb\x0f\x00\x02\x9d\x01\x99\x2f\x6e\x74\x03\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
    71);

struct TerrainScene : testing::Test {
  std::string value(const std::string& lua) {
    const std::string fault = fixture.run(lua);
    return fault.empty() ? fixture.host.printed.back() : fault;
  }
  ScriptFixture fixture;
};

constexpr const char* kHeights =
    "local function heights(options)\n"
    "  sim:add_body('ground'):add_part('ground', sim:add_heightfield_shape('hill', options))\n"
    "  local out = {}\n"
    "  for _, y in ipairs { -0.99999, 0.99999 } do for _, x in ipairs { -1.99999, 1.99999 } do\n"
    "    local hit = sim:ray(vec3(x, y, 9), vec3(x, y, -9))\n"
    "    out[#out + 1] = string.format('%.3f', hit.position.z)\n"
    "  end end\n"
    "  print(table.concat(out, ' '))\n"
    "end\n";

TEST_F(TerrainScene, TakesAFunctionOfThePlace) {
  EXPECT_EQ(
      value(std::string(kHeights) +
            "heights { size = { 4, 2 }, rows = 3, columns = 5, heights = function(x, y) return x + 10 * y / 4 end }"),
      "-4.500 -0.500 0.500 4.500");
}

TEST_F(TerrainScene, TakesAList) {
  EXPECT_EQ(
      value(std::string(kHeights) + "heights { size = { 4, 2 }, rows = 2, columns = 2, heights = { 1, 2, 3, 4 } }"),
      "1.000 2.000 3.000 4.000");
}

TEST_F(TerrainScene, TakesAPicture) {
  fixture.write("hill.png", kPng);
  EXPECT_EQ(value(std::string(kHeights) + "heights { size = { 4, 2 }, image = 'hill.png', height = 5 }"),
            "2.000 5.000 0.000 1.000");
}

TEST_F(TerrainScene, AMeshIsHollow) {
  // a roof, open below
  fixture.write("roof.obj", "v -1 -1 0\nv 1 -1 0\nv 0 -1 1\nv -1 1 0\nv 1 1 0\nv 0 1 1\nf 1 3 6 4\nf 3 2 5 6\n");
  EXPECT_EQ(
      value("sim:add_body('roof'):add_part('roof', sim:add_mesh_shape('roof', 'roof.obj', { scale = 2 }))\n"
            "print(sim:ray(vec3(1, 0.1, 0), vec3(1, 0.1, 9)).position.z, sim:ray(vec3(1, 0.1, 0), vec3(1, 0.1, -9)))"),
      "1\tnil");
}

TEST_F(TerrainScene, ReportsWrongOptions) {
  const auto fault = [](const std::string& options) {
    ScriptFixture fresh;
    return fresh.run("sim:add_heightfield_shape('hill', " + options + ")");
  };
  EXPECT_NE(fault("{ size = 3 }").find("size is { x, y } in meters, not 3"), std::string::npos);
  EXPECT_NE(fault("{ size = { 0, 1 } }").find("size x must be above 0, not 0"), std::string::npos);
  EXPECT_NE(fault("{ size = { 1, 1 }, rows = 2, columns = 2000 }").find("columns is 2 .. 1024, not 2000"),
            std::string::npos);
  EXPECT_NE(fault("{ size = { 1, 1 }, rows = 2, columns = 2, heights = { 1, 2, 3 } }").find("need 4 heights, not 3"),
            std::string::npos);
  EXPECT_NE(fault("{ size = { 1, 1 }, rows = 2, columns = 2, heights = { 1, 2, 3, 1e9 } }").find("heights are -10000"),
            std::string::npos);
  EXPECT_NE(fault("{ size = { 1, 1 }, image = 'none.png', height = 1 }").find("there is no file 'none.png'"),
            std::string::npos);
  EXPECT_NE(fault("{ size = { 1, 1 }, image = 'none.png', rows = 3 }").find("an image has rows"), std::string::npos);
}

}  // namespace
}  // namespace limber::script
