// Fuzzes WebSocket frames in a live world. Input: frames, each with a kind (0 text, 1 binary, 2 publish a snapshot) and
// a length of two bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/query_desk.h"

namespace {

struct WebSocketFixture : limber::QueryFixture {
  void input(std::string_view bytes) {
    while (bytes.size() >= 3) {
      const int kind = bytes[0] % 3;
      const std::size_t size = std::min<std::size_t>(
          static_cast<unsigned char>(bytes[1]) << 8 | static_cast<unsigned char>(bytes[2]), bytes.size() - 3);
      const std::string_view frame = bytes.substr(3, size);
      bytes.remove_prefix(3 + size);
      if (kind == 0) (void)client().on_text(frame);
      if (kind == 1) client().on_binary(frame);
      if (kind == 2) publish_snapshot();
    }
    end_input();
  }
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return limber::persistent_input<WebSocketFixture>(bytes, size);
}
