// Periodic requests, and the file of each scene.
#include "engine/recovery/recovery_saver.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/output/health.h"

namespace limber::engine {

namespace {

constexpr int kOverdueRequests = 6;  // unanswered requests after which values are overdue

bool same(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->values == b->values && *a->schema == *b->schema;
}

}  // namespace

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
  next_ = BackgroundWriter::Clock::now() + interval_;
  writer_.add(*this);
  if (!writer_.request(*this, next_)) log_warning("values can't be saved for recovery: could not create a thread");
}

void RecoverySaver::submit(const std::string& scene, std::shared_ptr<const Preset> now,
                           std::shared_ptr<const Preset> script) {
  wants_values_.store(false, std::memory_order_relaxed);
  overdue_.store(false, std::memory_order_relaxed);
  if (now == nullptr) return;
  std::optional<Values> replaced(Values{scene, std::move(now), std::move(script)});
  {
    const std::scoped_lock lock(mutex_);
    submitted_.swap(replaced);
  }
  (void)writer_.request(*this);
}

void RecoverySaver::end() {
  writer_.remove(*this);
  if (file_ != nullptr) file_->end(recovered_);
  file_ = nullptr;
}

BackgroundWriter::Clock::time_point RecoverySaver::run() {
  std::optional<Values> values;
  {
    const std::scoped_lock lock(mutex_);
    values.swap(submitted_);
  }
  const auto now = BackgroundWriter::Clock::now();
  if (!values && now >= next_) {
    next_ = std::max(next_ + interval_, now);
    unanswered_requests_ = wants_values_.exchange(true) ? unanswered_requests_ + 1 : 0;
    overdue_.store(unanswered_requests_ >= kOverdueRequests);
    values = unsaved_;
  }
  if (values) write(*values);
  return next_;
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

}  // namespace limber::engine
