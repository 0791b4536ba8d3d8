// Reads a whole take and prints a summary.
#include "app/commands/commands.h"

#include <cstdint>
#include <map>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/text.h"
#include "engine/takes/reader.h"

namespace limber::app {

namespace {

struct Count {
  std::uint64_t ticks = 0, messages = 0, texts = 0, stopped = 0, last = 0;
  std::map<engine::TakeSceneRun::Kind, std::uint64_t> runs;
};

Count count_all(engine::TakeReader& reader) {
  Count count;
  for (engine::RecordedPass tick; reader.next(tick);) {
    if (tick.running) count.ticks++;
    for (const engine::InputRecord& message : tick.messages) (message.evaluate ? count.texts : count.messages)++;
    for (const engine::TakeSceneRun& run : tick.runs) {
      if (run.succeeded) count.runs[run.kind]++;
    }
    count.stopped += tick.stopped_calls.size();
    count.last = tick.tick;
  }
  return count;
}

// prints each file once, with the size of its first version
void print_files(const engine::TakeReader& reader) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> files;  // number of versions, bytes of the first
  std::map<std::string, std::uint32_t> newest;
  for (const engine::TakeFileList& list : reader.file_lists()) {
    for (const auto& [path, content] : list.files) {
      const auto [at, fresh] = files.try_emplace(path, 1, reader.content_size(content));
      if (!fresh && newest[path] != content) at->second.first++;
      newest[path] = content;
    }
  }
  for (const auto& [path, file] : files) {
    print_result("  {} ({}{})\n", printable(path), counted(file.second, "byte"),
                 file.first > 1 ? fmt::format(", {} versions", file.first) : std::string());
  }
}

}  // namespace

int take_command(const std::string& file) {
  auto opened = engine::TakeReader::open(file);
  if (!opened) return fail(kInputError, opened.error());
  engine::TakeReader& reader = **opened;
  const Count count = count_all(reader);
  const auto runs = [&](engine::TakeSceneRun::Kind kind) {
    const auto at = count.runs.find(kind);
    return at == count.runs.end() ? std::uint64_t{0} : at->second;
  };
  print_result("scene     {}\n", printable(reader.header().scene));
  print_result("recorded  {} by limber {}\n", printable(reader.header().recorded), printable(reader.header().limber));
  print_result("ticks     {}\n", count.ticks);
  print_result("messages  {}, console inputs {}\n", count.messages, count.texts);
  print_result("runs      {}, {}, {}\n",
               counted(runs(engine::TakeSceneRun::Kind::reload_finished) + runs(engine::TakeSceneRun::Kind::reload) +
                           runs(engine::TakeSceneRun::Kind::rerun),
                       "reload"),
               counted(runs(engine::TakeSceneRun::Kind::reset), "reset"),
               counted(runs(engine::TakeSceneRun::Kind::scene), "other scene"));
  print_result("stopped   {}\n", counted(count.stopped, "script call"));
  print_result("bytes     {}\n", reader.size());
  if (reader.end()) {
    print_result("end       complete; hash {:016x} tick {}\n", reader.end()->state_hash, reader.end()->tick);
  } else {
    print_result("end       cut off after tick {}, at byte {}\n", count.last, reader.position());
  }
  print_result("files\n");
  print_files(reader);
  if (!reader.damage().empty()) return fail(kInputError, fmt::format("{}: {}", printable(file), reader.damage()));
  return kSuccess;
}

}  // namespace limber::app
