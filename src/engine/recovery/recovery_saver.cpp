// The mutex is locked only to swap the values out, never while writing.
#include "engine/recovery/recovery_saver.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/output/health.h"

namespace limber {

namespace {

constexpr int kOverdueIntervals = 6;  // intervals after which values are overdue

bool same(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->values == b->values && *a->schema == *b->schema;
}

}  // namespace

RecoverySaver::RecoverySaver(std::string folder, std::chrono::milliseconds interval)
    : folder_(std::move(folder)), interval_(interval) {}

RecoverySaver::~RecoverySaver() { stop(); }

Result<std::optional<RecoverableValues>> RecoverySaver::open(const std::string& scene) {
  scene_ = scene;
  Result<std::unique_ptr<RecoveryFile>> file = RecoveryFile::open(folder_, scene);
  if (!file) return Error{"values can't be saved for recovery: " + file.error()};
  file_ = std::move(*file);
  owned_elsewhere_ = file_ == nullptr;
  if (owned_elsewhere_) return std::optional<RecoverableValues>();
  return file_->recoverable();
}

void RecoverySaver::begin() {
  if (!thread_.joinable() && !system::start_thread(thread_, [this] { run(); }))
    log_warning("values can't be saved for recovery: could not create a thread");
}

void RecoverySaver::submit(const std::string& scene, std::shared_ptr<const Preset> now,
                           std::shared_ptr<const Preset> script) {
  wants_values_.store(false, std::memory_order_relaxed);
  overdue_.store(false, std::memory_order_relaxed);
  if (now == nullptr) return;
  Values values{scene, std::move(now), std::move(script)};
  std::optional<Values> replaced(std::move(values));
  {
    const std::scoped_lock lock(mutex_);
    submitted_.swap(replaced);
  }
  changed_.notify_all();
}

void RecoverySaver::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RecoverySaver::end() {
  stop();
  if (file_ != nullptr) file_->end(recovered_);
  file_ = nullptr;
}

void RecoverySaver::run() {
  system::name_this_thread("limber-recover");
  using Clock = std::chrono::steady_clock;
  Clock::time_point next = Clock::now() + interval_;
  int intervals = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    const bool submitted = changed_.wait_until(lock, next, [this] { return stopping_ || submitted_.has_value(); });
    if (stopping_) return;
    if (!submitted) {
      next = std::max(next + interval_, Clock::now());
      intervals = wants_values_.exchange(true) ? intervals + 1 : 0;
      overdue_.store(intervals >= kOverdueIntervals);
      if (!unsaved_) continue;
    }
    const Values values = submitted ? *std::exchange(submitted_, std::nullopt) : *unsaved_;
    lock.unlock();
    write(values);
    lock.lock();
  }
}

void RecoverySaver::write(const Values& submitted) {
  if (submitted.scene != scene_) switch_scene(submitted.scene);
  if (owned_elsewhere_) try_take_over();
  unsaved_ = owned_elsewhere_ ? std::optional(submitted) : std::nullopt;
  if (file_ == nullptr) return;
  std::shared_ptr<const Preset> values = changed_values(*submitted.now, *submitted.script);
  if (same(values, saved_)) return;
  const Result<void> saved = file_->save(values, std::time(nullptr));
  if (saved) {
    saved_ = std::move(values);
  } else {
    count_failed_write();
    if (!std::exchange(failure_reported_, true)) log_warning("values can't be saved for recovery: {}", saved.error());
  }
}

void RecoverySaver::try_take_over() {
  const Result<std::optional<RecoverableValues>> recoverable = open(scene_);
  if (owned_elsewhere_) return;
  log_info(
      "the other program that played this scene has ended: this one saves presets and recovery values from now on");
  if (!recoverable) {
    log_warning("{}", recoverable.error());
  } else if (*recoverable) {
    log_warning("{}", (*recoverable)->message());
  }
}

// Switches to another scene; the run of the previous one has ended cleanly.
void RecoverySaver::switch_scene(const std::string& scene) {
  if (file_ != nullptr) file_->end(recovered_);
  file_ = nullptr;
  saved_ = nullptr;
  recovered_ = false;
  const Result<std::optional<RecoverableValues>> recoverable = open(scene);
  if (owned_elsewhere_) {
    log_warning("{}: {}", printable(scene), kOwnedElsewhere);
  } else if (!recoverable) {
    log_warning("{}", recoverable.error());
  } else if (*recoverable) {
    log_warning("{}: {}", printable(scene), (*recoverable)->message());
  }
}

}  // namespace limber
