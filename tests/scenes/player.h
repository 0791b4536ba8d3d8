// Plays a scene without waiting, for the tests of scenes: messages in, output, values of properties.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/log/log.h"
#include "engine/engine.h"
#include "properties/catalog.h"
#include "support/world_objects.h"

namespace limber {

/// Plays a scene of scripts/, or a file given by its absolute path.
struct Player {
  explicit Player(const std::string& scene, std::optional<std::uint64_t> seed = {}) : started(begin(scene, seed)) {
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error());
  }
  struct MayFail {};
  Player(const std::string& scene, MayFail) : started(begin(scene)) {}
  ~Player() { log_to_stderr(true); }

  void play(double seconds) {
    const double end = engine->world().time() + seconds - 1e-9;
    while (engine->world().time() < end) engine->tick();
  }
  sim::World& world() const { return engine->world(); }
  sim::Body& body(const std::string& name) const { return *world().find_body(name); }

  void send(const std::string& address, std::vector<Arg> args) {
    link.command_queue.push({{{address, std::move(args)}}, {}});
  }
  double value(const std::string& path, std::size_t index = 0) const {
    const Result<PropertyRef> place = find_property(engine->store(), path);
    if (!place || place->property == nullptr) {
      ADD_FAILURE() << path << " is not a property";
      return 0;
    }
    double values[4] = {};
    engine->store().get(place->node, *place->property, values);
    return values[index];
  }
  /// Returns the messages sent since the last call.
  std::vector<Message> sent() {
    std::vector<engine::Outgoing> out;
    link.output_queue.drain(out);
    std::vector<Message> messages;
    messages.reserve(out.size());
    for (engine::Outgoing& each : out) messages.push_back(std::move(each.message));
    return messages;
  }

  engine::EngineLink link;
  std::unique_ptr<engine::Engine> engine;
  Result<void> started;

 private:
  Result<void> begin(const std::string& scene, std::optional<std::uint64_t> seed = {}) {
    log_to_stderr(false);
    engine::EngineOptions options;
    options.scene = scene.starts_with('/') ? scene : std::string(LIMBER_SOURCE_DIR) + "/scripts/" + scene;
    options.scene_options.data_dir = LIMBER_SOURCE_DIR;
    options.scene_options.seed = seed;
    options.fast = true;
    options.print = false;
    engine = std::make_unique<engine::Engine>(link, options);
    return engine->start();
  }
};

/// A folder with files that is removed at the end of the test.
class ShowFolder {
 public:
  ShowFolder() {
    static int count = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("limber_scenes_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(folder_ / "scripts");
  }
  ~ShowFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ShowFolder(const ShowFolder&) = delete;
  ShowFolder& operator=(const ShowFolder&) = delete;

  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace limber
