// The lock is held to take what is wanted, never while it is written.
#include "engine/preset_keeper.h"

#include <utility>

#include "base/log.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/health.h"

namespace limber {

PresetKeeper::~PresetKeeper() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PresetKeeper::save(std::shared_ptr<const PresetList> presets) {
  {
    const std::scoped_lock lock(mutex_);
    wanted_.swap(presets);
    saved_.store(false);
  }
  changed_.notify_all();
  if (!thread_.joinable() && !system::start_thread(thread_, [this] { run(); }))
    failed_("the system has no thread left to write it; the next save tries again");
}

void PresetKeeper::finish() {
  if (!thread_.joinable()) {  // there was none to start
    end_ = true;
    run();
    end_ = false;
    return;
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return wanted_ == nullptr && !writing_; });
}

void PresetKeeper::run() {
  system::name_this_thread("limber-presets");
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return wanted_ != nullptr || end_; });
    if (wanted_ == nullptr) return;
    const std::shared_ptr<const PresetList> presets = std::exchange(wanted_, nullptr);
    writing_ = true;
    lock.unlock();
    std::string said;
    const Result<void> saved = file_.save(*presets, said);
    if (!said.empty()) log_warning("{}", said);
    if (!saved) {
      note_failed_write();
      log_error("{}: {}", printable(file_.path()), saved.error());
      failed_(saved.error());
    }
    lock.lock();
    writing_ = false;
    if (saved.ok() && wanted_ == nullptr) saved_.store(true);
    changed_.notify_all();
  }
}

}  // namespace limber
