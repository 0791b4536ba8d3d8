// SceneLock: ensures that of several programs that play the same scene only the first one writes the scene's persistent
// files (presets, recovery). The operating system releases the lock even after a crash. [one thread]
#pragma once

#include <string>
#include <utility>

#include "base/system/descriptor.h"

namespace limber::engine {

class SceneLock {
 public:
  /// Returns the absolute path of the scene's file, with links resolved.
  static std::string path_of(const std::string& scene);
  /// Returns a base name for persistent files of a scene, such as "arms-0123456789abcdef": the same for all paths that
  /// lead to the scene's file.
  static std::string name_of(const std::string& scene);

  /// Locks nothing: acquire() always succeeds.
  SceneLock() = default;
  /// `file`: lock file, of this user; its folder is created if necessary.
  explicit SceneLock(std::string file) : file_(std::move(file)) {}
  SceneLock(SceneLock&&) = default;
  SceneLock& operator=(SceneLock&&) = delete;
  ~SceneLock() { release(); }

  /// Tries to acquire the lock. False while another program has it. Also true if the system can't lock files.
  bool acquire();
  void release();

 private:
  std::string file_;
  system::Descriptor lock_;
};

}  // namespace limber::engine
