// Stage: a world, a host that remembers, and a folder of its own to run scenes in. For the tests of this room.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/log.h"
#include "script/scene.h"
#include "sim/world.h"

namespace limber {

/// What a scene asked of the outside.
struct RecordingHost : ScriptHost {
  struct Fault {
    std::string file;
    int line;
    std::string text;
  };

  void send(Message message) override { sent.push_back(std::move(message)); }
  void reply(const Origin& to, Message message) override { replies.emplace_back(to, std::move(message)); }
  void send_direct(const Origin& to, Message message) override { direct.emplace_back(to, std::move(message)); }
  void plan_osc(const OscPlan& p) override {
    plan = p;
    plans++;
  }
  void ask_reset() override { resets++; }
  void script_error(std::string_view file, int line, std::string_view text) override {
    faults.push_back({std::string(file), line, std::string(text)});
  }
  void print(std::string_view text) override { printed.emplace_back(text); }

  std::vector<Message> sent;
  std::vector<std::pair<Origin, Message>> replies, direct;
  OscPlan plan;
  int plans = 0;
  int resets = 0;
  std::vector<Fault> faults;
  std::vector<std::string> printed;
};

class Stage {
 public:
  /// On the room's one world, emptied: a world takes a while to make. `fresh`: on a world of its own.
  explicit Stage(SceneOptions options = {}, bool fresh = false)
      : own_(fresh ? std::make_unique<Ground>() : nullptr),
        store(ground().store),
        world(ground().world),
        scene(empty(world), host, std::move(options)) {
    static int count = 0;
    folder = std::filesystem::temp_directory_path() /
             ("limber_script_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(folder / "scripts" / "lib");
    log_to_stderr(false);
    seen_ = log_count(LogLevel::warning) + log_count(LogLevel::error) + log_count(LogLevel::info);
  }
  ~Stage() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
  }

  /// Runs the text as scripts/scene.lua: the error, or empty.
  std::string run(const std::string& text) {
    write("scripts/scene.lua", text);
    const Result<void> ran = scene.run((folder / "scripts" / "scene.lua").string());
    return ran ? "" : ran.error();
  }
  /// Runs, settles, starts; then so many ticks as the engine makes them.
  std::string play(const std::string& text, int ticks = 0) {
    std::string fault = run(text);
    if (!fault.empty()) return fault;
    world.settle();
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

  /// Texts of the log since the stage was made.
  std::vector<std::string> logged() const {
    std::vector<std::string> texts;
    for (const LogLine& line : log_since(seen_)) texts.push_back(line.text);
    return texts;
  }

 private:
  struct Ground {
    Store store;
    World world{store};
  };
  Ground& ground() {
    static Ground shared;
    return own_ != nullptr ? *own_ : shared;
  }
  static World& empty(World& world) {
    world.clear();
    world.restart_time();
    for (const Row& row : World::table().rows()) {
      if (row.writable()) (void)world.store().set(world.id(), row, std::span(row.initial.data(), row.width));
    }
    return world;
  }
  std::unique_ptr<Ground> own_;

 public:
  std::filesystem::path folder;
  Store& store;
  World& world;
  RecordingHost host;
  Scene scene;

 private:
  std::uint64_t seen_ = 0;
};

inline std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// What `print(expression)` writes in a scene of its own, or the first line of its error.
inline std::string value_of(const std::string& expression, const std::string& before = "") {
  Stage stage;
  const std::string fault = stage.run(before + "\nprint(" + expression + ")");
  if (!fault.empty()) return first_line(fault);
  return stage.host.printed.empty() ? "nothing printed" : stage.host.printed.back();
}

/// The first line of the error of a scene, or "no error".
inline std::string error_of(const std::string& text) {
  Stage stage;
  const std::string fault = stage.run(text);
  return fault.empty() ? "no error" : first_line(fault);
}

/// The first line of what goes wrong with it in on_start.
inline std::string callback_error_of(const std::string& before, const std::string& text) {
  Stage stage;
  const std::string fault = stage.play(before + " sim:on_start(function() " + text + " end)");
  if (!fault.empty()) return first_line(fault);
  return stage.host.faults.empty() ? "no error" : first_line(stage.host.faults.back().text);
}

}  // namespace limber
