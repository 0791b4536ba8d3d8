// Sleeps until a file, a parameter or the end calls.
#include "app/scene_watch.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

namespace limber {

SceneWatch::SceneWatch(EngineLink& link, Engine& engine, FileWatch::Way way)
    : link_(link), engine_(engine), way_(way), wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  link_.rerun_scene = [this] {
    rerun_.store(true);
    wake();
  };
}

void SceneWatch::start() {
  thread_ = std::thread([this] { run(); });
}

void SceneWatch::stop() {
  stop_.store(true);
  wake();
  if (thread_.joinable()) thread_.join();
  link_.rerun_scene = nullptr;
  if (wake_ >= 0) close(std::exchange(wake_, -1));
}

void SceneWatch::wake() const {
  const std::uint64_t one = 1;
  if (wake_ >= 0 && write(wake_, &one, sizeof one) < 0) return;  // full: somebody is called already
}

void SceneWatch::run() {
  pthread_setname_np(pthread_self(), "limber-watch");
  FileWatch files(way_);
  files.watch(engine_.files(), FileWatch::Time::clock::now());
  while (!stop_.load()) {
    sleep(files);
    const bool saved = !files.poll(FileWatch::Time::clock::now()).empty();
    const bool rerun = rerun_.exchange(false);
    if (stop_.load() || !(saved || rerun)) continue;
    engine_.reload(!saved);
    files.watch(engine_.files(), FileWatch::Time::clock::now());
  }
}

void SceneWatch::sleep(const FileWatch& files) const {
  int wait = -1;
  if (const auto due = files.due()) {
    const auto now = FileWatch::Time::clock::now();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::max(*due, now) - now);
    wait = static_cast<int>(std::min<std::int64_t>(left.count(), 60000));
  }
  std::array<pollfd, 2> calls{{{wake_, POLLIN, 0}, {files.fd(), POLLIN, 0}}};
  ::poll(calls.data(), calls.size(), wait);
  std::uint64_t count = 0;
  if (calls[0].revents != 0 && read(wake_, &count, sizeof count) < 0) return;
}

}  // namespace limber
