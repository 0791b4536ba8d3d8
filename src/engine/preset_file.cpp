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

// a link stays a link: what it points to is replaced
std::string target_of(const std::string& path) {
  std::error_code none;
  const fs::path real = fs::canonical(path, none);
  return none ? path : real.string();
}

}  // namespace

std::string PresetFile::beside(const std::string& scene) {
  return fs::path(scene).replace_extension(".presets.json").string();
}

Result<PresetsRead> PresetFile::load() {
  clear_leftovers(path_);
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

// a second name for what is there, so that it is never without one
Result<void> PresetFile::set_aside(std::string& said) const {
  const std::string path = target_of(path_);
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
  const std::string path = target_of(path_);
  const std::string fresh = fresh_name(path);
  const std::optional<system::FileStatus> now = system::file_status(path);
  const std::string text = text_of(presets);
  const auto failed = [&](const std::string& why) {
    system::remove_file(fresh);
    return Error{fmt::format("the presets could not be saved: {}", why)};
  };
  if (const Result<void> written = system::write_whole(fresh, text, now ? now->permissions : 0644u); !written)
    return failed(written.error());
  if (now && (unread_ || !known_.holds(path))) {
    if (const Result<void> aside = set_aside(said); !aside) return failed(aside.error());
  }
  if (std::rename(fresh.c_str(), path.c_str()) != 0) return failed(reason());
  system::sync_folder(path);
  known_ = FileStamp(path);
  unread_ = false;
  return {};
}

}  // namespace limber
