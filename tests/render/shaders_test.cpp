// Hot reload of shaders: saved files are reloaded; a broken one is reported, and the last working one stays in use.
#include "ui/render/shaders.h"

#include <filesystem>
#include <fstream>
#include <span>

#include <unistd.h>

#include "base/embedded.h"
#include "render/stage.h"

namespace limber::render {
std::span<const EmbeddedFile> shader_files();
}

namespace limber::render::test {
namespace {

// a temporary copy of shaders/
class ShaderFolder {
 public:
  ShaderFolder() : path_(std::filesystem::path(::testing::TempDir()) / fmt::format("limber_shaders_{}", ::getpid())) {
    std::filesystem::create_directories(path_);
    for (const EmbeddedFile& file : shader_files()) write(std::string(file.name), std::string(file.text));
  }
  ~ShaderFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ShaderFolder(const ShaderFolder&) = delete;
  ShaderFolder& operator=(const ShaderFolder&) = delete;

  std::string path() const { return path_.string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  static std::string text(std::string_view name) { return std::string(find_embedded(shader_files(), name)->text); }

 private:
  std::filesystem::path path_;
};

constexpr const char* kBlue = "out vec4 color;\nvoid main() { color = vec4(0.0, 0.0, 1.0, 1.0); }\n";

TEST(Shaders, EmbeddedFilesMatchTheFolder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMBER_SOURCE_DIR) + "/shaders")) {
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(ShaderFolder::text(entry.path().filename().string()), text) << entry.path();
    count++;
  }
  EXPECT_EQ(shader_files().size(), count);
}

TEST(Shaders, ReloadsSavedAndReportsBrokenShaders) {
  (void)context();
  const ShaderFolder folder;
  TestScene scene;
  scene.add("box", box(Vec3(1)), {0, 0, 1});
  const auto now = scene.snapshot();
  const auto made = Renderer::make(context().api(), folder.path(), Quality::low);
  ASSERT_TRUE(made.ok()) << made.error();
  Renderer& renderer = **made;
  const auto render = [&] {
    EXPECT_TRUE(renderer.draw(*now, 64, 36).ok());
    return renderer.read();
  };
  const Pixels first = render();
  EXPECT_FALSE(renderer.reload_shaders()) << "nothing was saved";

  folder.write("shape.frag", "out vec4 color;\n\nvoid main() { color = vec4(blue); }\n");
  (void)renderer.reload_shaders();
  EXPECT_NE(renderer.shader_error().find(folder.path() + "/shape.frag:3"), std::string::npos)
      << renderer.shader_error();
  EXPECT_NE(renderer.shader_error().find("blue"), std::string::npos);
  EXPECT_EQ(render().bytes, first.bytes) << "the last working shader stays in use";

  folder.write("shape.frag", kBlue);
  EXPECT_TRUE(renderer.reload_shaders());
  EXPECT_EQ(renderer.shader_error(), "");
  const Vec3 c = color(render(), 32, 18);
  EXPECT_LT(c.x, 5);
  EXPECT_GT(c.z, 250);

  folder.write("common.glsl", "oh\n" + ShaderFolder::text("common.glsl"));
  EXPECT_FALSE(renderer.reload_shaders());
  EXPECT_NE(renderer.shader_error().find(folder.path() + "/common.glsl:"), std::string::npos)
      << renderer.shader_error();
  EXPECT_GT(color(render(), 32, 18).z, 250);
}

TEST(Shaders, FallsBackToEmbeddedShaders) {
  for (const GlApi api : {GlApi::core, GlApi::es, GlApi::gl31}) {
    (void)context(api);
    const ShaderFolder folder;
    folder.write("sky.frag", "out vec4 color;\nthis is no shader\n");
    const auto made = Renderer::make(api, folder.path(), Quality::low);
    ASSERT_TRUE(made.ok()) << made.error();
    EXPECT_NE((*made)->shader_error().find("/sky.frag:2"), std::string::npos) << (*made)->shader_error();
    TestScene scene;
    EXPECT_TRUE((*made)->draw(*scene.snapshot(), 16, 9).ok());
  }
}

}  // namespace
}  // namespace limber::render::test
