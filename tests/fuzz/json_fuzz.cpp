// Any text as a command of a client, which should be JSON. An image after it tells what the client hears now.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/query_desk.h"

namespace {

struct Desk : limber::FuzzedQueryDesk {
  void input(std::string_view bytes) {
    // it waits for an image just when it begins to listen to something
    const bool waits = client().text(bytes);
    limber::must(!waits || nlohmann::json::accept(bytes));
    done();
  }
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return limber::live_input<Desk>(bytes, size);
}
