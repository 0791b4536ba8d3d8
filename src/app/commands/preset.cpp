// Reads both files, appends the presets and writes the result.
#include "app/commands/commands.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/viewer/played_file.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/file.h"
#include "base/text.h"
#include "engine/presets/file.h"

namespace limber::app {

namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20u;  // limit for preset files of other programs

// appends presets under names that are not in use
void append(engine::PresetList& list, const engine::PresetList& more) {
  for (const auto& preset : more) {
    std::string name = preset->name;
    const auto in_use = [&] {
      return std::any_of(list.begin(), list.end(), [&](const auto& p) { return p->name == name; });
    };
    for (int n = 2; in_use(); n++) name = fmt::format("{} {}", shortened(preset->name, 100), n);
    list.push_back(std::make_shared<const engine::Preset>(
        engine::Preset{name, preset->selection, preset->schema, preset->values}));
  }
}

}  // namespace

int preset_command(const PresetCommand& command) {
  const Result<std::string> text = system::read_file(command.file, kMaxBytes);
  if (!text)
    return fail(kInputError, fmt::format("{}: {}; in Max, pattrstorage writes one by the message writejson",
                                         printable(command.file), text.error()));
  const Result<engine::ParsedPresets> imported = engine::import_pattrstorage(*text);
  if (!imported) return fail(kInputError, fmt::format("{}: {}", command.file, imported.error()));
  const Result<PlayedFile> played = find_played(command.scene);
  if (!played) return fail(kInputError, played.error());
  const std::string& scene = played->scene;
  const std::string state = state_dir();
  const std::string locks = state.empty() ? "" : state + "/locks";
  engine::PresetFile file(engine::PresetFile::path_for(scene),
                          engine::PresetFile::write_access_for(scene, locks, true));
  Result<engine::ParsedPresets> before = file.load();
  if (!before) return fail(kInputError, before.error());
  append(before->presets, imported->presets);
  std::string notice;
  if (const Result<void> saved = file.save(before->presets, notice); !saved)
    return fail(kMachineError, fmt::format("{}: {}", printable(file.path()), saved.error()));
  for (const std::string& problem : imported->problems) print_notice("{}", printable(problem));
  if (!notice.empty()) print_notice("{}", notice);
  print_result("{} in {} now, {} of them new\n", counted(before->presets.size(), "preset is", "presets are"),
               printable(file.path()), imported->presets.size());
  return kSuccess;
}

}  // namespace limber::app
