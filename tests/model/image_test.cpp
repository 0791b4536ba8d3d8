// Images: decoding of PNG and JPEG, and the limits that bound hostile files.
#include "model/look/image.h"

#include <gtest/gtest.h>

#include "support/images.h"

namespace limber::model {
namespace {

using limber::test::Rgb;

std::string image_error(std::string_view bytes) {
  const auto image = image_from_bytes(bytes, "x.png");
  return image ? "read" : image.error();
}

void set_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// Sets the size in the header of a PNG file, and the checksum of its chunk.
void set_size(std::string& png, std::uint32_t width, std::uint32_t height) {
  constexpr std::size_t kChunk = 12, kEnd = 29;  // from the name to the end of the data
  set_big_endian(png, 16, width);
  set_big_endian(png, 20, height);
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = kChunk; i < kEnd; ++i) {
    crc ^= static_cast<unsigned char>(png[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
  }
  set_big_endian(png, kEnd, ~crc);
}

TEST(Image, ReadsThePixelsOfAPngFile) {
  const auto image =
      image_from_bytes(limber::test::png(2, {Rgb{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 20, 30}}), "x.png");
  ASSERT_TRUE(image) << image.error();
  EXPECT_EQ((*image)->width, 2);
  EXPECT_EQ((*image)->height, 2);
  const std::vector<std::uint8_t> expected{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 10, 20, 30, 255};
  EXPECT_EQ((*image)->pixels, expected);
}

TEST(Image, ReadsAJpegFileWhateverItsName) {
  const auto image = image_from_bytes(limber::test::jpeg(16, 8, {200, 100, 50}), "x.png");
  ASSERT_TRUE(image) << image.error();
  ASSERT_EQ((*image)->pixels.size(), 16u * 8 * 4);
  EXPECT_NEAR((*image)->pixels[0], 200, 4);
  EXPECT_NEAR((*image)->pixels[1], 100, 4);
  EXPECT_NEAR((*image)->pixels[2], 50, 4);
}

TEST(Image, NamesOfImagesEndInAnyCase) {
  for (const char* name : {"a.png", "dir/B.PNG", "c.jpg", "d.JPEG"}) EXPECT_TRUE(is_image_name(name)) << name;
  for (const char* name : {"a.tga", "png", "a.png.txt", "", "/etc/passwd"}) EXPECT_FALSE(is_image_name(name)) << name;
}

TEST(Image, RejectsOtherAndDamagedFiles) {
  const std::string good = limber::test::png(2, {Rgb{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(image_error(good), "read");
  EXPECT_NE(image_error("").find("neither a PNG nor a JPEG"), std::string::npos);
  EXPECT_NE(image_error("GIF89a").find("Convert it to PNG"), std::string::npos);
  EXPECT_NE(image_error(good.substr(0, 30)).find("damaged"), std::string::npos);
  EXPECT_NE(image_error(good.substr(0, good.size() / 2)).find("damaged"), std::string::npos);
}

TEST(Image, RejectsSizesBeyondTheLimitBeforeDecoding) {
  std::string wide = limber::test::png(1, {Rgb{1, 2, 3}});
  set_size(wide, 1, 1);
  EXPECT_EQ(image_error(wide), "read");
  set_size(wide, kMaxImageSide + 1, 1);
  EXPECT_NE(image_error(wide).find("8193 × 1 pixels"), std::string::npos) << image_error(wide);
  set_size(wide, 8000, 8000);
  EXPECT_NE(image_error(wide).find("at most 8192 per side and 32 million"), std::string::npos) << image_error(wide);
  EXPECT_NE(image_error(std::string(kMaxImageBytes + 1, 'x')).find("bytes; images must have at most"),
            std::string::npos);
}

// The data of a large image in the frame of a small one, which would decompress to far more than its pixels: they are
// ignored.
TEST(Image, DataBeyondThePixelsAreNotDecompressed) {
  constexpr int kSide = 3000;
  std::string bomb = limber::test::png(kSide, std::vector<Rgb>(std::size_t{kSide} * kSide, Rgb{7, 7, 7}));
  set_size(bomb, 10, 10);
  const auto image = image_from_bytes(bomb, "x.png");
  ASSERT_TRUE(image) << image.error();
  EXPECT_EQ((*image)->pixels.size(), 400u);
}

TEST(Image, RejectsJpegFilesWithTooManyScans) {
  std::string scans = limber::test::jpeg(8, 8, {1, 2, 3});
  for (int i = 0; i < 300; ++i) scans += "\xff\xda";
  EXPECT_NE(image_error(scans).find("progressive scans"), std::string::npos) << image_error(scans);
}

}  // namespace
}  // namespace limber::model
