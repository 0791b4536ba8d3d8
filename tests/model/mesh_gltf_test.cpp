// glTF reader: scenes, accessors, materials and images; containers; errors for invalid files.
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "model/look/mesh_look.h"
#include "model/mesh/load.h"
#include "support/images.h"

namespace limber::model {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

template <class T>
std::string raw(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

// A tetrahedron: 4 points, their texture coordinates, 12 indices of 16 bits.
std::string tetrahedron_buffer() {
  return raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) + raw<float>({0, 0, 1, 0, 0, 1, 0.25F, 0.75F}) +
         raw<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});
}

struct GltfText {
  std::string nodes = "[{\"mesh\":0}]";
  std::string materials = "[]";
  std::string images = "[]";
  std::string primitive = "\"material\":0";
  std::string buffer = "\"uri\":\"data:application/octet-stream;base64," + base64(tetrahedron_buffer()) + "\",";
  std::string extra;

  std::string text() const {
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":" + nodes +
           ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2," +
           primitive + "}]}],\"materials\":" + materials + ",\"textures\":[{\"source\":0}],\"images\":" + images +
           ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
           "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
           "{\"bufferView\":2,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
           "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":24}],\"buffers\":[{" +
           buffer + "\"byteLength\":104}]" + extra + "}";
  }
};

std::string glb(std::string json, const std::string& binary) {
  while (json.size() % 4 != 0) json += ' ';
  const auto word = [](std::size_t value) { return raw<std::uint32_t>({static_cast<std::uint32_t>(value)}); };
  return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" + json +
         word(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::shared_ptr<const MeshModel> gltf_mesh(const std::string& text) {
  const auto mesh = mesh_from_bytes(text, MeshFormat::gltf, Vec3(1), "m");
  EXPECT_TRUE(mesh) << mesh.error();
  return mesh ? *mesh : nullptr;
}
std::string gltf_error(const std::string& text) {
  const auto mesh = mesh_from_bytes(text, MeshFormat::gltf, Vec3(1), "m");
  return mesh ? "read" : mesh.error();
}

TEST(MeshGltf, TurnsYUpToZUp) {
  const auto mesh = gltf_mesh(GltfText().text());
  ASSERT_TRUE(mesh != nullptr && mesh->vertices.size() == 4);
  EXPECT_NEAR(mesh->unit_inertial.mass, 1.0 / 6, 1e-9);
  // the point at y = 1 is at z = 1, the one at z = 1 at y = -1
  const std::vector<Vec3> expected{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(glm::length(mesh->vertices[i] - expected[i]), 1e-12) << i;
}

TEST(MeshGltf, NodesPlaceAndInstanceMeshes) {
  GltfText file;
  file.nodes =
      "[{\"children\":[1,2],\"translation\":[0,0,-3]},{\"mesh\":0,\"scale\":[2,2,2]},"
      "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]}]";
  const auto mesh = gltf_mesh(file.text());
  ASSERT_TRUE(mesh != nullptr && mesh->vertices.size() == 8);
  EXPECT_NEAR(mesh->unit_inertial.mass, (8 + 1) / 6.0, 1e-9);
  EXPECT_LT(glm::length(mesh->vertices[0] - Vec3(0, 3, 0)), 1e-12);
  EXPECT_LT(glm::length(mesh->vertices[4] - Vec3(10, 3, 0)), 1e-12);
  ASSERT_EQ(mesh->pieces.size(), 2u) << "each node is a piece";
  EXPECT_NEAR(mesh->pieces[1].shape.mesh->unit_inertial.mass, 1 / 6.0, 1e-9);
}

// The factors of glTF are linear light.
TEST(MeshGltf, MaterialsAreConvertedToSrgb) {
  GltfText file;
  file.materials =
      "[{\"name\":\"m\",\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.21586,0,0.5],"
      "\"baseColorTexture\":{\"index\":0}},\"emissiveFactor\":[0,0,1],\"normalTexture\":{\"index\":0}}]";
  file.images =
      "[{\"uri\":\"data:image/png;base64," + base64(limber::test::png(1, {limber::test::Rgb{9, 8, 7}})) + "\"}]";
  const auto mesh = gltf_mesh(file.text());
  ASSERT_TRUE(mesh != nullptr && has_colors(*mesh));
  const MeshMaterial& material = mesh->look->materials.at(mesh->look->triangle_materials.at(0));
  EXPECT_EQ(material.name, "m");
  EXPECT_LT(glm::length(material.color - Vec3(1, 0.50196, 0)), 1e-3);
  EXPECT_LT(glm::length(material.emission - Vec3(0, 0, 1)), 1e-9);
  EXPECT_EQ(material.alpha, 0.5);
  ASSERT_NE(material.texture, nullptr);
  EXPECT_EQ(material.texture->pixels, (std::vector<std::uint8_t>{9, 8, 7, 255}));
  // from the top left in the file, too
  for (std::size_t k = 0; k < 12; ++k) {
    if (mesh->vertices[mesh->triangles[k]] != Vec3(0, -1, 0)) continue;
    EXPECT_EQ(mesh->look->texcoords.at(k), (TexCoord{0.25F, 0.75F}));
  }
  ASSERT_EQ(mesh->look->problems.size(), 1u);
  EXPECT_NE(mesh->look->problems[0].text.find("normalTexture is not drawn"), std::string::npos);
}

TEST(MeshGltf, ReadsGlbAndFilesBeside) {
  GltfText file;
  file.buffer = "";
  const auto binary = mesh_from_bytes(glb(file.text(), tetrahedron_buffer()), MeshFormat::glb, Vec3(1), "m");
  ASSERT_TRUE(binary) << binary.error();
  EXPECT_EQ((*binary)->vertices.size(), 4u);
  const test::Files files;
  files.write("data.bin", tetrahedron_buffer());
  files.write("skin.png", limber::test::png(1, {limber::test::Rgb{1, 2, 3}}));
  file.buffer = "\"uri\":\"data.bin\",";
  file.images = "[{\"uri\":\"skin.png\"}]";
  file.materials = "[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]";
  MeshLibrary library;
  const auto beside = library.load(files.write("m.gltf", file.text()), Vec3(1));
  ASSERT_TRUE(beside) << beside.error();
  ASSERT_TRUE(has_colors(**beside));
  EXPECT_NE((*beside)->look->materials.at(0).texture, nullptr);
  EXPECT_EQ((*beside)->look->files.size(), 2u);
}

TEST(MeshGltf, RejectsInvalidFiles) {
  const GltfText good;
  EXPECT_EQ(gltf_error(good.text()), "read");
  EXPECT_NE(gltf_error("{").find("not a glTF file"), std::string::npos);
  EXPECT_NE(gltf_error("[]").find("not a glTF file"), std::string::npos);
  GltfText file;
  file.nodes = "[{\"children\":[0]}]";
  EXPECT_NE(gltf_error(file.text()).find("cycle"), std::string::npos) << gltf_error(file.text());
  file = {};
  file.buffer = "\"uri\":\"data:;base64,AAAA\",";
  EXPECT_NE(gltf_error(file.text()).find("beyond its buffer"), std::string::npos) << gltf_error(file.text());
  file.buffer = "\"uri\":\"../../etc/passwd\",";
  EXPECT_NE(gltf_error(file.text()).find("Export it as GLB"), std::string::npos) << gltf_error(file.text());
  file = {};
  file.extra = ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]";
  EXPECT_NE(gltf_error(file.text()).find("without compression"), std::string::npos);
  std::string text = good.text();
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return gltf_error(changed);
  };
  EXPECT_NE(replaced("\"count\":4", "\"count\":4000000000"), "read");
  EXPECT_NE(replaced("\"count\":4", "\"count\":-1"), "read");
  EXPECT_NE(replaced("\"count\":4", "\"count\":3").find("has a triangle with point 3"), std::string::npos);
  EXPECT_NE(replaced("5126", "5124"), "read");
  EXPECT_NE(replaced("\"version\":\"2.0\"", "\"version\":\"1.0\"").find("version '1.0'"), std::string::npos);
}

// ---- PLY

std::string ply_error(const std::string& bytes) {
  const auto mesh = mesh_from_bytes(bytes, MeshFormat::ply, Vec3(1), "m");
  return mesh ? "read" : mesh.error();
}

const char* const kPlyBody =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";

TEST(MeshPly, ReadsAsciiWithColors) {
  const std::string text =
      std::string("ply\nformat ascii 1.0\ncomment made by hand\n") + kPlyBody +
      "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n0 0 1 0 128 255\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  const auto mesh = mesh_from_bytes(text, MeshFormat::ply, Vec3(1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 1.0 / 6, 1e-9);
  ASSERT_EQ((*mesh)->look->colors.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    const bool top = (*mesh)->vertices[(*mesh)->triangles[k]].z > 0;
    EXPECT_EQ((*mesh)->look->colors[k], (top ? CornerColor{0, 128, 255, 255} : CornerColor{255, 0, 0, 255})) << k;
  }
}

TEST(MeshPly, ReadsBothByteOrders) {
  const std::vector<std::array<float, 3>> points{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  const std::vector<std::array<std::int32_t, 3>> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\r\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\r\n" + kPlyBody;
    const auto add = [&](auto value) {
      std::string raw_bytes(sizeof value, '\0');
      std::memcpy(raw_bytes.data(), &value, sizeof value);
      if (big) raw_bytes.assign(raw_bytes.rbegin(), raw_bytes.rend());
      bytes += raw_bytes;
    };
    for (const auto& p : points) {
      for (const float v : p) add(v);
      bytes += "\x01\x02\x03";
    }
    for (const auto& f : faces) {
      bytes += '\x03';
      for (const std::int32_t v : f) add(v);
    }
    const auto mesh = mesh_from_bytes(bytes, MeshFormat::ply, Vec3(1), "m");
    ASSERT_TRUE(mesh) << mesh.error();
    EXPECT_NEAR((*mesh)->unit_inertial.mass, 8.0 / 6, 1e-9);
    EXPECT_EQ((*mesh)->look->colors.at(0), (CornerColor{1, 2, 3, 255}));
    EXPECT_NE(ply_error(bytes.substr(0, bytes.size() - 1)).find("ends too early"), std::string::npos);
  }
}

TEST(MeshPly, ReadsTexturesOfFaces) {
  const test::Files files;
  files.write("skin.png", limber::test::png(1, {limber::test::Rgb{1, 2, 3}}));
  std::string text =
      "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nelement face 4\nproperty list uchar int vertex_index\nproperty list uchar float texcoord\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (const char* face : {"0 2 1", "0 1 3", "1 2 3", "0 3 2"}) text += fmt::format("3 {} 6 0 0 0.25 1 1 0.75\n", face);
  MeshLibrary library;
  const auto mesh = library.load(files.write("m.ply", text), Vec3(1));
  ASSERT_TRUE(mesh) << mesh.error();
  ASSERT_TRUE(has_colors(**mesh));
  EXPECT_NE((*mesh)->look->materials.at(0).texture, nullptr);
  EXPECT_EQ((*mesh)->look->texcoords.at(0), (TexCoord{0, 1})) << "from the bottom left in the file";
  EXPECT_EQ((*mesh)->look->texcoords.at(1), (TexCoord{0.25F, 0}));
  EXPECT_EQ((*mesh)->look->texcoords.at(2), (TexCoord{1, 0.25F}));
}

TEST(MeshPly, RejectsInvalidFiles) {
  const std::string ascii = "ply\nformat ascii 1.0\n";
  EXPECT_NE(ply_error("plyx").find("not a PLY file"), std::string::npos);
  EXPECT_NE(ply_error(ascii).find("header is incomplete"), std::string::npos);
  EXPECT_NE(ply_error(ascii + "element vertex 4000000000\nproperty float x\nend_header\n1\n").find("ends too early"),
            std::string::npos);
  EXPECT_NE(ply_error(ascii + "element vertex 1\nproperty quad x\nend_header\n1\n")
                .find("line 4: unknown type of property 'x'"),
            std::string::npos);
  EXPECT_NE(ply_error(ascii + "element vertex 1\nproperty float x\nend_header\n1\n").find("without x, y and z"),
            std::string::npos);
  const std::string points = ascii +
                             "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_index\nend_header\n";
  EXPECT_NE(ply_error(points + "0 0 0\n3 0 0 7\n").find("has a face with vertex 7"), std::string::npos);
  EXPECT_NE(ply_error(points + "0 0 nan\n").find("line 10"), std::string::npos) << ply_error(points + "0 0 nan\n");
}

}  // namespace
}  // namespace limber::model
