// A scene in a temporary file and the engine that plays it, for tests: messages in, output as text.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "base/text.h"
#include "engine/engine.h"
#include "engine/rig.h"

namespace limber::engine::test {

/// A file that is removed at the end of the test.
class SceneFile {
 public:
  explicit SceneFile(const std::string& text) {
    static std::atomic<int> count{0};
    folder_ = std::filesystem::path(::testing::TempDir()) /
              fmt::format("limber_engine_{}_{}", ::getpid(), count.fetch_add(1));
    std::filesystem::create_directories(folder_);
    write(text);
  }
  ~SceneFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  void write(const std::string& text) const { std::ofstream(path()) << text; }
  std::string path() const { return (folder_ / "scene.lua").string(); }

 private:
  std::filesystem::path folder_;
};

/// The options of every scene here: a fixed random seed, no package paths.
inline EngineOptions fast_options(const std::string& scene = "") {
  EngineOptions options;
  options.scene = scene;
  options.fast = true;
  return options;
}

inline std::string text_of(const Message& m) {
  std::string text = m.address;
  for (const Arg& a : m.args) text += " " + (a.is_text() ? a.text : number_text(a.number));
  return text;
}

/// An engine that has started, with its link.
struct Show {
  EngineLink link;
  Engine engine;

  explicit Show(const std::string& scene = "") : Show(fast_options(scene)) {}
  explicit Show(EngineOptions options) : engine(link, std::move(options)) {
    const Result<void> started = engine.start();
    EXPECT_TRUE(started.ok()) << started.error();
    sent_texts();
  }

  template <class... A>
  void send(std::string address, A&&... args) {
    link.command_queue.push(
        {{message(std::move(address), std::forward<A>(args)...)}, {CommandSource::osc, 0x7f000001, 4000}});
  }
  void ticks(int count) {
    for (int i = 0; i < count; i++) engine.tick();
  }
  double read(const std::string& path, std::size_t index = 0) {
    const Result<PropertyRef> ref = find_property(engine.store(), path);
    if (!ref || ref->property == nullptr) {
      ADD_FAILURE() << path << " is not a property";
      return 0;
    }
    double values[4] = {};
    engine.store().get(ref->node, *ref->property, values);
    return values[index];
  }
  /// Returns the messages sent since the last call, as text.
  std::vector<std::string> sent_texts() {
    std::vector<Outgoing> out;
    link.output_queue.drain(out);
    std::vector<std::string> texts;
    texts.reserve(out.size());
    for (const Outgoing& o : out) texts.push_back(text_of(o.message));
    return texts;
  }
};

/// Runs work on another thread while this one ticks, as often as the work needs.
template <class Work>
void run_while_ticking(Show& show, Work work) {
  std::atomic<bool> done{false};
  std::thread thread([&] {
    work();
    done.store(true);
  });
  while (!done.load()) show.ticks(1);
  thread.join();
}

/// Calls Engine::play_take() on another thread, with no more ticks than it needs, because a take may be short.
inline Result<void> play_take(Show& show, const std::string& take) {
  Result<void> played;
  std::atomic<bool> done{false};
  std::thread thread([&] {
    played = show.engine.play_take(take);
    done = true;
  });
  const bool was_playing = show.read("/take/plays") != 0;
  while (!done && (was_playing || show.read("/take/plays") == 0)) show.ticks(1);
  thread.join();
  return played;
}

}  // namespace limber::engine::test
