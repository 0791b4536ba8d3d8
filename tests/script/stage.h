// ScriptFixture: a world, a host that records requests, and a temporary folder, for running scenes in tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/log/log.h"
#include "script/scene/scene.h"
#include "support/world_objects.h"

namespace limber::script {

/// Records the requests of a scene to its host.
struct RecordingHost : ScriptHost {
  struct Fault {
    std::string file;
    int line;
    std::string text;
  };

  void send(Message message) override { sent.push_back(std::move(message)); }
  void reply(const CommandOrigin& to, Message message) override { replies.emplace_back(to, std::move(message)); }
  void send_direct(const CommandOrigin& to, Message message) override { direct.emplace_back(to, std::move(message)); }
  void configure_osc(const OscConfig& p) override {
    plan = p;
    plan_count++;
  }
  void request_reset() override { resets++; }
  void script_error(std::string_view file, int line, std::string_view text) override {
    faults.push_back({std::string(file), line, std::string(text)});
  }
  void print(std::string_view text) override { printed.emplace_back(text); }

  std::vector<Message> sent;
  std::vector<std::pair<CommandOrigin, Message>> replies, direct;
  OscConfig plan;
  int plan_count = 0;
  int resets = 0;
  std::vector<Fault> faults;
  std::vector<std::string> printed;
};

class ScriptFixture {
 public:
  /// Uses the tests' shared world after clearing it, because creating a world is slow. `fresh`: creates a new one.
  explicit ScriptFixture(SceneOptions options = {}, bool fresh = false)
      : own_world_(fresh ? std::make_unique<SharedWorld>() : nullptr),
        store(shared_world().store),
        world(shared_world().world),
        scene(clear_world(world), host, std::move(options)) {
    static int count = 0;
    folder = std::filesystem::temp_directory_path() /
             ("limber_script_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(folder / "scripts" / "lib");
    log_to_stderr(false);
    seen_ = log_count(LogLevel::warning) + log_count(LogLevel::error) + log_count(LogLevel::info);
  }
  ~ScriptFixture() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
  }

  /// Runs the text as scripts/scene.lua. Returns the error, or an empty text.
  std::string run(const std::string& text) {
    write("scripts/scene.lua", text);
    const Result<void> result = scene.run((folder / "scripts" / "scene.lua").string());
    return result ? "" : result.error();
  }
  /// Runs the text, flushes the world, calls on_start; then ticks as the engine does.
  std::string play(const std::string& text, int ticks = 0) {
    std::string fault = run(text);
    if (!fault.empty()) return fault;
    world.flush();
    scene.start();
    tick(ticks);
    return "";
  }
  void tick(int count = 1) {
    for (int i = 0; i < count; i++) {
      scene.tick(world.timestep());
      world.step();
      scene.collect_garbage();
    }
  }

  /// Returns the log lines since the fixture was created.
  std::vector<std::string> logged() const {
    std::vector<std::string> texts;
    for (const LogLine& line : log_since(seen_)) texts.push_back(line.text);
    return texts;
  }

 private:
  struct SharedWorld {
    Store store;
    sim::World world{store};
  };
  SharedWorld& shared_world() {
    static SharedWorld shared;
    return own_world_ != nullptr ? *own_world_ : shared;
  }
  static sim::World& clear_world(sim::World& world) {
    world.clear();
    world.restart_time();
    for (const Property& property : sim::World::table().properties()) {
      if (property.writable())
        (void)world.store().set(world.id(), property, std::span(property.initial.data(), property.width));
    }
    return world;
  }
  std::unique_ptr<SharedWorld> own_world_;

 public:
  std::filesystem::path folder;
  Store& store;
  sim::World& world;
  RecordingHost host;
  Scene scene;

 private:
  std::uint64_t seen_ = 0;
};

inline std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Returns the output of `print(expression)` in a new scene, or the first line of its error.
inline std::string value_of(const std::string& expression, const std::string& before = "") {
  ScriptFixture fixture;
  const std::string fault = fixture.run(before + "\nprint(" + expression + ")");
  if (!fault.empty()) return first_line(fault);
  return fixture.host.printed.empty() ? "nothing printed" : fixture.host.printed.back();
}

/// Returns the first line of the error of a scene, or "no error".
inline std::string error_of(const std::string& text) {
  ScriptFixture fixture;
  const std::string fault = fixture.run(text);
  return fault.empty() ? "no error" : first_line(fault);
}

/// Returns the first line of the error of a text that runs in on_start.
inline std::string callback_error_of(const std::string& before, const std::string& text) {
  ScriptFixture fixture;
  const std::string fault = fixture.play(before + " sim:on_start(function() " + text + " end)");
  if (!fault.empty()) return first_line(fault);
  return fixture.host.faults.empty() ? "no error" : first_line(fixture.host.faults.back().text);
}

}  // namespace limber::script
