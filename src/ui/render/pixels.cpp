// PNG encoding with stb_image_write.
#include "ui/render/pixels.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <stb_image_write.h>

#include "base/text.h"

namespace limber::render {

Result<void> write_png(const Pixels& pixels, const std::string& file) {
  const std::string temporary = file + ".part";
  std::FILE* const out = std::fopen(temporary.c_str(), "wb");
  const auto describe_error = [&] {
    return Error{fmt::format("'{}' can't be written: {}", printable(file), std::strerror(errno))};
  };
  if (out == nullptr) return describe_error();
  struct Sink {
    std::FILE* out;
    bool ok = true;
  } sink{out};
  const auto write = [](void* to, void* data, int size) {
    auto& s = *static_cast<Sink*>(to);
    const auto count = static_cast<std::size_t>(size);
    s.ok = s.ok && std::fwrite(data, 1, count, s.out) == count;
  };
  const int written =
      stbi_write_png_to_func(write, &sink, pixels.width, pixels.height, 4, pixels.bytes.data(), 4 * pixels.width);
  const bool closed = std::fclose(out) == 0;
  if (written != 0 && sink.ok && closed && std::rename(temporary.c_str(), file.c_str()) == 0) return {};
  const Error error = describe_error();
  std::remove(temporary.c_str());
  return error;
}

}  // namespace limber::render
