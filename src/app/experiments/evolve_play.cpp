// Finds the elite, and plays its scene with its parameters and seed.
#include "app/experiments/evolve_play.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/paths.h"
#include "base/log/output.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber::app {

namespace {

using experiments::Elite;
using experiments::Search;

constexpr std::uintmax_t kMaxStateBytes = std::uintmax_t{1} << 30;

// Returns the index of the elite of that number or name.
Result<std::size_t> find_elite(const std::string& word, const std::vector<Elite>& elites,
                               const std::vector<std::string>& names) {
  if (word.empty()) return best_of(elites);
  const auto named = std::ranges::find_if(names, [&](const std::string& name) { return same_name(name, word); });
  if (named != names.end()) return static_cast<std::size_t>(named - names.begin());
  const std::optional<double> number = parse_number(word);
  if (number && *number >= 1 && *number <= static_cast<double>(elites.size()) && *number == std::floor(*number))
    return static_cast<std::size_t>(*number) - 1;
  return Error{fmt::format("there is no elite '{}'{}; elites.csv lists their numbers, 1 to {}, and names",
                           printable(word), name_hint(word, names), elites.size())};
}

}  // namespace

Result<SavedSearch> read_search(const Archive& archive) try {
  const std::string file = archive.state_file();
  const Result<std::string> text = system::read_file(file, kMaxStateBytes);
  if (!text) return Error{fmt::format("{}: {}", printable(file), text.error())};
  const auto json = nlohmann::ordered_json::parse(*text);
  return SavedSearch{json.at("search").dump(), json.at("scene_path"), json.at("failures"), json.at("state")};
} catch (const nlohmann::json::exception&) {
  return Error{fmt::format("{}: the file is damaged", printable(archive.state_file()))};
}

int play_elite_command(const PlayEliteCommand& command) {
  const Archive archive(command.folder);
  const auto damaged = [&](const std::string& reason) {
    return fail(kInputError, fmt::format("{}: {}", printable(archive.state_file()), reason));
  };
  const Result<SavedSearch> saved = read_search(archive);
  if (!saved) return fail(kInputError, fmt::format("{}; name the folder of a search", saved.error()));
  const Result<SearchRecord> record = SearchRecord::parse(saved->record);
  if (!record) return damaged(record.error());
  const std::unique_ptr<Search> search = Search::create(record->options());
  if (const Result<void> restored = search->restore(saved->state); !restored) return damaged(restored.error());
  const std::vector<Elite> elites = search->elites();
  if (elites.empty()) return fail(kInputError, fmt::format("{}: there is no elite yet", printable(command.folder)));
  const Result<std::size_t> index = find_elite(command.elite, elites, record->names(elites));
  if (!index) return fail(kUsageError, index.error());
  const Elite& elite = elites[*index];
  PlayOptions play = command.play;
  std::vector<std::string> searched;
  // found as typed from the folder where the search was started, else at its former place
  play.scene = find_file_or_folder(record->scene, searched).empty() ? saved->scene_path : record->scene;
  const std::vector<double> values = record->values(elite.individual);
  std::vector<std::string> params;
  for (std::size_t i = 0; i < values.size(); i++)
    params.push_back(fmt::format("{}={}", record->axes[i].name, record->axes[i].text(values[i])));
  play.run.params.insert(play.run.params.begin(), params.begin(), params.end());
  if (!play.seed) play.seed = record->seeds.front();
  if (play.run.presets.empty()) play.run.presets = archive.preset_file();
  print_notice("{}: {} --presets {}", record->names(elites)[*index], record->play_command(elite),
               shell_word(archive.preset_file()));
  return play_command(play);
}

}  // namespace limber::app
