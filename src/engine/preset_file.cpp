// Reading whole, writing beside, renaming.
#include "engine/preset_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"
#include "script/files.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

std::string reason() { return std::generic_category().message(errno); }

Error file_error(const std::string& path, std::string_view what) {
  return Error{fmt::format("{}: {}", printable(path), what)};
}

// what is written until it has the file's name: of this program, so that two don't share one
std::string fresh_name(const std::string& path) { return fmt::format("{}.{}.new", path, system::process_id()); }

// what programs that were killed in the middle of a save have left
void clear_leftovers(const std::string& path) {
  const fs::path file(path);
  const std::string begin = file.filename().string() + ".";
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(file.has_parent_path() ? file.parent_path() : fs::path("."), gone)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(".new") || name.size() < begin.size() + 5) continue;
    const auto pid = parse_number(std::string_view(name).substr(begin.size(), name.size() - begin.size() - 4));
    if (!pid || *pid < 1 || *pid > 4194304 || system::process_runs(static_cast<int>(*pid))) continue;
    fs::remove(entry.path(), gone);
  }
}

}  // namespace

std::string PresetFile::beside(const std::string& scene) {
  return fs::path(scene).replace_extension(".presets.json").string();
}

PresetFile::Owner PresetFile::owner_of(const std::string& scene, const std::string& locks, bool stays) {
  return {ScriptFiles(scene, {}).show_folder(),
          locks.empty() ? "" : fmt::format("{}/{}.presets", locks, SceneLock::name_of(scene)), stays};
}

Result<PresetsRead> PresetFile::load() {
  if (!stays_ || lock_.take()) clear_leftovers(path_);
  known_ = {};
  unread_ = false;
  std::error_code none;
  const fs::file_status status = fs::status(path_, none);
  if (!fs::exists(status)) return PresetsRead{};
  unread_ = true;  // until it is understood
  if (!fs::is_regular_file(status)) return file_error(path_, "this is no file");
  const std::uintmax_t size = fs::file_size(path_, none);
  if (none) return file_error(path_, none.message());
  if (size > kMostBytes)
    return file_error(path_, fmt::format("{} MB are more than presets take ({} MB)", size >> 20u, kMostBytes >> 20u));
  const FileStamp before(path_);
  std::string text(size, '\0');
  std::ifstream in(path_, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) return file_error(path_, "it can't be read");
  Result<PresetsRead> read = presets_of(text);
  known_ = before;
  if (!read) return file_error(path_, read.error());
  unread_ = !read->problems.empty();
  for (std::string& problem : read->problems) problem = file_error(path_, problem).text;
  return read;
}

// A link stays a link: what it leads to is replaced, if it belongs to the show.
Result<std::string> PresetFile::target() const {
  std::error_code none;
  if (!fs::is_symlink(path_, none)) return path_;
  const fs::path real = fs::canonical(path_, none);
  if (none) return path_;  // it leads nowhere, and is replaced itself
  const std::string folder = fs::absolute(path_).parent_path().string();
  if (!is_inside(real.string(), folder) && (show_.empty() || !is_inside(real.string(), show_))) {
    return Error{fmt::format("it is a link to {}, outside of the show's folder; put a file in its place",
                             printable(real.string()))};
  }
  if (unread_) {
    return Error{fmt::format("it is a link to {}, which is no file of presets; put a file in its place",
                             printable(real.string()))};
  }
  return real.string();
}

// a second name for what is there, so that it is never without one
Result<void> PresetFile::set_aside(const std::string& path, std::string& said) const {
  for (int n = 1; n < 10000; n++) {
    const std::string aside = fmt::format("{}.old{}", path, n == 1 ? "" : fmt::format("-{}", n));
    if (system::link_file(path, aside) ||
        (errno == EPERM && !fs::exists(aside) && std::rename(path.c_str(), aside.c_str()) == 0)) {
      said = fmt::format("{}: what stood there is kept as {}", printable(path_),
                         printable(fs::path(aside).filename().string()));
      return {};
    }
    if (errno != EEXIST) break;
  }
  return Error{reason()};
}

Result<void> PresetFile::save(const PresetList& presets, std::string& said) {
  const auto failed = [](std::string_view why) {
    return Error{fmt::format("the presets could not be saved: {}", why)};
  };
  if (!lock_.take()) return failed("another program plays this scene and owns them");
  const Result<void> written = write(presets, said);
  if (!stays_) lock_.release();
  return written ? written : failed(written.error());
}

Result<void> PresetFile::write(const PresetList& presets, std::string& said) {
  const Result<std::string> place = target();
  if (!place) return Error{place.error()};
  const std::string& path = *place;
  const std::string fresh = fresh_name(path);
  const std::optional<system::FileStatus> now = system::file_status(path);
  const std::string text = text_of(presets);
  const auto failed = [&](const std::string& why) {
    system::remove_file(fresh);
    return Error{why};
  };
  if (now && !now->file) return Error{"it is no file"};
  if (const Result<void> written = system::write_whole(fresh, text, now ? now->permissions : 0644u); !written)
    return failed(written.error());
  if (now && (unread_ || !known_.holds(path))) {
    if (const Result<void> aside = set_aside(path, said); !aside) return failed(aside.error());
  }
  if (std::rename(fresh.c_str(), path.c_str()) != 0) return failed(reason());
  system::sync_folder(path);
  known_ = FileStamp(path);
  unread_ = false;
  return {};
}

}  // namespace limber
