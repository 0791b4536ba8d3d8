// The mutex is locked only to swap the presets out, never while writing.
#include "engine/presets/saver.h"

#include <utility>

#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/output/health.h"

namespace limber {

PresetSaver::~PresetSaver() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PresetSaver::save(std::shared_ptr<const PresetList> presets) {
  {
    const std::scoped_lock lock(mutex_);
    pending_.swap(presets);
    saved_.store(false);
  }
  changed_.notify_all();
  if (!thread_.joinable() && !system::start_thread(thread_, [this] { run(); }))
    on_failure_("could not create a thread to save presets; the next save tries again");
}

void PresetSaver::finish() {
  if (!thread_.joinable()) {  // no thread could be started
    stopping_ = true;
    run();
    stopping_ = false;
    return;
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return pending_ == nullptr && !writing_; });
}

void PresetSaver::run() {
  system::name_this_thread("limber-presets");
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return pending_ != nullptr || stopping_; });
    if (pending_ == nullptr) return;
    const std::shared_ptr<const PresetList> presets = std::exchange(pending_, nullptr);
    writing_ = true;
    lock.unlock();
    std::string notice;
    const Result<void> saved = file_.save(*presets, notice);
    if (!notice.empty()) log_warning("{}", notice);
    if (!saved) {
      count_failed_write();
      log_error("{}: {}", printable(file_.path()), saved.error());
      on_failure_(saved.error());
    }
    lock.lock();
    writing_ = false;
    if (saved.ok() && pending_ == nullptr) saved_.store(true);
    changed_.notify_all();
  }
}

}  // namespace limber
