// Fuzzes the JSON commands of an OSCQuery client. After some inputs, a snapshot is published, which sends values to it.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/query_desk.h"

namespace {

struct JsonFixture : limber::QueryFixture {
  void input(std::string_view bytes) {
    // the client waits for a snapshot only if it has subscribed to something
    const bool waits = client().on_text(bytes);
    limber::must(!waits || nlohmann::json::accept(bytes));
    end_input();
  }
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return limber::persistent_input<JsonFixture>(bytes, size);
}
