// Colors and textures of mesh files: materials, texture coordinates, facet colors, and what is reported.
#include "model/look/mesh_look.h"

#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "model/mesh/load.h"
#include "solids.h"
#include "support/images.h"

namespace limber::model {
namespace {

using limber::test::Rgb;

// A tetrahedron whose faces are lines 5 to 8 of the file.
const char* const kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

std::shared_ptr<const MeshModel> mesh_of(const std::string& path) {
  MeshLibrary library;
  const auto mesh = library.load(path, Vec3(1));
  EXPECT_TRUE(mesh) << mesh.error();
  return mesh ? *mesh : nullptr;
}

const MeshMaterial& material_of(const MeshModel& mesh, std::size_t triangle) {
  static const MeshMaterial none;
  if (mesh.look == nullptr || triangle >= mesh.look->triangle_materials.size()) return none;
  return mesh.look->materials[mesh.look->triangle_materials[triangle]];
}

// The texture coordinates of the corner of a triangle that is at this point.
TexCoord texcoord_at(const MeshModel& mesh, std::size_t triangle, const Vec3& point) {
  for (std::size_t k = 3 * triangle; k < 3 * triangle + 3; ++k) {
    if (mesh.vertices[mesh.triangles[k]] == point && k < mesh.look->texcoords.size()) return mesh.look->texcoords[k];
  }
  ADD_FAILURE() << "no such corner";
  return {};
}

bool reports(const MeshModel& mesh, Severity severity, std::string_view text) {
  for (const Problem& problem : mesh.look->problems) {
    if (problem.severity == severity && problem.text.find(text) != std::string::npos && !problem.fix.empty())
      return true;
  }
  for (const Problem& problem : mesh.look->problems) ADD_FAILURE() << problem.text << ". " << problem.fix;
  return false;
}

TEST(MeshLook, ObjHasTheMaterialsOfItsFile) {
  const test::Files files;
  files.write("m/skin one.png", limber::test::png(2, {Rgb{255, 0, 0}, {0, 255, 0}}));
  files.write("m/body.mtl",
              "# comment\nnewmtl red\nKd 0.8 0.1 0.2\nKe 0 0.5 0\nd 0.25\nTr 0.1\n\nnewmtl skin # name\nKd 0 0 0\n"
              "map_Kd -clamp on -s 1 1 1 skin one.png\nmap_bump bump.png\nnewmtl glass\nTr 0.75\n");
  const std::string path =
      files.write("m/body.obj", std::string("mtllib body.mtl\n") + kTetrahedron +
                                    "vt 0.25 0.75\nvt 1 0\nvt 0 0\nf 1 3 2\nusemtl red\nf 1 2 4\nusemtl skin\n"
                                    "f 2/1 3/-2 4/3\nusemtl glass\nf 1 4 3\n");
  const auto mesh = mesh_of(path);
  ASSERT_TRUE(mesh != nullptr && mesh->triangles.size() == 12 && has_colors(*mesh));
  EXPECT_EQ(material_of(*mesh, 0).name, "");
  EXPECT_EQ(material_of(*mesh, 0).color, Vec3(1)) << "faces before the first material are white";
  EXPECT_EQ(material_of(*mesh, 1).color, Vec3(0.8, 0.1, 0.2));
  EXPECT_EQ(material_of(*mesh, 1).emission, Vec3(0, 0.5, 0));
  EXPECT_EQ(material_of(*mesh, 1).alpha, 0.25) << "d takes precedence over Tr";
  EXPECT_EQ(material_of(*mesh, 2).color, Vec3(1)) << "black under a texture";
  ASSERT_NE(material_of(*mesh, 2).texture, nullptr);
  EXPECT_EQ(material_of(*mesh, 2).texture->width, 2);
  EXPECT_EQ(material_of(*mesh, 3).alpha, 0.25) << "Tr is 1 - d";
  // from the bottom left in the file, from the top left in the mesh
  EXPECT_EQ(texcoord_at(*mesh, 2, {1, 0, 0}), (TexCoord{0.25F, 0.25F}));
  EXPECT_EQ(texcoord_at(*mesh, 2, {0, 1, 0}), (TexCoord{1, 1})) << "negative indices count from the last";
  EXPECT_EQ(texcoord_at(*mesh, 2, {0, 0, 1}), (TexCoord{0, 1}));
  EXPECT_TRUE(reports(*mesh, Severity::note, "material 'skin': map_bump is not drawn"));
  ASSERT_EQ(mesh->look->files.size(), 2u);
  for (const auto& [file, hash] : mesh->look->files) EXPECT_NE(hash, 0u) << file;
}

TEST(MeshLook, ColorsStayWithTheirTrianglesInAMirroredMesh) {
  const std::string text =
      std::string(kTetrahedron) + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 3/2 2/3\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const auto mesh = mesh_from_bytes(text, MeshFormat::obj, Vec3(-1, 1, 1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_GT((*mesh)->unit_inertial.mass, 0);
  EXPECT_EQ(texcoord_at(**mesh, 0, {0, 0, 0}), (TexCoord{0, 1}));
  EXPECT_EQ(texcoord_at(**mesh, 0, {0, 1, 0}), (TexCoord{1, 1}));
  EXPECT_EQ(texcoord_at(**mesh, 0, {-1, 0, 0}), (TexCoord{0, 0}));
}

TEST(MeshLook, DegenerateTrianglesTakeTheirColorsAlong) {
  const test::Files files;
  files.write("m.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  const std::string path =
      files.write("m.obj", std::string("mtllib m.mtl\n") + kTetrahedron +
                               "usemtl a\nf 1 1 2\nf 1 3 2\nf 1 2 4\nusemtl b\nf 2 3 4\nf 1 4 3\n");
  const auto mesh = mesh_of(path);
  ASSERT_TRUE(mesh != nullptr && mesh->triangles.size() == 12);
  EXPECT_EQ(material_of(*mesh, 1).name, "a");
  EXPECT_EQ(material_of(*mesh, 2).name, "b");
  EXPECT_EQ(mesh->look->triangle_materials.size(), 4u);
}

TEST(MeshLook, ObjVerticesCanHaveColors) {
  const std::string text =
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 0.5 0.5 0.5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const auto mesh = mesh_from_bytes(text, MeshFormat::obj, Vec3(1), "m");
  ASSERT_TRUE(mesh && has_colors(**mesh));
  ASSERT_EQ((*mesh)->look->colors.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    const Vec3& v = (*mesh)->vertices[(*mesh)->triangles[k]];
    const CornerColor expected = v.x > 0   ? CornerColor{0, 255, 0, 255}
                                 : v.y > 0 ? CornerColor{0, 0, 255, 255}
                                 : v.z > 0 ? CornerColor{128, 128, 128, 255}
                                           : CornerColor{255, 0, 0, 255};
    EXPECT_EQ((*mesh)->look->colors[k], expected);
  }
}

TEST(MeshLook, ReportsMissingFilesOnce) {
  const test::Files files;
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const auto no_file = mesh_of(files.write("a.obj", std::string("mtllib none.mtl\nusemtl x\n") + kTetrahedron + faces));
  ASSERT_TRUE(no_file != nullptr && no_file->look != nullptr);
  EXPECT_FALSE(has_colors(*no_file));
  EXPECT_EQ(no_file->look->problems.size(), 1u);
  EXPECT_TRUE(reports(*no_file, Severity::warning, "material file 'none.mtl' not found"));
  files.write("b.mtl", "newmtl x\nKd 0.5 0.5 0.5\nmap_Kd a.png\nnewmtl y\nmap_Kd b.png\nnewmtl z\nmap_Kd c.tga\n");
  const auto no_image = mesh_of(files.write("b.obj", std::string("mtllib b.mtl\nusemtl x\n") + kTetrahedron + faces));
  ASSERT_TRUE(no_image != nullptr && has_colors(*no_image));
  EXPECT_EQ(material_of(*no_image, 0).color, Vec3(0.5));
  EXPECT_EQ(no_image->look->problems.size(), 1u);
  EXPECT_TRUE(reports(*no_image, Severity::warning,
                      "texture 'a.png' not found; its surfaces are drawn without it … and 2 more of this kind"));
}

TEST(MeshLook, FindsFilesInTheUsualPlaces) {
  const test::Files files;
  const std::string image = limber::test::png(1, {Rgb{1, 2, 3}});
  files.write("robot/materials/textures/one.png", image);
  files.write("robot/meshes/my two.png", image);
  files.write("robot/meshes/Three.PNG", image);
  files.write("robot/meshes/m.mtl",
              "newmtl a\nmap_Kd C:\\Users\\me\\one.png\nnewmtl b\nmap_Kd my%20two.png\nnewmtl c\nmap_Kd three.png\n");
  const auto mesh =
      mesh_of(files.write("robot/meshes/m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kTetrahedron +
                                                    "f 1 3 2\nusemtl b\nf 1 2 4\nusemtl c\nf 2 3 4\nf 1 4 3\n"));
  ASSERT_TRUE(mesh != nullptr && has_colors(*mesh));
  for (const std::size_t i : {0u, 1u, 2u}) EXPECT_NE(material_of(*mesh, i).texture, nullptr) << i;
  EXPECT_TRUE(reports(*mesh, Severity::warning, "'three.png', whose letter case differs"));
  EXPECT_EQ(material_of(*mesh, 0).texture->pixels, material_of(*mesh, 1).texture->pixels);
}

TEST(MeshLook, MeshesShareImagesAndFollowTheirChanges) {
  const test::Files files;
  files.write("t.png", limber::test::png(1, {Rgb{1, 2, 3}}));
  files.write("m.mtl", "newmtl a\nmap_Kd t.png\n");
  const std::string text =
      std::string("mtllib m.mtl\nusemtl a\n") + kTetrahedron + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string first = files.write("1.obj", text), second = files.write("2.obj", text);
  MeshLibrary library;
  const auto a = library.load(first, Vec3(1)), b = library.load(second, Vec3(1));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(material_of(**a, 0).texture, material_of(**b, 0).texture);
  EXPECT_EQ(*library.load(first, Vec3(1)), *a);
  files.write("t.png", limber::test::png(1, {Rgb{9, 2, 3}}));
  const auto changed = library.load(first, Vec3(1));
  ASSERT_TRUE(changed);
  EXPECT_NE(*changed, *a);
  EXPECT_EQ(material_of(**changed, 0).texture->pixels[0], 9);
  EXPECT_FALSE(same_look(**changed, **a));
  EXPECT_TRUE(same_look(**a, **b));
}

// ---- STL

std::string colored_stl(const std::string& header, const std::vector<std::uint16_t>& attributes) {
  std::string bytes = test::binary_stl(test::box({1, 1, 1}));
  bytes.replace(0, header.size(), header);
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    bytes[84 + 50 * i + 48] = static_cast<char>(attributes[i] & 255);
    bytes[84 + 50 * i + 49] = static_cast<char>(attributes[i] >> 8);
  }
  return bytes;
}

std::vector<CornerColor> stl_colors(const std::string& bytes) {
  const auto mesh = mesh_from_bytes(bytes, MeshFormat::stl, Vec3(1), "m");
  EXPECT_TRUE(mesh) << mesh.error();
  if (!mesh || (*mesh)->look == nullptr) return {};
  std::vector<CornerColor> colors;
  for (std::size_t i = 0; i < (*mesh)->look->colors.size(); i += 3) colors.push_back((*mesh)->look->colors[i]);
  return colors;
}

TEST(MeshLook, StlFacetColorsOfVisCam) {
  // bit 15 and 5 bits each of red, green, blue from the top
  const auto colors = stl_colors(colored_stl("exported", {0x8000 | 31 << 10, 0x8000 | 31 << 5, 0x8000 | 16, 31}));
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_EQ(colors[0], (CornerColor{255, 0, 0, 255}));
  EXPECT_EQ(colors[1], (CornerColor{0, 255, 0, 255}));
  EXPECT_EQ(colors[2], (CornerColor{0, 0, 132, 255}));  // 16 / 31 of 255
  EXPECT_EQ(colors[3], (CornerColor{255, 255, 255, 255})) << "without bit 15: no color";
  EXPECT_TRUE(stl_colors(colored_stl("exported", {31, 31 << 5})).empty()) << "attributes without bit 15 are no colors";
}

TEST(MeshLook, StlFacetColorsOfMagics) {
  const std::string header = std::string("COLOR=") + '\x10' + '\x20' + '\x30' + '\xff' + ",MATERIAL=";
  // bit 15 clear: the facet's own color, red from bit 0
  const auto colors = stl_colors(colored_stl(header, {31, 31 << 5, 31 << 10, 0x8000}));
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_EQ(colors[0], (CornerColor{255, 0, 0, 255}));
  EXPECT_EQ(colors[1], (CornerColor{0, 255, 0, 255}));
  EXPECT_EQ(colors[2], (CornerColor{0, 0, 255, 255}));
  EXPECT_EQ(colors[3], (CornerColor{16, 32, 48, 255}));
  const auto common = stl_colors(colored_stl(header, {}));
  ASSERT_EQ(common.size(), 12u);
  EXPECT_EQ(common[0], (CornerColor{16, 32, 48, 255})) << "attributes that are all 0 were not written";
}

// ---- Collada

// Two triangles and two more to close a tetrahedron, with the symbols A and B.
std::string collada(const std::string& effects, const std::string& bindings, const std::string& images = "") {
  const std::string input =
      "<input semantic='VERTEX' source='#v' offset='0'/><input semantic='TEXCOORD' source='#t' offset='1' set='0'/>";
  return "<COLLADA><library_images>" + images +
         "</library_images><library_materials>"
         "<material id='m1' name='one'><instance_effect url='#e1'/></material>"
         "<material id='m2' name='two'><instance_effect url='#e2'/></material></library_materials><library_effects>" +
         effects +
         "</library_effects><library_geometries><geometry id='g'><mesh>"
         "<source id='p'><float_array id='a'>0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common><accessor "
         "source='#a' "
         "count='4' stride='3'/></technique_common></source>"
         "<source id='t'><float_array id='ta'>0 0 1 0 1 1 0.25 0.75</float_array><technique_common><accessor "
         "source='#ta' "
         "count='4' stride='2'><param name='S'/><param name='T'/></accessor></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
         "<triangles material='A' count='2'>" +
         input + "<p>0 0 2 1 1 2 0 3 1 0 3 1</p></triangles><polylist material='B' count='2'>" + input +
         "<vcount>3 3</vcount><p>1 0 2 1 3 2 0 0 3 1 2 2</p></polylist></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id='s'><node><instance_geometry "
         "url='#g'><bind_material><technique_common>" +
         bindings +
         "</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}
std::string effect(const std::string& id, const std::string& shading, const std::string& parameters = "") {
  return "<effect id='" + id + "'><profile_COMMON>" + parameters + "<technique sid='common'>" + shading +
         "</technique></profile_COMMON></effect>";
}
const char* const kBoth = "<instance_material symbol='A' target='#m1'/><instance_material symbol='B' target='#m2'/>";

std::shared_ptr<const MeshModel> collada_mesh(const std::string& text) {
  const auto mesh = mesh_from_bytes(text, MeshFormat::dae, Vec3(1), "m");
  EXPECT_TRUE(mesh) << mesh.error();
  return mesh ? *mesh : nullptr;
}

TEST(MeshLook, ColladaMaterialsAreBoundBySymbol) {
  const auto mesh = collada_mesh(collada(
      effect("e1",
             "<phong><emission><color>0 0 0.25 1</color></emission><diffuse><color>0.8 0.2 0.1 1</color></diffuse>"
             "</phong>") +
          effect("e2", "<lambert><diffuse><color sid='diffuse'>0.1 0.9 0.3 1</color></diffuse></lambert>"),
      kBoth));
  ASSERT_TRUE(mesh != nullptr && has_colors(*mesh));
  for (const std::size_t i : {0u, 1u}) EXPECT_EQ(material_of(*mesh, i).name, "one");
  for (const std::size_t i : {2u, 3u}) EXPECT_EQ(material_of(*mesh, i).name, "two");
  EXPECT_EQ(material_of(*mesh, 0).color, Vec3(0.8, 0.2, 0.1));
  EXPECT_EQ(material_of(*mesh, 0).emission, Vec3(0, 0, 0.25));
  EXPECT_EQ(material_of(*mesh, 2).color, Vec3(0.1, 0.9, 0.3));
  EXPECT_TRUE(mesh->look->problems.empty());
  // from the bottom left in the file
  EXPECT_EQ(texcoord_at(*mesh, 0, {0, 1, 0}), (TexCoord{1, 1}));
  EXPECT_EQ(texcoord_at(*mesh, 0, {1, 0, 0}), (TexCoord{1, 0}));
  EXPECT_EQ(texcoord_at(*mesh, 1, {0, 0, 0}), (TexCoord{0.25F, 0.25F}));
}

TEST(MeshLook, ColladaInstancesBindTheSameGeometryDifferently) {
  std::string text = collada(effect("e1", "<blinn><diffuse><color>1 0 0 1</color></diffuse></blinn>") +
                                 effect("e2", "<constant><emission><color>0 0 1 1</color></emission></constant>"),
                             kBoth);
  const std::string second =
      "<node><translate>5 0 0</translate><instance_geometry url='#g'><bind_material><technique_common>"
      "<instance_material symbol='A' target='#m2'/><instance_material symbol='B' target='#m1'/></technique_common>"
      "</bind_material></instance_geometry></node></visual_scene>";
  text.replace(text.find("</visual_scene>"), 15, second);
  const auto mesh = collada_mesh(text);
  ASSERT_TRUE(mesh != nullptr && mesh->triangles.size() == 24);
  EXPECT_EQ(material_of(*mesh, 0).color, Vec3(1, 0, 0));
  EXPECT_EQ(material_of(*mesh, 2).color, Vec3(0, 0, 1)) << "constant shading shows its emission";
  EXPECT_EQ(material_of(*mesh, 4).color, Vec3(0, 0, 1));
  EXPECT_EQ(material_of(*mesh, 6).color, Vec3(1, 0, 0));
}

TEST(MeshLook, ColladaTransparencyDependsOnItsMode) {
  const auto alpha = [](const std::string& shading) {
    const auto mesh =
        collada_mesh(collada(effect("e1", "<phong>" + shading + "</phong>") + effect("e2", "<phong/>"), kBoth));
    return mesh == nullptr ? -1 : material_of(*mesh, 0).alpha;
  };
  const std::string factor = "<transparency><float>0.5</float></transparency>";
  const auto transparent = [](const std::string& mode, const std::string& color) {
    return "<transparent" + (mode.empty() ? "" : " opaque='" + mode + "'") + "><color>" + color +
           "</color></transparent>";
  };
  EXPECT_EQ(alpha(""), 1);
  EXPECT_EQ(alpha(factor), 0.5);
  EXPECT_NEAR(alpha(transparent("", "1 1 1 0.5") + factor), 0.25, 1e-12);
  EXPECT_NEAR(alpha(transparent("A_ZERO", "1 1 1 0.5") + factor), 0.75, 1e-12);
  EXPECT_NEAR(alpha(transparent("RGB_ZERO", "1 1 1 1") + factor), 0.5, 1e-5);
  EXPECT_NEAR(alpha(transparent("RGB_ZERO", "0 0 0 1") + factor), 1, 1e-12);
  EXPECT_NEAR(alpha(transparent("RGB_ONE", "1 1 1 1") + factor), 0.5, 1e-5);
  EXPECT_EQ(alpha("<transparency><float>0</float></transparency>"), 1) << "exporters write 0 for opaque";
}

TEST(MeshLook, ColladaTexturesAreFoundThroughSamplers) {
  const test::Files files;
  files.write("a b.png", limber::test::png(1, {Rgb{5, 6, 7}}));
  const std::string parameters =
      "<newparam sid='s-surface'><surface type='2D'><init_from>img</init_from></surface></newparam>"
      "<newparam sid='s-sampler'><sampler2D><source>s-surface</source></sampler2D></newparam>";
  const auto shading = [](const std::string& name) {
    return "<phong><diffuse><texture texture='" + name + "' texcoord='UV'/></diffuse></phong>";
  };
  const std::string images =
      "<image id='img'><init_from>file:///home/me/a%20b.png</init_from></image>"
      "<image id='new'><init_from><ref>./a b.png</ref></init_from></image>";
  const auto mesh = mesh_of(files.write(
      "m.dae", collada(effect("e1", shading("s-sampler"), parameters) + effect("e2", shading("new")), kBoth, images)));
  ASSERT_TRUE(mesh != nullptr && has_colors(*mesh));
  for (const std::size_t i : {0u, 2u}) {
    ASSERT_NE(material_of(*mesh, i).texture, nullptr) << i;
    EXPECT_EQ(material_of(*mesh, i).texture->pixels, (std::vector<std::uint8_t>{5, 6, 7, 255}));
  }
  EXPECT_TRUE(mesh->look->problems.empty());
}

TEST(MeshLook, ColladaFaultsOfColorsKeepTheMesh) {
  const auto mesh = collada_mesh(
      collada(effect("e1", "<phong><diffuse><color>red</color></diffuse></phong>"),
              "<instance_material symbol='A' target='#m1'/><instance_material symbol='B' target='#none'/>"));
  ASSERT_TRUE(mesh != nullptr && mesh->triangles.size() == 12);
  EXPECT_EQ(material_of(*mesh, 0).color, Vec3(1));
  EXPECT_TRUE(reports(*mesh, Severity::warning, "'red' is not a finite number"));
  EXPECT_TRUE(reports(*mesh, Severity::warning, "material 'B' not found; drawn white"));
}

// ---- the rule of URDF files

const char* const kVisual =
    "<robot name='r'>{}<link name='a'><visual><geometry><mesh filename='{}'/></geometry>{}</visual></link></robot>";

TEST(MeshLook, AUrdfColorOrTextureReplacesThatOfTheMesh) {
  const test::Files files;
  files.write("t.png", limber::test::png(1, {Rgb{1, 2, 3}}));
  files.write("m.mtl", "newmtl a\nKd 1 0 0\n");
  const std::string mesh = files.write("m.obj", std::string("mtllib m.mtl\nusemtl a\nvt 0 0\n") + kTetrahedron +
                                                    "f 1/1 3/1 2/1\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string top = "<material name='blue'><color rgba='0 0 1 0.5'/></material>";
  const auto visual = [&](const std::string& material) {
    return test::import_text(fmt::format(fmt::runtime(kVisual), top, mesh, material)).links.at(0).visuals.at(0);
  };
  const PlacedShape own = visual("");
  EXPECT_TRUE(own.shape.mesh_colors && !own.color && own.shape.texture == nullptr);
  EXPECT_TRUE(has_colors(*own.shape.mesh));
  for (const char* material : {"<material name='blue'/>", "<material name='x'><color rgba='0 0 1 0.5'/></material>"}) {
    const PlacedShape blue = visual(material);
    EXPECT_FALSE(blue.shape.mesh_colors) << material;
    EXPECT_EQ(blue.color, Vec3(0, 0, 1)) << material;
    EXPECT_EQ(blue.alpha, 0.5) << material;
  }
  const PlacedShape white = visual("<material name='x'><color rgba='1 1 1 0.5'/></material>");
  EXPECT_TRUE(white.shape.mesh_colors) << "white is neutral";
  EXPECT_EQ(white.alpha, 0.5);
  EXPECT_EQ(drawn_materials(own).at(0).color, Vec3(1, 0, 0)) << "that of the mesh";
  const std::vector<MeshMaterial> blue = drawn_materials(visual("<material name='blue'/>"));
  ASSERT_EQ(blue.size(), 1u);
  EXPECT_EQ(blue[0].color, Vec3(0, 0, 1));
  EXPECT_EQ(blue[0].alpha, 0.5);
  const PlacedShape undefined = visual("<material name='unknown'/>");
  EXPECT_TRUE(undefined.shape.mesh_colors) << "a name that is not defined sets nothing";
  const PlacedShape textured = visual("<material name='x'><color rgba='0 0 1 0.5'/><texture filename='" +
                                      files.path("t.png") + "'/></material>");
  ASSERT_NE(textured.shape.texture, nullptr);
  EXPECT_FALSE(textured.shape.mesh_colors);
  EXPECT_FALSE(textured.color.has_value()) << "a texture replaces the color";
}

TEST(MeshLook, ReportsUrdfTexturesThatAreNotDrawn) {
  const test::Files files;
  const std::string image = files.write("t.png", limber::test::png(1, {Rgb{1, 2, 3}}));
  const std::string mesh = files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  const auto model = [&](const std::string& file) {
    return test::import_text(
        fmt::format(fmt::runtime(kVisual), "", mesh,
                    "<material name='x'><color rgba='1 0 0 1'/><texture filename='" + file + "'/></material>"));
  };
  const BodyModel no_coordinates = model(image);
  EXPECT_TRUE(test::has_problem(no_coordinates, Severity::warning, "has no texture coordinates; drawn in the color", 1))
      << test::all_problems(no_coordinates);
  EXPECT_EQ(no_coordinates.links.at(0).visuals.at(0).color, Vec3(1, 0, 0));
  const BodyModel missing = model("none.png");
  EXPECT_TRUE(test::has_problem(missing, Severity::warning, "texture ignored: 'none.png' not found", 1))
      << test::all_problems(missing);
  const BodyModel other = model("/etc/passwd");
  EXPECT_TRUE(test::has_problem(other, Severity::warning, "neither a PNG nor a JPEG", 1)) << test::all_problems(other);
}

TEST(MeshLook, ReportsAMeshFileOncePerModel) {
  const test::Files files;
  const std::string mesh =
      files.write("m.obj", std::string("mtllib none.mtl\n") + kTetrahedron + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string shape = "<geometry><mesh filename='" + mesh + "'/></geometry>";
  const BodyModel model = test::import_text("<robot name='r'><link name='a'><visual>" + shape + "</visual><visual>" +
                                            shape + "</visual><collision>" + shape + "</collision></link></robot>");
  int count = 0;
  for (const Problem& problem : model.problems) count += problem.text.find("none.mtl") != std::string::npos ? 1 : 0;
  EXPECT_EQ(count, 1) << test::all_problems(model);
}

}  // namespace
}  // namespace limber::model
