// Pictures of meshes with colors and textures of their own; the expected pixels are computed independently.
#include <epoxy/gl.h>

#include <array>
#include <cmath>

#include "base/color.h"
#include "model/look/mesh_look.h"
#include "model/mesh/load.h"
#include "render/stage.h"
#include "ui/render/lighting.h"
#include "ui/render/pick.h"
#include "ui/render/texture.h"

namespace limber::render::test {
namespace {

constexpr int kWidth = 160, kHeight = 120;

// A square of 1 m that faces -y, with its center at the origin: two triangles, split from the bottom left to the top
// right.
std::shared_ptr<model::MeshModel> square() {
  const auto mesh = model::mesh_from_bytes("v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 0 0.5\nv -0.5 0 0.5\nf 1 2 3\nf 1 3 4\n",
                                           model::MeshFormat::obj, Vec3(1), "square");
  EXPECT_TRUE(mesh) << mesh.error();
  return std::make_shared<model::MeshModel>(**mesh);
}

// an image of four quarters
std::shared_ptr<const model::Image> quarters(const std::array<Vec3, 4>& colors) {
  auto image = std::make_shared<model::Image>();
  image->width = image->height = 16;
  for (int y = 0; y < 16; y++) {
    for (int x = 0; x < 16; x++) {
      const Vec3& c = colors[static_cast<std::size_t>((y < 8 ? 0 : 2) + (x < 8 ? 0 : 1))];
      for (int i = 0; i < 3; i++) image->pixels.push_back(static_cast<std::uint8_t>(255 * c[i] + 0.5));
      image->pixels.push_back(255);
    }
  }
  return image;
}

model::ShapeModel shape_of(std::shared_ptr<const model::MeshModel> mesh) {
  model::ShapeModel shape;
  shape.kind = model::ShapeKind::mesh;
  shape.mesh = std::move(mesh);
  return shape;
}

// Texture coordinates of the square's corners, from the top left of the image.
std::vector<model::TexCoord> square_texcoords() { return {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}}; }

// lit by ambient light alone, above the layer near the floor in which it decreases
struct AmbientScene : TestScene {
  static constexpr double kHeightAboveFloor = 2;
  AmbientScene() {
    for (const char* light : {"lamp", "rim", "fog", "floor"}) set(fmt::format("/visuals/look/{}", light), {0});
    look_from({0, -2.2, kHeightAboveFloor}, {0, 0, kHeightAboveFloor});
  }
  sim::Part& add_square(const std::shared_ptr<const model::MeshModel>& mesh) {
    return add("square", shape_of(mesh), {0, 0, kHeightAboveFloor});
  }
};

// The pixel of a vertical surface of this color (sRGB) in ambient light, 0..255: half of the light from above, half of
// that from below, tone mapped and encoded.
Vec3 expected_pixel(const engine::Snapshot& now, const Vec3& color, const Vec3& emission = Vec3(0)) {
  const CameraMatrices camera = camera_matrices(engine::camera_of(now), kWidth, kHeight);
  const Lighting lighting = compute_lighting(engine::appearance_of(now), camera, engine::camera_of(now).far,
                                             {glm::vec3(0, 0, 2), 1, 0, 1024});
  Vec3 out;
  for (int i = 0; i < 3; i++) {
    const double ambient = 0.5 * (lighting.frame.sky[i] + lighting.frame.ground[i]);
    const double light = linear_light_of(color[i]) * ambient + linear_light_of(emission[i]);
    const double x = light * lighting.frame.exposure;
    out[i] = 255 * encoded_of(std::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0));
  }
  return out;
}

void expect_color(const Pixels& image, const engine::Snapshot& now, const Vec3& point, const Vec3& expected,
                  const char* what, double tolerance = 3) {
  const Spot spot = spot_of(now, point + Vec3(0, 0, AmbientScene::kHeightAboveFloor), kWidth, kHeight);
  const Vec3 c = color(image, spot.x, spot.y);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(c[i], expected[i], tolerance) << what << ", channel " << i;
}

const Vec3 kBottomRight{0.25, 0, -0.25}, kTopLeft{-0.25, 0, 0.25}, kTopRight{0.25, 0, 0.25},
    kBottomLeft{-0.25, 0, -0.25};

TEST(MeshLook, TriangleShowsTheColorOfItsMaterial) {
  for (const GlApi api : {GlApi::core, GlApi::es}) {
    AmbientScene scene;
    const auto mesh = square();
    auto look = std::make_shared<model::MeshLook>();
    look->materials.resize(2);
    look->materials[0].color = Vec3(0.8, 0.3, 0.1);
    look->materials[1].color = Vec3(0.1, 0.4, 0.05);
    look->materials[1].emission = Vec3(0, 0, 0.5);
    look->triangle_materials = {0, 1};
    mesh->look = look;
    scene.add_square(mesh);
    const auto now = scene.snapshot();
    const Pixels image = draw(*now, kWidth, kHeight, Quality::low, api);
    expect_color(image, *now, kBottomRight, expected_pixel(*now, {0.8, 0.3, 0.1}), "first triangle");
    expect_color(image, *now, kTopLeft, expected_pixel(*now, {0.1, 0.4, 0.05}, {0, 0, 0.5}), "second triangle");
  }
}

TEST(MeshLook, TexturedSquareShowsItsFourQuarters) {
  const std::array<Vec3, 4> colors{Vec3(1, 0.2, 0.2), Vec3(0.2, 0.8, 0.2), Vec3(0.2, 0.2, 0.6), Vec3(0.9, 0.9, 0.1)};
  for (const GlApi api : {GlApi::core, GlApi::es}) {
    AmbientScene scene;
    const auto mesh = square();
    auto look = std::make_shared<model::MeshLook>();
    look->materials.resize(1);
    look->materials[0].texture = quarters(colors);
    look->triangle_materials = {0, 0};
    look->texcoords = square_texcoords();
    mesh->look = look;
    scene.add_square(mesh);
    const auto now = scene.snapshot();
    const Pixels image = draw(*now, kWidth, kHeight, Quality::high, api);
    expect_color(image, *now, kTopLeft, expected_pixel(*now, colors[0]), "top left", 4);
    expect_color(image, *now, kTopRight, expected_pixel(*now, colors[1]), "top right", 4);
    expect_color(image, *now, kBottomLeft, expected_pixel(*now, colors[2]), "bottom left", 4);
    expect_color(image, *now, kBottomRight, expected_pixel(*now, colors[3]), "bottom right", 4);
  }
}

// the textures of the current context
int texture_count() {
  constexpr GLuint kMaxName = 1000;
  int count = 0;
  for (GLuint name = 1; name < kMaxName; name++) count += glIsTexture(name) == GL_TRUE ? 1 : 0;
  return count;
}

TEST(MeshLook, TexturesAreUploadedOnceAndFreedWithTheirScene) {
  AmbientScene empty;
  (void)draw(empty, kWidth, kHeight);
  const int before = texture_count();
  {
    AmbientScene scene;
    for (const char* name : {"one", "two"}) {
      const auto mesh = square();
      auto look = std::make_shared<model::MeshLook>();
      look->materials.resize(2);
      for (model::MeshMaterial& material : look->materials)
        material.texture = quarters({Vec3(1), Vec3(0.5), Vec3(0.25), Vec3(0)});
      look->triangle_materials = {0, 1};
      look->texcoords = square_texcoords();
      mesh->look = look;
      scene.add(name, shape_of(mesh), {0, 0, 2});
    }
    for (int frame = 0; frame < 3; frame++) {
      (void)draw(scene, kWidth, kHeight);
      EXPECT_EQ(texture_count(), before + 4) << frame;
    }
  }
  (void)draw(empty, kWidth, kHeight);
  EXPECT_EQ(texture_count(), before);
}

TEST(MeshLook, CornerColorsMultiplyTheMaterial) {
  AmbientScene scene;
  const auto mesh = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(1);
  look->triangle_materials = {0, 0};
  look->colors.assign(3, {255, 128, 0, 255});
  look->colors.resize(6, {0, 64, 255, 255});
  mesh->look = look;
  scene.add_square(mesh);
  const auto now = scene.snapshot();
  const Pixels image = draw(*now, kWidth, kHeight);
  expect_color(image, *now, kBottomRight, expected_pixel(*now, Vec3(255, 128, 0) / 255.0), "first triangle");
  expect_color(image, *now, kTopLeft, expected_pixel(*now, Vec3(0, 64, 255) / 255.0), "second triangle");
}

TEST(MeshLook, ColorOfTheModelFileReplacesThatOfTheMesh) {
  AmbientScene scene;
  const auto mesh = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(1);
  look->materials[0].color = Vec3(1, 0, 0);
  look->triangle_materials = {0, 0};
  look->texcoords = square_texcoords();
  mesh->look = look;
  model::ShapeModel plain = shape_of(mesh);
  plain.mesh_colors = false;
  scene.add("square", plain, {0, 0, AmbientScene::kHeightAboveFloor});
  scene.paint("square", hsb_of({0.2, 0.4, 0.6}));
  const auto now = scene.snapshot();
  expect_color(draw(*now, kWidth, kHeight), *now, kTopLeft, expected_pixel(*now, {0.2, 0.4, 0.6}), "color");

  AmbientScene textured;
  const std::array<Vec3, 4> colors{Vec3(1, 1, 1), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5, 0.5, 0)};
  plain.texture = quarters(colors);
  textured.add("square", plain, {0, 0, AmbientScene::kHeightAboveFloor});
  const auto then = textured.snapshot();
  const Pixels image = draw(*then, kWidth, kHeight);
  expect_color(image, *then, kTopRight, expected_pixel(*then, colors[1]), "texture", 4);
  expect_color(image, *then, kBottomRight, expected_pixel(*then, colors[3]), "texture", 4);
}

// sRGB values multiply in linear light.
TEST(MeshLook, TintMultipliesTheColorsOfAPart) {
  AmbientScene scene;
  const auto mesh = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(1);
  look->materials[0].color = Vec3(0.8, 0.6, 0.4);
  look->triangle_materials = {0, 0};
  mesh->look = look;
  scene.add_square(mesh);
  const Vec3 tint(0.5, 1, 0.25);
  const Vec3 hsb = hsb_of(tint);
  scene.set("/physics/body/square/part/part/tint", {hsb.x, hsb.y, hsb.z});
  const auto now = scene.snapshot();
  Vec3 product;
  for (int i = 0; i < 3; i++)
    product[i] = encoded_of(linear_light_of(tint[i]) * linear_light_of(look->materials[0].color[i]));
  expect_color(draw(*now, kWidth, kHeight), *now, kTopLeft, expected_pixel(*now, product), "tint");
  scene.set("/physics/body/square/part/part/transparency", {1});
  AmbientScene empty;
  EXPECT_EQ(draw(scene, kWidth, kHeight).bytes, draw(empty, kWidth, kHeight).bytes) << "transparency 1: invisible";
}

TEST(MeshLook, TintColorsPrimitivesAndEachPartOnItsOwn) {
  AmbientScene scene;
  sim::Shape& shape = **scene.world.shapes().add("box", box({0.4, 0.4, 0.4}));
  sim::Body& body = **scene.world.add_body("pair");
  ASSERT_TRUE(body.add_part("left", shape, 0, {{-0.4, 0, 2}, quat_identity()}).ok());
  ASSERT_TRUE(body.add_part("right", shape, 0, {{0.4, 0, 2}, quat_identity()}).ok());
  scene.set("/physics/body/pair/part/left/tint", {0, 1, 1});
  const auto now = scene.snapshot();
  const Pixels image = draw(*now, kWidth, kHeight);
  expect_color(image, *now, {-0.4, -0.2, 0}, expected_pixel(*now, {1, 0, 0}), "red");
  expect_color(image, *now, {0.4, -0.2, 0}, expected_pixel(*now, {1, 1, 1}), "white");
}

// A half transparent material is drawn after the opaque ones, and lets half of the square behind through.
TEST(MeshLook, TransparentMaterialShowsWhatIsBehind) {
  AmbientScene scene;
  const auto front = square(), behind = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(2);
  look->materials[0].color = Vec3(0, 0, 1);
  look->materials[0].alpha = 0.5;
  look->materials[1].color = Vec3(0, 0, 1);
  look->triangle_materials = {0, 1};
  front->look = look;
  scene.add("front", shape_of(front), {0, -0.1, 2});
  scene.add("behind", shape_of(behind), {0, 0.1, 2});
  scene.paint("behind", {0, 1, 1});
  const auto now = scene.snapshot();
  const Pixels image = draw(*now, kWidth, kHeight);
  const Vec3 red = expected_pixel(*now, {1, 0, 0}), blue = expected_pixel(*now, {0, 0, 1});
  // blended in linear light
  Vec3 mixed;
  for (int i = 0; i < 3; i++)
    mixed[i] = 255 * encoded_of((linear_light_of(red[i] / 255) + linear_light_of(blue[i] / 255)) / 2);
  expect_color(image, *now, kBottomRight + Vec3(0, -0.1, 0), mixed, "half transparent", 5);
  expect_color(image, *now, kTopLeft + Vec3(0, -0.1, 0), blue, "opaque");
}

TEST(MeshLook, ColoredMeshCastsTheShadowOfAPlainOneAndIsPicked) {
  const auto mesh = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(2);
  look->triangle_materials = {0, 1};
  look->materials[1].name = "white as well";
  const auto picture = [&] {
    TestScene scene;
    scene.add("square", shape_of(mesh), {0, 0, 1});
    scene.look_from({1, -3, 2}, {0, 0, 0.5});
    const auto now = scene.snapshot();
    const CameraMatrices camera = camera_matrices(engine::camera_of(*now), kWidth, kHeight);
    const glm::vec4 clip = camera.projection * camera.view * glm::vec4(0.1F, 0, 1.1F, 1);
    const auto picked = pick(*now, camera, clip.x / clip.w, clip.y / clip.w);
    EXPECT_TRUE(picked.has_value());
    return draw(*now, kWidth, kHeight, Quality::medium).bytes;
  };
  const auto plain = picture();
  mesh->look = look;
  const auto colored = picture();
  // white materials: the same picture, shadow included
  int differing = 0;
  for (std::size_t i = 0; i < plain.size(); i++) differing += std::abs(int{plain[i]} - int{colored[i]}) > 1 ? 1 : 0;
  EXPECT_EQ(differing, 0);
}

TEST(MeshLook, BoxShowsTheTextureUprightOnItsSides) {
  AmbientScene scene;
  const std::array<Vec3, 4> colors{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0)};
  model::ShapeModel textured = box({1, 1, 1});
  textured.texture = quarters(colors);
  scene.add("box", textured, {0, 0.5, 2});
  for (const double turn : {0.0, kPi / 2, kPi, -kPi / 2}) {
    scene.set("/physics/body/box/part/part/rotation", {0, 0, std::sin(turn / 2), std::cos(turn / 2)});
    const auto now = scene.snapshot();
    const Pixels image = draw(*now, kWidth, kHeight);
    expect_color(image, *now, kTopLeft, expected_pixel(*now, colors[0]), "top left", 4);
    expect_color(image, *now, kTopRight, expected_pixel(*now, colors[1]), "top right", 4);
    expect_color(image, *now, kBottomLeft, expected_pixel(*now, colors[2]), "bottom left", 4);
    expect_color(image, *now, kBottomRight, expected_pixel(*now, colors[3]), "bottom right", 4);
  }
}

TEST(MeshLook, HalvedImagesAreTheMeanInLinearLight) {
  model::Image image;
  image.width = 3;
  image.height = 2;
  for (const int gray : {0, 255, 90, 255, 0, 90}) {
    for (int i = 0; i < 3; i++) image.pixels.push_back(static_cast<std::uint8_t>(gray));
    image.pixels.push_back(255);
  }
  const model::Image half = halved(image);
  ASSERT_EQ(half.width, 1);
  ASSERT_EQ(half.height, 1);
  EXPECT_EQ(half.pixels, (std::vector<std::uint8_t>{188, 188, 188, 255}));  // sRGB of 0.5
}

TEST(MeshLook, MaterialsWithOneTextureAndAlphaAreOnePart) {
  const auto mesh = square();
  auto look = std::make_shared<model::MeshLook>();
  look->materials.resize(4);
  look->materials[1].color = Vec3(1, 0, 0);
  look->materials[2].alpha = 0.5;
  look->materials[3].texture = quarters({Vec3(1), Vec3(1), Vec3(1), Vec3(1)});
  look->triangle_materials = {3, 1};
  mesh->look = look;
  const model::ShapeModel shape = shape_of(mesh);
  const std::vector<MeshPart> parts = mesh_parts(shape);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0], (MeshPart{nullptr, 1}));
  EXPECT_EQ(parts[1], (MeshPart{nullptr, 0.5}));
  EXPECT_EQ(parts[2], (MeshPart{look->materials[3].texture, 1}));
  const std::vector<ColoredVertices> meshes = colored_meshes(shape, 0);
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[0].size(), 3u);
  EXPECT_EQ(meshes[1].size(), 0u);
  EXPECT_EQ(meshes[2].size(), 3u);
}

}  // namespace
}  // namespace limber::render::test
