// Sources: what a run of a scene reads (where files are, scripts' texts, models, meshes), kept so that the scene can be
// run again without the disk, and so that somebody can watch the files. [any]
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/model_library.h"
#include "script/files.h"

namespace limber {

/// A file that a run depends on. It may not exist: a place where one was looked for.
struct SourceFile {
  std::string path;
  std::optional<std::uint64_t> content;  ///< hash_bytes of what was read, where that is known.
};

/// Everything that a run has read: enough to run it again where the disk holds something else by now.
struct SourcesRead {
  std::map<std::string, std::string> found;   ///< What was looked for, and the path that it led to.
  std::map<std::string, std::string> texts;   ///< Of scripts, by path.
  std::map<std::string, std::string> meshes;  ///< As FileSet::found.
  std::vector<std::string> files;             ///< Models and meshes that were read.
};

class Sources {
 public:
  /// `again`: what an earlier run has read is taken from there, not from the disk.
  explicit Sources(std::shared_ptr<const Sources> again = nullptr) : again_(std::move(again)) {}

  /// An earlier run's that was kept: all that it has not read is not there, whatever the disk holds.
  /// `library`: the models that were made of those files before; runs that share it have one model where they load the
  /// same, as runs from the disk do.
  Sources(std::map<std::string, std::string> found, const std::shared_ptr<const FileSet>& files,
          std::shared_ptr<ModelLibrary> library);

  /// As ScriptFiles finds them.
  Result<std::string> find(const ScriptFiles& files, std::string_view name);
  Result<std::string> find_lib(const ScriptFiles& files, std::string_view name);
  Result<std::string> find_behavior_lib(const ScriptFiles& files, std::string_view name, const std::string& behavior);
  /// Empty: there is none.
  std::string find_behavior(const ScriptFiles& files, std::string_view type);
  /// A script's text.
  Result<std::string> text(const std::string& path);
  Result<std::shared_ptr<const BodyModel>> model(const std::string& path, const ImportOptions& options);
  Result<std::shared_ptr<const MeshModel>> mesh(const std::string& path, const Vec3& scale);

  /// The run is over: what it did not read of the earlier run's is let go.
  void close() { again_ = nullptr; }
  /// All files that were read, or looked for in vain.
  std::vector<SourceFile> files() const;
  SourcesRead read() const;

 private:
  template <class T>
  const T* known(std::map<std::string, T> Sources::*list, const std::string& key) const;

  bool kept() const { return again_ != nullptr && again_->library_ != nullptr; }
  template <class Find>
  Result<std::string> look_up(const std::string& key, Find find);

  std::shared_ptr<const Sources> again_;
  std::shared_ptr<const FileSet> kept_files_;
  std::shared_ptr<ModelLibrary> library_;  // of those files
  std::map<std::string, std::string> found_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::uint64_t> contents_;  // of all that was read, by path; 0: not known
  std::map<std::string, std::shared_ptr<const BodyModel>> models_;
  std::map<std::string, std::shared_ptr<const MeshModel>> meshes_;
  std::vector<std::string> passed_;
};

}  // namespace limber
