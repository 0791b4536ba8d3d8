// SceneLock: of the programs that play one scene, the first owns what is kept of it from run to run. The system
// releases the lock, however the program ends. [one thread]
#pragma once

#include <string>
#include <utility>

#include "base/system/descriptor.h"

namespace limber {

class SceneLock {
 public:
  /// The scene's file with its full path, links resolved.
  static std::string path_of(const std::string& scene);
  /// A file name for what is kept of a scene, such as "arms-0123456789abcdef": the same for every path of its file.
  static std::string name_of(const std::string& scene);

  /// Without a file nothing is locked, and everybody owns it.
  SceneLock() = default;
  /// `file`: of this user's locks; its folder is made when it is not there.
  explicit SceneLock(std::string file) : file_(std::move(file)) {}
  SceneLock(SceneLock&&) = default;
  SceneLock& operator=(SceneLock&&) = delete;
  ~SceneLock() { release(); }

  /// Whether this program owns it: false as long as another one does. Where the system gives no locks, everybody owns
  /// it.
  bool take();
  void release();

 private:
  std::string file_;
  system::Descriptor lock_;
};

}  // namespace limber
