// Decoding by libpng and libjpeg, after checks that bound the time and memory.
#include "model/look/image.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <png.h>
// needs the types of stdio
#include <jpeglib.h>

#include "base/hash.h"

namespace limber::model {

namespace {

constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegStart("\xff\xd8\xff", 3);
// a progressive JPEG file is decoded once for each scan
constexpr std::size_t kMaxScanPixels = std::size_t{1} << 29;
constexpr std::size_t kMaxScans = 200;

const Error kDamagedImage{"is damaged, or of a kind that can't be read. Export it again as PNG."};

std::optional<Error> size_fault(std::size_t width, std::size_t height) {
  constexpr auto kSide = static_cast<std::size_t>(kMaxImageSide);
  if (width == 0 || height == 0) return kDamagedImage;
  if (width <= kSide && height <= kSide && width * height <= kMaxImagePixels) return {};
  return Error{
      fmt::format("has {} × {} pixels; images must have at most {} per side and {} million in total. Shrink it.", width,
                  height, kMaxImageSide, kMaxImagePixels >> 20)};
}

void resize(Image& image, std::size_t width, std::size_t height) {
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.pixels.resize(4 * width * height);
}

Result<void> decode_png(std::string_view bytes, Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return kDamagedImage;
  if (std::optional<Error> fault = size_fault(png.width, png.height)) {
    png_image_free(&png);
    return *fault;
  }
  png.format = PNG_FORMAT_RGBA;
  resize(image, png.width, png.height);
  if (png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) == 0) return kDamagedImage;
  return {};
}

// The number of scans of a JPEG file: 1, or more in progressive files.
std::size_t jpeg_scans(std::string_view bytes) {
  constexpr std::string_view kScan = "\xff\xda";
  std::size_t scans = 0;
  for (std::size_t at = bytes.find(kScan); at != std::string_view::npos; at = bytes.find(kScan, at + 2)) ++scans;
  return scans;
}

struct JpegErrors {
  jpeg_error_mgr base;  // first, because libjpeg passes its address
  std::jmp_buf jump;
};

// libjpeg reports errors by a function that must not return
[[noreturn]] void on_jpeg_error(j_common_ptr info) {
  std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->jump, 1);  // NOLINT(cert-err52-cpp)
}
void on_jpeg_message(j_common_ptr) {}

// The header of a JPEG file, or its pixels. Objects with destructors must not be created here, because errors jump out.
bool read_jpeg(std::string_view bytes, std::array<std::size_t, 2>& size, std::uint8_t* pixels) {
  jpeg_decompress_struct info{};
  JpegErrors errors{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = &on_jpeg_error;
  errors.base.output_message = &on_jpeg_message;
  if (setjmp(errors.jump) != 0) {  // NOLINT(cert-err52-cpp)
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  if (pixels == nullptr) {
    size = {info.image_width, info.image_height};
  } else {
    info.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&info);
    const std::size_t row_bytes = 4 * size[0];
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = pixels + row_bytes * info.output_scanline;
      jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
  }
  jpeg_destroy_decompress(&info);
  return true;
}

Result<void> decode_jpeg(std::string_view bytes, Image& image) {
  std::array<std::size_t, 2> size{};
  if (!read_jpeg(bytes, size, nullptr)) return kDamagedImage;
  if (std::optional<Error> fault = size_fault(size[0], size[1])) return *fault;
  const std::size_t scans = jpeg_scans(bytes);
  if (scans > kMaxScans || scans * size[0] * size[1] > kMaxScanPixels)
    return Error{
        fmt::format("has {} progressive scans, too many for its size. Save it without progressive scans.", scans)};
  resize(image, size[0], size[1]);
  if (!read_jpeg(bytes, size, image.pixels.data())) return kDamagedImage;
  return {};
}

}  // namespace

bool is_image_name(std::string_view path) {
  constexpr std::array<std::string_view, 3> kEnds{".png", ".jpg", ".jpeg"};
  return std::any_of(kEnds.begin(), kEnds.end(), [&](std::string_view end) {
    return path.size() >= end.size() && same_in_any_case(path.substr(path.size() - end.size()), end);
  });
}

Result<std::shared_ptr<const Image>> image_from_bytes(std::string_view bytes, std::string file) {
  if (bytes.size() > kMaxImageBytes)
    return Error{fmt::format("has {} bytes; images must have at most {}. Shrink it.", bytes.size(), kMaxImageBytes)};
  const bool is_png = bytes.starts_with(kPngStart);
  if (!is_png && !bytes.starts_with(kJpegStart)) return Error{"is neither a PNG nor a JPEG file. Convert it to PNG."};
  auto image = std::make_shared<Image>();
  const Result<void> decoded = is_png ? decode_png(bytes, *image) : decode_jpeg(bytes, *image);
  if (!decoded) return Error{decoded.error()};
  image->file = std::move(file);
  image->content_hash = hash_bytes(bytes);
  return std::shared_ptr<const Image>(std::move(image));
}

}  // namespace limber::model
