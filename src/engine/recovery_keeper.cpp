// The lock is held to take what was given, never while it is written.
#include "engine/recovery_keeper.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/log.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/health.h"

namespace limber {

namespace {

constexpr int kPatience = 6;  // times that it asks before it urges

bool same(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->values == b->values && *a->shape == *b->shape;
}

}  // namespace

RecoveryKeeper::RecoveryKeeper(std::string folder, std::chrono::milliseconds every)
    : folder_(std::move(folder)), every_(every) {}

RecoveryKeeper::~RecoveryKeeper() { stop(); }

Result<std::optional<LostValues>> RecoveryKeeper::open(const std::string& scene) {
  scene_ = scene;
  Result<std::unique_ptr<RecoveryFile>> file = RecoveryFile::open(folder_, scene);
  if (!file) return Error{"the show's values can't be kept for a start after a crash: " + file.error()};
  file_ = std::move(*file);
  elsewhere_ = file_ == nullptr;
  if (elsewhere_) return std::optional<LostValues>();
  return file_->lost();
}

void RecoveryKeeper::begin() {
  if (!thread_.joinable() && !system::start_thread(thread_, [this] { run(); }))
    log_warning("the show's values can't be kept for a start after a crash: the system has no thread left");
}

void RecoveryKeeper::give(const std::string& scene, std::shared_ptr<const Preset> now,
                          std::shared_ptr<const Preset> script) {
  asks_.store(false, std::memory_order_relaxed);
  urges_.store(false, std::memory_order_relaxed);
  if (now == nullptr) return;
  Given given{scene, std::move(now), std::move(script)};
  std::optional<Given> before(std::move(given));
  {
    const std::scoped_lock lock(mutex_);
    given_.swap(before);
  }
  changed_.notify_all();
}

void RecoveryKeeper::stop() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RecoveryKeeper::end() {
  stop();
  if (file_ != nullptr) file_->end(brought_back_);
  file_ = nullptr;
}

void RecoveryKeeper::run() {
  system::name_this_thread("limber-recover");
  using Clock = std::chrono::steady_clock;
  Clock::time_point next = Clock::now() + every_;
  int asked = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    const bool called = changed_.wait_until(lock, next, [this] { return end_ || given_.has_value(); });
    if (end_) return;
    if (!called) {
      next = std::max(next + every_, Clock::now());
      asked = asks_.exchange(true) ? asked + 1 : 0;
      urges_.store(asked >= kPatience);
      if (!unsaved_) continue;
    }
    const Given given = called ? *std::exchange(given_, std::nullopt) : *unsaved_;
    lock.unlock();
    write(given);
    lock.lock();
  }
}

void RecoveryKeeper::write(const Given& given) {
  if (given.scene != scene_) follow(given.scene);
  if (elsewhere_) take_over();
  unsaved_ = elsewhere_ ? std::optional(given) : std::nullopt;
  if (file_ == nullptr) return;
  std::shared_ptr<const Preset> values = changed_values(*given.now, *given.script);
  if (same(values, saved_)) return;
  const Result<void> saved = file_->save(values, std::time(nullptr));
  if (saved) {
    saved_ = std::move(values);
  } else {
    note_failed_write();
    if (!std::exchange(told_, true))
      log_warning("the show's values can't be kept for a start after a crash: {}", saved.error());
  }
}

void RecoveryKeeper::take_over() {
  const Result<std::optional<LostValues>> lost = open(scene_);
  if (elsewhere_) return;
  log_info("the other program that played this scene has ended: from here on this one saves presets and values");
  if (!lost) {
    log_warning("{}", lost.error());
  } else if (*lost) {
    log_warning("{}", (*lost)->offer());
  }
}

// another scene plays: the one before has ended well
void RecoveryKeeper::follow(const std::string& scene) {
  if (file_ != nullptr) file_->end(brought_back_);
  file_ = nullptr;
  saved_ = nullptr;
  brought_back_ = false;
  const Result<std::optional<LostValues>> lost = open(scene);
  if (elsewhere_) {
    log_warning("{}: {}", printable(scene), kElsewhere);
  } else if (!lost) {
    log_warning("{}", lost.error());
  } else if (*lost) {
    log_warning("{}: {}", printable(scene), (*lost)->offer());
  }
}

}  // namespace limber
