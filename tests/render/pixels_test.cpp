// PNG files: another reader gets the same pixels; an error names a path that can't be written.
#include "ui/render/pixels.h"

#include <filesystem>

#include <stb_image.h>
#include <unistd.h>

#include "render/stage.h"

namespace limber::render::test {
namespace {

TEST(Pixels, PngContainsTheImage) {
  Pixels pixels{3, 2, {}};
  for (int i = 0; i < 6; i++) {
    for (const int c : {40 * i, 255 - 40 * i, 7 * i, 255}) pixels.bytes.push_back(static_cast<std::uint8_t>(c));
  }
  const std::string file = fmt::format("{}limber_pixels_{}.png", ::testing::TempDir(), ::getpid());
  ASSERT_TRUE(write_png(pixels, file).ok());
  int width = 0;
  int height = 0;
  int channels = 0;
  stbi_uc* const read = stbi_load(file.c_str(), &width, &height, &channels, 4);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  EXPECT_EQ(std::vector<std::uint8_t>(read, read + 24), pixels.bytes);
  stbi_image_free(read);
  std::filesystem::remove(file);
}

TEST(Pixels, ErrorNamesAMissingFolder) {
  const Result<void> written = write_png({1, 1, {1, 2, 3, 255}}, "/nowhere/at/all.png");
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().find("'/nowhere/at/all.png'"), std::string::npos) << written.error();
}

}  // namespace
}  // namespace limber::render::test
