// A scene in a temporary file and the engine that plays it, for tests: messages in, what goes out as text.
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

namespace limber::engine_test {

/// A file that goes when the test is over.
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

/// The seed of every scene here: nothing is sent, nothing is read but the file.
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
    outbox();
  }

  template <class... A>
  void send(std::string address, A&&... args) {
    link.inbox.push({{message(std::move(address), std::forward<A>(args)...)}, {Hand::osc, 0x7f000001, 4000}});
  }
  void ticks(int count) {
    for (int i = 0; i < count; i++) engine.tick();
  }
  double read(const std::string& path, std::size_t index = 0) {
    const Result<Place> place = find_place(engine.store(), path);
    if (!place || place->row == nullptr) {
      ADD_FAILURE() << path << " is no value";
      return 0;
    }
    double values[4] = {};
    engine.store().get(place->node, *place->row, values);
    return values[index];
  }
  /// What went out since the last call, as text.
  std::vector<std::string> outbox() {
    std::vector<Outgoing> out;
    link.outbox.drain(out);
    std::vector<std::string> texts;
    texts.reserve(out.size());
    for (const Outgoing& o : out) texts.push_back(text_of(o.message));
    return texts;
  }
};

/// Work of another thread that needs ticks to go on; their number is nobody's to say.
template <class Work>
void beside(Show& show, Work work) {
  std::atomic<bool> done{false};
  std::thread thread([&] {
    work();
    done.store(true);
  });
  while (!done.load()) show.ticks(1);
  thread.join();
}

/// Engine::play_take() beside the show, with no tick more than it needs: a take may be short.
inline Result<void> begin_take(Show& show, const std::string& take) {
  Result<void> played;
  std::atomic<bool> done{false};
  std::thread thread([&] {
    played = show.engine.play_take(take);
    done = true;
  });
  const bool another = show.read("/take/plays") != 0;
  while (!done && (another || show.read("/take/plays") == 0)) show.ticks(1);
  thread.join();
  return played;
}

}  // namespace limber::engine_test
