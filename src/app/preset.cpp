// Reads both files, writes one.
#include "app/preset.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "base/output.h"
#include "base/system/file.h"
#include "base/text.h"
#include "engine/preset_file.h"
#include "engine/preset_import.h"

namespace limber {

namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20u;  // of a file of presets of another program

// behind those that are there, under names that nobody has
void append(PresetList& list, const PresetList& more) {
  for (const auto& preset : more) {
    std::string name = preset->name;
    const auto taken = [&] {
      return std::any_of(list.begin(), list.end(), [&](const auto& p) { return p->name == name; });
    };
    for (int n = 2; taken(); n++) name = fmt::format("{} {}", shortened(preset->name, 100), n);
    list.push_back(std::make_shared<const Preset>(Preset{name, preset->choice, preset->shape, preset->values}));
  }
}

}  // namespace

int preset_command(const PresetCommand& command) {
  const Result<std::string> text = system::read_file(command.file, kMostBytes);
  if (!text)
    return fail(kInput, fmt::format("{}: {}; in Max, pattrstorage writes one by the message writejson",
                                    printable(command.file), text.error()));
  const Result<PresetsRead> imported = import_pattrstorage(*text);
  if (!imported) return fail(kInput, fmt::format("{}: {}", command.file, imported.error()));
  std::vector<std::string> looked;
  const std::string scene = find_scene(command.scene, looked);
  if (scene.empty()) return fail(kInput, no_scene(command.scene, looked));
  const std::string state = state_dir();
  const std::string locks = state.empty() ? "" : state + "/locks";
  PresetFile file(PresetFile::beside(scene), PresetFile::owner_of(scene, locks, true));
  Result<PresetsRead> before = file.load();
  if (!before) return fail(kInput, before.error());
  append(before->presets, imported->presets);
  std::string said;
  if (const Result<void> saved = file.save(before->presets, said); !saved)
    return fail(kMachine, fmt::format("{}: {}", printable(file.path()), saved.error()));
  for (const std::string& problem : imported->problems) print_notice("{}", printable(problem));
  if (!said.empty()) print_notice("{}", said);
  print_result("{} presets are in {} now, {} of them new\n", before->presets.size(), printable(file.path()),
               imported->presets.size());
  return kFine;
}

}  // namespace limber
