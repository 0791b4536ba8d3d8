// Any bytes as a take: it is read to its last whole frame, and what was read can be written and read again.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "engine/take_reader.h"
#include "fuzz/target.h"

namespace {

using limber::must;

void must_come_back(const limber::TakeTick& tick) {
  limber::TakeForms written;
  std::string messages;
  limber::TakeBytes out(messages);
  for (const limber::TakeMessage& taken : tick.messages) {
    limber::Message message = taken.message;
    if (taken.evaluate) message = {"", {limber::Arg::of(std::string_view(taken.message.address))}};
    written.write(out, message, taken.origin);
  }
  std::string text;
  limber::append_tick(text, tick, tick.messages.size(), messages);
  limber::TakeForms read;
  limber::TakeTick again;
  must(limber::read_tick(text, read, again));
  must(again.messages.size() == tick.messages.size() && again.runs.size() == tick.runs.size());
  must(again.motion == tick.motion && again.bodies == tick.bodies && again.state == tick.state);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  auto opened = limber::TakeReader::of(std::make_unique<std::istringstream>(bytes), "fuzz");
  if (!opened) {
    must(!opened.error().empty());
    return 0;
  }
  limber::TakeReader& reader = **opened;
  for (limber::TakeTick tick; reader.next(tick);) {
    must_come_back(tick);
    for (const limber::TakeRun& run : tick.runs) {
      must(run.files == 0 || reader.sources(run.files) != nullptr);
      (void)reader.presets(run.files);
    }
  }
  must(reader.position() <= reader.size());
  return 0;
}
