// Sources: the files that a run of a scene reads (search results, scripts, models, meshes, policies), stored so that
// the scene can run again without the disk and the files can be watched for changes. [any]
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/mocap/bvh.h"
#include "model/model_library.h"
#include "model/policy/policy_file.h"
#include "script/scene/script_files.h"

namespace limber::script {

/// A file that a run depends on, or a path where it searched for a file and found none.
struct SourceFile {
  std::string path;
  std::optional<std::uint64_t> content;  ///< hash_bytes of the contents, if known.
};

/// All data that a run has read, sufficient to run it again after the files have changed.
struct SourcesRead {
  std::map<std::string, std::string> found;   ///< Search requests and the resulting paths.
  std::map<std::string, std::string> texts;   ///< Script texts by path.
  std::map<std::string, std::string> meshes;  ///< As FileSet::found.
  std::vector<std::string> files;             ///< Models, meshes, images, motions and policies.
};

class Sources {
 public:
  /// `earlier`: an earlier run; its data are reused instead of reading the disk.
  explicit Sources(std::shared_ptr<const Sources> earlier = nullptr) : earlier_(std::move(earlier)) {}

  /// Sources whose script at this path has this text; all other files are read from the disk.
  static std::shared_ptr<const Sources> of_text(const std::string& path, std::string text);

  /// Sources of an archived run: files that it has not read are reported as missing, whatever is on the disk.
  /// `library`: models created from these files before; runs that share it share models, as runs from the disk do.
  Sources(std::map<std::string, std::string> found, const std::shared_ptr<const model::FileSet>& files,
          std::shared_ptr<model::ModelLibrary> library);

  /// Same as in ScriptFiles.
  Result<std::string> find(const ScriptFiles& files, std::string_view name);
  Result<std::string> find_lib(const ScriptFiles& files, std::string_view name);
  Result<std::string> find_behavior_lib(const ScriptFiles& files, std::string_view name, const std::string& behavior);
  /// Returns an empty string if there is none.
  std::string find_behavior(const ScriptFiles& files, std::string_view type);
  /// Returns a script's text.
  Result<std::string> text(const std::string& path);
  /// Returns the text that runs after the scene's file (SceneOptions::added): that of the archived run, else `given`.
  std::string added_text(const std::string& given);
  /// The text that added_text() has returned.
  const std::string& added() const { return added_; }
  Result<std::shared_ptr<const model::BodyModel>> model(const std::string& path, const model::ImportOptions& options);
  Result<std::shared_ptr<const model::MeshModel>> mesh(const std::string& path, const Vec3& scale,
                                                       bool concave = false);
  Result<std::shared_ptr<const model::Image>> image(const std::string& path);
  /// Returns the motion of a BVH file.
  Result<std::shared_ptr<const model::BvhClip>> clip(const std::string& path);
  /// Returns the network of a policy's file.
  Result<std::shared_ptr<const model::PolicyNetwork>> policy(const std::string& path);

  /// Ends the run: drops the reference to the earlier run.
  void close() { earlier_ = nullptr; }
  /// All files that were read, and the paths that were searched without success.
  std::vector<SourceFile> files() const;
  SourcesRead read() const;

 private:
  template <class T>
  using ParsedFiles = std::map<std::string, std::shared_ptr<const T>>;  // by path
  template <class T, class Parse>
  Result<std::shared_ptr<const T>> parsed(ParsedFiles<T> Sources::*list, const std::string& path, Parse parse);
  template <class T>
  const T* find_known(std::map<std::string, T> Sources::*list, const std::string& key) const;

  bool from_archive() const { return earlier_ != nullptr && earlier_->library_ != nullptr; }
  template <class Find>
  Result<std::string> look_up(const std::string& key, Find find);

  std::shared_ptr<const Sources> earlier_;
  std::shared_ptr<const model::FileSet> archived_files_;
  std::shared_ptr<model::ModelLibrary> library_;  // of the archived files
  std::map<std::string, std::string> found_;
  std::map<std::string, std::string> texts_;
  std::string added_;
  std::map<std::string, std::uint64_t> contents_;  // hashes of all files read, by path; 0: unknown
  std::map<std::string, std::shared_ptr<const model::BodyModel>> models_;
  std::map<std::string, std::shared_ptr<const model::MeshModel>> meshes_;
  std::map<std::string, std::shared_ptr<const model::Image>> images_;
  ParsedFiles<model::BvhClip> clips_;
  ParsedFiles<model::PolicyNetwork> policies_;
  std::vector<std::string> tried_;
};

}  // namespace limber::script
