// Format: a line of JSON (version, scene, time), then the values as preset JSON. A lock file grants one program
// ownership.
#include "engine/recovery/recovery_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/plural.h"
#include "base/system/file.h"
#include "base/text.h"
#include "engine/presets/text.h"

namespace limber::engine {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFormatKey = "limber recovery";
constexpr int kVersion = 1;
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20u;

bool same_values(const double* a, const double* b, std::uint32_t count) {
  return std::memcmp(a, b, count * sizeof *a) == 0;
}

// True if the labels of two choices, or the values of other properties, are equal.
bool same_value(const PresetProperty& a, const double* in_a, const PresetProperty& b, const double* in_b) {
  if (a.type != b.type || a.width != b.width) return false;
  if (a.type != PropertyType::choice) return same_values(in_a, in_b, a.width);
  return a.labels[static_cast<std::size_t>(in_a[0])] == b.labels[static_cast<std::size_t>(in_b[0])];
}

}  // namespace

std::string RecoverableValues::time_text() const {
  const auto text = [](std::time_t time, const char* form) {
    std::tm local_time{};
    localtime_r(&time, &local_time);
    char out[32] = {};
    (void)std::strftime(out, sizeof out, form, &local_time);
    return std::string(out);
  };
  const bool today = text(saved_at, "%F") == text(std::time(nullptr), "%F");
  return text(saved_at, today ? "%T" : "%F %T");
}

std::string RecoverableValues::message() const {
  const std::size_t count = values->schema->property_count();
  return fmt::format("the last run of this scene did not exit cleanly; {} of {} can be restored with --recover",
                     counted(count, "value"), time_text());
}

std::shared_ptr<const Preset> changed_values(const Preset& now, const Preset& script) {
  const std::vector<std::uint32_t> script_nodes = corresponding_nodes(*now.schema, *script.schema);
  PresetBuilder builder;
  bool any = false;
  for (std::uint32_t i = 0; i < now.schema->nodes().size(); i++) {
    const PresetSchema::Node& node = now.schema->nodes()[i];
    const PresetLayout* const layout = now.schema->layout(node);
    if (layout == nullptr) continue;
    const PresetSchema::Node* const script_node =
        script_nodes[i] == kNoNode ? nullptr : &script.schema->nodes()[script_nodes[i]];
    const PresetLayout* const script_layout = script_node == nullptr ? nullptr : script.schema->layout(*script_node);
    PresetLayout changed;
    std::vector<double> values;
    for (std::size_t k = 0; k < layout->properties.size(); k++) {
      const PresetProperty& property = layout->properties[k];
      const double* const in_now = now.values.data() + node.offset + layout->offsets[k];
      const int at = script_layout == nullptr ? -1 : script_layout->find(property.name);
      if (at >= 0) {
        const auto other_index = static_cast<std::size_t>(at);
        const double* const in_script =
            script.values.data() + script_node->offset + script_layout->offsets[other_index];
        if (same_value(property, in_now, script_layout->properties[other_index], in_script)) continue;
      }
      changed.add(property);
      values.insert(values.end(), in_now, in_now + property.width);
    }
    any = any || !changed.properties.empty();
    builder.add(now.schema->path(i), std::move(changed), values);
  }
  if (!any) return nullptr;
  PresetSelection selection;
  selection.include = {"//*"};  // only these values
  return builder.finish("recovered", std::move(selection));
}

Result<std::unique_ptr<RecoveryFile>> RecoveryFile::open(const std::string& folder, const std::string& scene) {
  std::unique_ptr<RecoveryFile> file(
      new RecoveryFile(SceneLock::path_of(scene), fmt::format("{}/{}", folder, SceneLock::name_of(scene))));
  if (!file->lock_.acquire()) return std::unique_ptr<RecoveryFile>();
  std::error_code fault;
  fs::create_directories(folder, fault);  // acquiring the lock has created it already, if possible
  if (fault) return Error{fmt::format("{}: {}", printable(folder), fault.message())};
  // a saved file that was not removed is of a crashed run; it replaces older ones
  if (fs::exists(file->saved_file(), fault)) (void)std::rename(file->saved_file().c_str(), file->lost_file().c_str());
  return file;
}

Result<std::optional<RecoverableValues>> RecoveryFile::recoverable() const {
  std::error_code fault;
  if (!fs::exists(lost_file(), fault)) return std::optional<RecoverableValues>();
  const auto failure = [&](std::string_view why) {
    return Error{fmt::format("{}: {}; the values of the run that did not exit cleanly can't be restored",
                             printable(lost_file()), why)};
  };
  const Result<std::string> bytes = system::read_file(lost_file(), kMaxBytes);
  if (!bytes) return failure(bytes.error());
  const std::string& text = *bytes;
  const std::size_t line = text.find('\n');
  const auto header = nlohmann::json::parse(text.substr(0, line), nullptr, false);
  if (line == std::string::npos || !header.is_object() || !header.contains(kFormatKey) ||
      !header[kFormatKey].is_number_integer())
    return failure("it is damaged");
  if (header[kFormatKey] != kVersion) return failure("it is of another version of Limber");
  if (!header.contains("saved") || !header["saved"].is_number_integer()) return failure("it is damaged");
  Result<ParsedPresets> read = parse_presets(std::string_view(text).substr(line + 1));
  if (!read) return failure(read.error());
  if (read->presets.size() != 1 || !read->problems.empty()) return failure("it is damaged");
  return std::optional(RecoverableValues{read->presets.front(), header["saved"].get<std::time_t>()});
}

Result<void> RecoveryFile::save(const std::shared_ptr<const Preset>& values, std::time_t now) {
  if (values == nullptr) {
    system::remove_file(saved_file());
    return {};
  }
  const nlohmann::ordered_json header = {{kFormatKey, kVersion}, {"scene", scene_}, {"saved", now}};
  using Json = nlohmann::ordered_json;
  const std::string text =
      header.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n" + text_of(PresetList{values});
  Result<void> written = system::replace_file(temporary_file(), text, 0600);
  if (written && std::rename(temporary_file().c_str(), saved_file().c_str()) != 0)
    written = Error{system::error_reason()};
  if (!written) {
    system::remove_file(temporary_file());
    return Error{fmt::format("{}: {}", printable(saved_file()), written.error())};
  }
  system::sync_folder(saved_file());
  return {};
}

void RecoveryFile::end(bool remove_recoverable) {
  system::remove_file(saved_file());
  system::remove_file(temporary_file());
  if (remove_recoverable) system::remove_file(lost_file());
  lock_.release();
}

}  // namespace limber::engine
