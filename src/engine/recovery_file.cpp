// A lock on a file beside makes it one program's; a first line says what the values are of, presets' text follows.
#include "engine/recovery_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/system/file.h"
#include "base/text.h"
#include "engine/preset_text.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHead = "limber recovery";
constexpr int kVersion = 1;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20u;

std::string reason() { return std::generic_category().message(errno); }

bool same_values(const double* a, const double* b, std::uint32_t count) {
  return std::memcmp(a, b, count * sizeof *a) == 0;
}

// whether the label of a choice, or the numbers of another row, are the same
bool same_row(const PresetRow& a, const double* in_a, const PresetRow& b, const double* in_b) {
  if (a.type != b.type || a.width != b.width) return false;
  if (a.type != RowType::choice) return same_values(in_a, in_b, a.width);
  return a.labels[static_cast<std::size_t>(in_a[0])] == b.labels[static_cast<std::size_t>(in_b[0])];
}

}  // namespace

std::string LostValues::when() const {
  const auto text = [](std::time_t time, const char* form) {
    std::tm here{};
    localtime_r(&time, &here);
    char out[32] = {};
    (void)std::strftime(out, sizeof out, form, &here);
    return std::string(out);
  };
  const bool today = text(saved, "%F") == text(std::time(nullptr), "%F");
  return text(saved, today ? "%T" : "%F %T");
}

std::string LostValues::offer() const {
  const std::size_t count = values->shape->row_count();
  return fmt::format("the last run of this scene did not end well; {} value{} of {} can be brought back: --recover",
                     count, count == 1 ? "" : "s", when());
}

std::shared_ptr<const Preset> changed_values(const Preset& now, const Preset& script) {
  std::unordered_map<std::string, std::uint32_t> said;
  for (std::uint32_t i = 0; i < script.shape->things().size(); i++) {
    if (script.shape->rows(script.shape->things()[i]) != nullptr) said.emplace(script.shape->path(i), i);
  }
  PresetBuilder builder;
  bool any = false;
  for (std::uint32_t i = 0; i < now.shape->things().size(); i++) {
    const PresetShape::Thing& thing = now.shape->things()[i];
    const PresetClass* const rows = now.shape->rows(thing);
    if (rows == nullptr) continue;
    const std::string path = now.shape->path(i);
    const auto known = said.find(path);
    const PresetShape::Thing* const other = known == said.end() ? nullptr : &script.shape->things()[known->second];
    const PresetClass* const others = other == nullptr ? nullptr : script.shape->rows(*other);
    PresetClass changed;
    std::vector<double> values;
    for (std::size_t k = 0; k < rows->rows.size(); k++) {
      const PresetRow& row = rows->rows[k];
      const double* const in_now = now.values.data() + thing.at + rows->offsets[k];
      const int at = others == nullptr ? -1 : others->find(row.name);
      if (at >= 0) {
        const auto there = static_cast<std::size_t>(at);
        const double* const in_script = script.values.data() + other->at + others->offsets[there];
        if (same_row(row, in_now, others->rows[there], in_script)) continue;
      }
      changed.add(row);
      values.insert(values.end(), in_now, in_now + row.width);
    }
    if (changed.rows.empty()) continue;
    any = true;
    builder.give(builder.thing(path), std::move(changed), values);
  }
  if (!any) return nullptr;
  PresetChoice choice;
  choice.rows = {"//*"};  // these alone
  return builder.finish("recovered", std::move(choice));
}

Result<std::unique_ptr<RecoveryFile>> RecoveryFile::open(const std::string& folder, const std::string& scene) {
  std::unique_ptr<RecoveryFile> file(
      new RecoveryFile(SceneLock::path_of(scene), fmt::format("{}/{}", folder, SceneLock::name_of(scene))));
  if (!file->lock_.take()) return std::unique_ptr<RecoveryFile>();
  std::error_code fault;
  fs::create_directories(folder, fault);  // the lock has made it, where that is possible
  if (fault) return Error{fmt::format("{}: {}", printable(folder), fault.message())};
  // the newest that was lost is the one that counts
  if (fs::exists(file->saved_file(), fault)) (void)std::rename(file->saved_file().c_str(), file->lost_file().c_str());
  return file;
}

Result<std::optional<LostValues>> RecoveryFile::lost() const {
  std::error_code fault;
  if (!fs::exists(lost_file(), fault)) return std::optional<LostValues>();
  const auto bad = [&](std::string_view why) {
    return Error{fmt::format("{}: {}; the values of a run that did not end well can't be brought back",
                             printable(lost_file()), why)};
  };
  const Result<std::string> bytes = system::read_file(lost_file(), kMostBytes);
  if (!bytes) return bad(bytes.error());
  const std::string& text = *bytes;
  const std::size_t line = text.find('\n');
  const auto head = nlohmann::json::parse(text.substr(0, line), nullptr, false);
  if (line == std::string::npos || !head.is_object() || !head.contains(kHead) || !head[kHead].is_number_integer())
    return bad("it is damaged");
  if (head[kHead] != kVersion) return bad("it is of another version of Limber");
  if (!head.contains("saved") || !head["saved"].is_number_integer()) return bad("it is damaged");
  Result<PresetsRead> read = presets_of(std::string_view(text).substr(line + 1));
  if (!read) return bad(read.error());
  if (read->presets.size() != 1 || !read->problems.empty()) return bad("it is damaged");
  return std::optional(LostValues{read->presets.front(), head["saved"].get<std::time_t>()});
}

Result<void> RecoveryFile::save(const std::shared_ptr<const Preset>& values, std::time_t now) {
  if (values == nullptr) {
    system::remove_file(saved_file());
    return {};
  }
  const nlohmann::ordered_json head = {{kHead, kVersion}, {"scene", scene_}, {"saved", now}};
  using Json = nlohmann::ordered_json;
  const std::string text =
      head.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n" + text_of(PresetList{values});
  Result<void> written = system::write_whole(fresh_file(), text, 0600);
  if (written && std::rename(fresh_file().c_str(), saved_file().c_str()) != 0) written = Error{reason()};
  if (!written) {
    system::remove_file(fresh_file());
    return Error{fmt::format("{}: {}", printable(saved_file()), written.error())};
  }
  system::sync_folder(saved_file());
  return {};
}

void RecoveryFile::end(bool lost_too) {
  system::remove_file(saved_file());
  system::remove_file(fresh_file());
  if (lost_too) system::remove_file(lost_file());
  lock_.release();
}

}  // namespace limber
