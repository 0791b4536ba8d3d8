// Search order of textures and material files.
#include "model/look/file_lookup.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameBytes = 1024;
constexpr int kMaxFolderEntries = 10'000;  // larger folders are not searched in any letter case

// The path inside a name: without the scheme of a URI, with slashes. The drive of a Windows path stays: its file is
// found by its name alone.
std::string path_in(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  for (const std::string_view scheme : {"file://", "package://", "model://", "file:"}) {
    if (name.starts_with(scheme)) return name.substr(scheme.size());
  }
  return name;
}

std::vector<std::string> candidates(const std::string& mesh, const std::string& name) {
  constexpr std::array<const char*, 6> kTextureFolders{
      ".", "textures", "../textures", "../materials/textures", "materials/textures", "../../materials/textures"};
  constexpr int kParents = 4;
  const fs::path folder = fs::path(mesh).parent_path();
  std::vector<std::string> out;
  const auto add = [&out](const fs::path& path) { out.push_back(path.lexically_normal().string()); };
  std::vector<std::string> names{path_in(name)};
  if (std::string decoded = percent_decoded(names[0]); decoded != names[0]) names.push_back(std::move(decoded));
  for (const std::string& each : names) {
    const fs::path path(each);
    add(folder / path);  // an absolute path replaces the folder
    if (path.is_relative() && path.has_parent_path()) {
      fs::path above = folder;
      for (int i = 0; i < kParents; ++i) add((above /= "..") / path);
    }
    for (const char* place : kTextureFolders) add(folder / place / path.filename());
  }
  return out;
}

bool has_name(const std::string& name, std::string_view end) {
  return name.size() > end.size() && same_name(std::string_view(name).substr(name.size() - end.size()), end);
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char value = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2 &&
        value >= ' ') {
      out += static_cast<char>(value);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string find_in_any_case(const std::string& folder, std::string_view name) {
  std::string found;
  std::error_code fault;
  int left = kMaxFolderEntries;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, fault), end; !fault && entry != end && left-- > 0;
       entry.increment(fault)) {
    const std::string other = entry->path().filename().string();
    // the order of a folder's entries is not defined
    if (same_in_any_case(name, other) && (found.empty() || other < found)) found = other;
  }
  return found.empty() ? found : (fs::path(folder) / found).string();
}

Result<std::shared_ptr<const Image>> ImageCache::load(const std::string& path, const FileSet* memory_files) {
  if (memory_files == nullptr) {
    const std::lock_guard lock(mutex_);
    const auto known = images_.find(path);
    if (known != images_.end() && known->second.stamp.is_current(path)) {
      if (std::shared_ptr<const Image> image = known->second.image.lock()) return image;
    }
  }
  const FileStamp stamp = memory_files == nullptr ? FileStamp(path) : FileStamp();
  const std::string* const content = memory_files == nullptr ? nullptr : memory_files->content(path);
  Result<std::string> bytes =
      content != nullptr ? Result<std::string>(*content) : read_whole_file(path, kMaxImageBytes);
  if (!bytes) return Error{bytes.error()};
  Result<std::shared_ptr<const Image>> image = image_from_bytes(*bytes, path);
  if (!image) return Error{fmt::format("{}: {}", printable(path), image.error())};
  if (memory_files != nullptr) return image;
  const std::lock_guard lock(mutex_);
  Entry& entry = images_[path];
  std::shared_ptr<const Image> other = entry.image.lock();
  if (other != nullptr && entry.stamp == stamp) return other;
  entry = {stamp, *image};
  return image;
}

bool FileLookup::exists(const std::string& path) const {
  if (memory_files_ != nullptr) return memory_files_->content(path) != nullptr;
  std::error_code fault;
  return fs::is_regular_file(path, fault);
}

std::string FileLookup::find_misspelled(const std::string& path) const {
  if (memory_files_ != nullptr) {
    for (const auto& [other, content] : memory_files_->contents) {
      if (same_in_any_case(other, path)) return other;
    }
    return {};
  }
  const fs::path wanted(path);
  std::string other = find_in_any_case(wanted.parent_path().string(), wanted.filename().string());
  return !other.empty() && exists(other) ? other : std::string();
}

Result<std::string> FileLookup::find(const std::string& name) {
  if (name.empty() || name.size() > kMaxNameBytes || name.find('\0') != std::string::npos)
    return Error{"has an invalid name. Use a shorter one."};
  const std::vector<std::string> paths = candidates(mesh_, name);
  const auto found = std::find_if(paths.begin(), paths.end(), [this](const std::string& path) { return exists(path); });
  if (found != paths.end()) return *found;
  if (std::string other = find_misspelled(paths.front()); !other.empty()) {
    misspelled_.push_back(name);
    return other;
  }
  used_.try_emplace(paths.front(), 0);
  return Error{fmt::format("'{}' not found. Put it next to the mesh.", printable(name))};
}

Result<std::string> FileLookup::read(const std::string& name, std::string_view extension, std::size_t max_bytes) {
  // checked before the disk is accessed, so that other files are never read
  if (!has_name(name, extension))
    return Error{fmt::format("'{}' is not a {} file. Rename it.", printable(name), extension)};
  const Result<std::string> path = find(name);
  if (!path) return Error{path.error()};
  const std::string* const content = memory_files_ == nullptr ? nullptr : memory_files_->content(*path);
  Result<std::string> bytes = content == nullptr ? read_whole_file(*path, max_bytes) : *content;
  if (bytes && bytes->size() > max_bytes)
    bytes = Error{fmt::format("{}: has more than {} bytes. Shrink it.", printable(*path), max_bytes)};
  used_[*path] = bytes ? hash_bytes(*bytes) : 0;
  return bytes;
}

Result<std::shared_ptr<const Image>> FileLookup::image(const std::string& name) {
  if (!is_image_name(name))
    return Error{fmt::format("'{}' is neither a PNG nor a JPEG file. Convert it to PNG.", printable(name))};
  const Result<std::string> path = find(name);
  if (!path) return Error{path.error()};
  Result<std::shared_ptr<const Image>> image = images_.load(*path, memory_files_);
  used_[*path] = image ? (*image)->content_hash : 0;
  return image;
}

}  // namespace limber::model
