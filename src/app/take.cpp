// Reads the take from its first byte to its last.
#include "app/take.h"

#include <cstdint>
#include <map>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/output.h"
#include "base/text.h"
#include "engine/take_reader.h"

namespace limber {

namespace {

struct Count {
  std::uint64_t ticks = 0, messages = 0, texts = 0, stopped = 0, last = 0;
  std::map<TakeRun::Kind, std::uint64_t> runs;
};

Count count_all(TakeReader& reader) {
  Count count;
  for (TakeTick tick; reader.next(tick);) {
    if (tick.running) count.ticks++;
    for (const TakeMessage& message : tick.messages) (message.evaluate ? count.texts : count.messages)++;
    for (const TakeRun& run : tick.runs) {
      if (run.good) count.runs[run.kind]++;
    }
    count.stopped += tick.stopped.size();
    count.last = tick.tick;
  }
  return count;
}

// every file once, with the size of what it held first
void print_files(const TakeReader& reader) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> files;  // versions, bytes of the first
  std::map<std::string, std::uint32_t> newest;
  for (const TakeFileList& list : reader.file_lists()) {
    for (const auto& [path, content] : list.files) {
      const auto [at, fresh] = files.try_emplace(path, 1, reader.content_size(content));
      if (!fresh && newest[path] != content) at->second.first++;
      newest[path] = content;
    }
  }
  for (const auto& [path, file] : files) {
    print_result("  {} ({} bytes{})\n", printable(path), file.second,
                 file.first > 1 ? fmt::format(", {} versions", file.first) : std::string());
  }
}

}  // namespace

int take_command(const TakeCommand& command) {
  auto opened = TakeReader::open(command.file);
  if (!opened) return fail(kInput, opened.error());
  TakeReader& reader = **opened;
  const Count count = count_all(reader);
  const auto runs = [&](TakeRun::Kind kind) {
    const auto at = count.runs.find(kind);
    return at == count.runs.end() ? std::uint64_t{0} : at->second;
  };
  print_result("scene     {}\n", printable(reader.header().scene));
  print_result("recorded  {} by limber {}\n", printable(reader.header().recorded), printable(reader.header().limber));
  print_result("ticks     {}\n", count.ticks);
  print_result("messages  {}, texts of consoles {}\n", count.messages, count.texts);
  print_result("runs      {} reloads, {} resets, {} other scenes\n",
               runs(TakeRun::Kind::take) + runs(TakeRun::Kind::reload) + runs(TakeRun::Kind::rerun),
               runs(TakeRun::Kind::reset), runs(TakeRun::Kind::scene));
  print_result("stopped   {} calls of scripts\n", count.stopped);
  print_result("bytes     {}\n", reader.size());
  if (reader.end()) {
    print_result("end       whole; hash {:016x} tick {}\n", reader.end()->state, reader.end()->tick);
  } else {
    print_result("end       cut off behind tick {}, at byte {}\n", count.last, reader.position());
  }
  print_result("files\n");
  print_files(reader);
  if (!reader.damage().empty()) return fail(kInput, fmt::format("{}: {}", printable(command.file), reader.damage()));
  return kFine;
}

}  // namespace limber
