// Loading, backups and atomic replacement.
#include "engine/presets/file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"
#include "engine/output/health.h"
#include "script/scene/script_files.h"

namespace limber::engine {

namespace fs = std::filesystem;

namespace {

Error file_error(const std::string& path, std::string_view description) {
  return Error{fmt::format("{}: {}", printable(path), description)};
}

// Returns the temporary path; with the process id, so that two programs don't share it.
std::string temporary_path(const std::string& path) { return fmt::format("{}.{}.new", path, system::process_id()); }

// Removes temporary files of programs that were killed during a save.
void remove_stale_temporaries(const std::string& path) {
  const fs::path file(path);
  const std::string begin = file.filename().string() + ".";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(file.has_parent_path() ? file.parent_path() : fs::path("."), error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(".new") || name.size() < begin.size() + 5) continue;
    const auto pid = parse_number(std::string_view(name).substr(begin.size(), name.size() - begin.size() - 4));
    if (!pid || *pid < 1 || *pid > 4194304 || system::is_process_running(static_cast<int>(*pid))) continue;
    fs::remove(entry.path(), error);
  }
}

}  // namespace

std::string PresetFile::path_for(const std::string& scene) {
  return fs::path(scene).replace_extension(".presets.json").string();
}

PresetFile::WriteAccess PresetFile::write_access_for(const std::string& scene, const std::string& locks,
                                                     bool keep_lock) {
  return {script::ScriptFiles(scene, {}).show_folder(),
          locks.empty() ? "" : fmt::format("{}/{}.presets", locks, SceneLock::name_of(scene)), keep_lock};
}

Result<ParsedPresets> PresetFile::load() {
  if (!keep_lock_ || lock_.acquire()) remove_stale_temporaries(path_);
  last_stamp_ = {};
  has_unparsed_ = false;
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status)) return ParsedPresets{};
  has_unparsed_ = true;  // until it was parsed
  if (!fs::is_regular_file(status)) return file_error(path_, "not a regular file");
  const std::uintmax_t size = fs::file_size(path_, error);
  if (error) return file_error(path_, error.message());
  if (size > kMaxBytes)
    return file_error(path_,
                      fmt::format("the file of {} MB exceeds the limit of {} MB", size >> 20u, kMaxBytes >> 20u));
  const model::FileStamp before(path_);
  std::string text(size, '\0');
  std::ifstream in(path_, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) return file_error(path_, "it can't be read");
  Result<ParsedPresets> read = parse_presets(text);
  last_stamp_ = before;
  if (!read) return file_error(path_, read.error());
  has_unparsed_ = !read->problems.empty();
  for (std::string& problem : read->problems) problem = file_error(path_, problem).text;
  return read;
}

// Returns the path to be replaced: for a symbolic link its target, which must be in the show's folder.
Result<std::string> PresetFile::target() const {
  std::error_code error;
  if (!fs::is_symlink(path_, error)) return path_;
  const fs::path real = fs::canonical(path_, error);
  if (error) return path_;  // a dangling link is replaced itself
  const std::string folder = fs::absolute(path_).parent_path().string();
  if (!script::is_inside(real.string(), folder) &&
      (show_folder_.empty() || !script::is_inside(real.string(), show_folder_))) {
    return Error{fmt::format("it is a link to {}, outside of the show's folder; put a file in its place",
                             printable(real.string()))};
  }
  if (has_unparsed_) {
    return Error{fmt::format("it is a link to {}, which is not a preset file; put a file in its place",
                             printable(real.string()))};
  }
  return real.string();
}

// Backs up a file by a hard link with another name, so that the file exists at all times.
Result<void> PresetFile::back_up(const std::string& path, std::string& notice) const {
  for (int n = 1; n < 10000; n++) {
    const std::string backup = fmt::format("{}.old{}", path, n == 1 ? "" : fmt::format("-{}", n));
    if (system::link_file(path, backup) ||
        (errno == EPERM && !fs::exists(backup) && std::rename(path.c_str(), backup.c_str()) == 0)) {
      notice = fmt::format("{}: the previous file was backed up as {}", printable(path_),
                           printable(fs::path(backup).filename().string()));
      return {};
    }
    if (errno != EEXIST) break;
  }
  return Error{system::error_reason()};
}

Result<void> PresetFile::save(const PresetList& presets, std::string& notice) {
  const auto failed = [](std::string_view why) {
    return Error{fmt::format("the presets could not be saved: {}", why)};
  };
  if (!lock_.acquire()) return failed("another program plays this scene and owns them");
  const Result<void> written = write(presets, notice);
  if (!keep_lock_) lock_.release();
  return written ? written : failed(written.error());
}

Result<void> PresetFile::write(const PresetList& presets, std::string& notice) {
  const Result<std::string> target_path = target();
  if (!target_path) return Error{target_path.error()};
  const std::string& path = *target_path;
  const std::string temporary = temporary_path(path);
  const std::optional<system::FileStatus> now = system::file_status(path);
  const std::string text = text_of(presets);
  const auto failed = [&](const std::string& why) {
    system::remove_file(temporary);
    return Error{why};
  };
  if (now && !now->file) return Error{"it is not a regular file"};
  if (const Result<void> written = system::replace_file(temporary, text, now ? now->permissions : 0644u); !written)
    return failed(written.error());
  if (now && (has_unparsed_ || !last_stamp_.is_current(path))) {
    if (const Result<void> backed_up = back_up(path, notice); !backed_up) return failed(backed_up.error());
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) return failed(system::error_reason());
  system::sync_folder(path);
  last_stamp_ = model::FileStamp(path);
  has_unparsed_ = false;
  return {};
}

PresetSaver::PresetSaver(BackgroundWriter& writer, PresetFile file, std::function<void(const std::string&)> on_failure)
    : writer_(writer), file_(std::move(file)), on_failure_(std::move(on_failure)) {
  writer_.add(*this);
}

PresetSaver::~PresetSaver() {
  finish();
  writer_.remove(*this);
}

void PresetSaver::save(std::shared_ptr<const PresetList> presets) {
  {
    const std::scoped_lock lock(mutex_);
    pending_.swap(presets);
    saved_.store(false);
  }
  if (!writer_.request(*this)) on_failure_("could not create a thread to save presets; the next save tries again");
}

BackgroundWriter::Clock::time_point PresetSaver::run() {
  std::unique_lock lock(mutex_);
  const std::shared_ptr<const PresetList> presets = std::exchange(pending_, nullptr);
  lock.unlock();
  if (presets == nullptr) return BackgroundWriter::kNever;
  std::string notice;
  const Result<void> saved = file_.save(*presets, notice);
  if (!notice.empty()) log_warning("{}", notice);
  if (!saved) {
    count_failed_write();
    log_error("{}: {}", printable(file_.path()), saved.error());
    on_failure_(saved.error());
  }
  lock.lock();
  if (saved.ok() && pending_ == nullptr) saved_.store(true);
  return BackgroundWriter::kNever;
}

}  // namespace limber::engine
