// A show in a folder of its own that is edited while it plays; save() has the effect of saving the scene file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/log/log.h"
#include "engine/show.h"
#include "support/world_objects.h"

namespace limber::engine::test {

/// A folder with scripts/ that is removed at the end of the test.
class ShowFolder {
 public:
  ShowFolder() {
    static std::atomic<int> count{0};
    folder_ =
        std::filesystem::path(::testing::TempDir()) / fmt::format("limber_show_{}_{}", ::getpid(), count.fetch_add(1));
    std::filesystem::create_directories(folder_ / "scripts" / "lib");
  }
  ~ShowFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ShowFolder(const ShowFolder&) = delete;
  ShowFolder& operator=(const ShowFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void remove(const std::string& name) const { std::filesystem::remove(folder_ / name); }

 private:
  std::filesystem::path folder_;
};

struct EditedShow {
  ShowFolder folder;
  std::string text;
  std::optional<Show> playing;

  explicit EditedShow(std::string scene) : EditedShow(std::move(scene), {}) {}
  /// `files`: name and text, written before the scene is run.
  EditedShow(std::string scene, const std::vector<std::pair<std::string, std::string>>& files)
      : text(std::move(scene)) {
    log_to_stderr(false);
    for (const auto& [name, file_text] : files) folder.write(name, file_text);
    folder.write("scripts/scene.lua", text);
    playing.emplace(folder.path("scripts/scene.lua"));
  }

  Show& show() { return *playing; }
  sim::World& world() { return show().engine.world(); }
  sim::Body& body(const std::string& name) { return *world().find_body(name); }
  sim::Part& part(const std::string& body_name, const std::string& name) { return *body(body_name).find_part(name); }

  SceneReloader::ApplyResult save(const std::string& scene) {
    text = scene;
    folder.write("scripts/scene.lua", text);
    return show().engine.reload_now();
  }
  /// Saves the scene with one piece of its text replaced.
  SceneReloader::ApplyResult edit(const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) ADD_FAILURE() << "'" << from << "' is not in the scene";
    std::string edited = text;
    return save(edited.replace(at, from.size(), to));
  }
};

/// Pose and velocity of a part, as bits.
inline std::vector<double> motion_of(const sim::Part& part) {
  const sim::Part::Motion s = part.capture_motion();
  std::vector<double> all;
  for (int i = 0; i < 3; i++) {
    for (const double v : {s.pose.position[i], s.linear_velocity[i], s.angular_velocity[i]}) all.push_back(v);
  }
  for (const double v : {s.pose.rotation.x, s.pose.rotation.y, s.pose.rotation.z, s.pose.rotation.w}) all.push_back(v);
  return all;
}

}  // namespace limber::engine::test
