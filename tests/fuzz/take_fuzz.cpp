// Fuzzes the reader of takes. Checks that takes are read up to the last complete frame, and that frames survive a round
// trip through writing and reading.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "engine/takes/reader.h"
#include "fuzz/target.h"

namespace {

using limber::must;

void check_round_trip(const limber::engine::RecordedPass& tick) {
  limber::engine::InputLog log;
  for (const limber::engine::InputRecord& recorded : tick.messages)
    log.record(recorded.message, recorded.origin, recorded.evaluate);
  std::string text;
  log.append_pass(text, tick);
  limber::engine::InputCodec read;
  limber::engine::RecordedPass again;
  must(limber::engine::read_pass(text, read, again));
  must(again.messages.size() == tick.messages.size() && again.runs.size() == tick.runs.size());
  must(again.motion_hash == tick.motion_hash && again.body_hashes == tick.body_hashes &&
       again.state_hash == tick.state_hash);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  auto opened = limber::engine::TakeReader::from_stream(std::make_unique<std::istringstream>(bytes), "fuzz");
  if (!opened) {
    must(!opened.error().empty());
    return 0;
  }
  limber::engine::TakeReader& reader = **opened;
  for (limber::engine::RecordedPass tick; reader.next(tick);) {
    check_round_trip(tick);
    for (const limber::engine::TakeSceneRun& run : tick.runs) {
      must(run.files == 0 || reader.sources(run.files) != nullptr);
      (void)reader.presets(run.files);
    }
  }
  must(reader.position() <= reader.size());
  return 0;
}
