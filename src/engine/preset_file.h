// PresetFile: the presets of a scene on the disk, beside it. It is replaced whole or not at all, and what could not be
// read, or what somebody else has written, is set aside before. [one thread]
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "engine/preset_text.h"
#include "model/file_stamp.h"

namespace limber {

class PresetFile {
 public:
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28u;  ///< 256 MiB.

  /// "scripts/arms.presets.json" for "scripts/arms.lua".
  static std::string beside(const std::string& scene);

  explicit PresetFile(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }

  /// What it holds; a file that is not there holds nothing. The error names the file; it is then kept as it is, aside,
  /// when others are saved.
  Result<PresetsRead> load();
  /// Replaces it: written beside it, brought to the disk, renamed. The error names the reason, without the file; what
  /// was there is there still. `said`: where another version was set aside, else empty.
  Result<void> save(const PresetList& presets, std::string& said);

 private:
  Result<void> set_aside(std::string& said) const;

  std::string path_;
  FileStamp known_;      // as it was read or written last
  bool unread_ = false;  // it holds what was not understood
};

}  // namespace limber
