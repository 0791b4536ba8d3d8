// PresetFile: the presets of a scene on the disk, beside it. It is replaced whole or not at all, and what could not be
// read, or what somebody else has written, is set aside before. [one thread]
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "engine/preset_text.h"
#include "engine/scene_lock.h"
#include "model/file_stamp.h"

namespace limber {

class PresetFile {
 public:
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28u;  ///< 256 MiB.

  /// "scripts/arms.presets.json" for "scripts/arms.lua".
  static std::string beside(const std::string& scene);

  /// Who may write it. `show`: links are followed within that folder; empty: the file's own.
  struct Owner {
    std::string show;
    std::string lock;    ///< The file of a SceneLock; empty: none.
    bool stays = false;  ///< From load() on, else during a save.
  };

  /// The owner of a scene's presets. `locks`: the folder for locks; empty: none.
  static Owner owner_of(const std::string& scene, const std::string& locks, bool stays);

  explicit PresetFile(std::string path) : PresetFile(std::move(path), Owner()) {}
  PresetFile(std::string path, Owner owner)
      : path_(std::move(path)), show_(std::move(owner.show)), lock_(std::move(owner.lock)), stays_(owner.stays) {}
  const std::string& path() const { return path_; }

  /// What it holds; a file that is not there holds nothing. The error names the file; it is then kept as it is, aside,
  /// when others are saved.
  Result<PresetsRead> load();
  /// Replaces it: written beside it, brought to the disk, renamed. The error names the reason, without the file; what
  /// was there is there still. Nothing is written while another program owns it, through a link that leads out of the
  /// show's folder, or over what is no file of presets behind a link. `said`: where another version was set aside, else
  /// empty.
  Result<void> save(const PresetList& presets, std::string& said);

 private:
  Result<std::string> target() const;
  Result<void> set_aside(const std::string& path, std::string& said) const;
  Result<void> write(const PresetList& presets, std::string& said);

  std::string path_;
  std::string show_;
  SceneLock lock_;
  bool stays_ = false;
  FileStamp known_;      // as it was read or written last
  bool unread_ = false;  // it holds what was not understood
};

}  // namespace limber
