// The loop of the writer's thread.
#include "engine/background_writer.h"

#include <algorithm>
#include <utility>

#include "base/system/signals.h"
#include "base/system/thread.h"

namespace limber::engine {

BackgroundWriter::~BackgroundWriter() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWriter::add(Task& task) {
  const std::scoped_lock lock(mutex_);
  entries_.push_back({&task, kNever});
}

BackgroundWriter::Entry* BackgroundWriter::find(const Task& task) {
  const auto entry = std::ranges::find(entries_, &task, &Entry::task);
  return entry == entries_.end() ? nullptr : &*entry;
}

bool BackgroundWriter::request(Task& task, Clock::time_point time) {
  {
    const std::scoped_lock lock(mutex_);
    Entry* const entry = find(task);
    if (entry == nullptr) return true;
    const bool earlier = time < entry->due;
    if (earlier) entry->due = time;
    if (!thread_.joinable() && !system::start_thread(thread_, [this] { run(); })) return false;
    if (!earlier) return true;
  }
  changed_.notify_all();
  return true;
}

void BackgroundWriter::finish(Task& task) {
  std::unique_lock lock(mutex_);
  while (true) {
    Entry* const entry = find(task);
    if (entry == nullptr || (running_ != &task && entry->due > Clock::now())) return;
    if (thread_.joinable()) {
      changed_.wait(lock);
    } else {
      run_task(*entry, lock);
    }
  }
}

void BackgroundWriter::remove(Task& task) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return running_ != &task; });
  std::erase_if(entries_, [&](const Entry& entry) { return entry.task == &task; });
}

void BackgroundWriter::run() {
  system::name_this_thread("limber-files");
  system::block_process_signals();
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const auto next = std::ranges::min_element(entries_, {}, &Entry::due);
    if (next == entries_.end() || next->due == kNever) {
      changed_.wait(lock);
    } else if (next->due > Clock::now()) {
      const Clock::time_point due = next->due;
      changed_.wait_until(lock, due);
    } else {
      run_task(*next, lock);
    }
  }
}

void BackgroundWriter::run_task(Entry& entry, std::unique_lock<std::mutex>& lock) {
  Task& task = *entry.task;
  entry.due = kNever;
  running_ = &task;
  lock.unlock();
  const Clock::time_point next = task.run();
  lock.lock();
  running_ = nullptr;
  Entry* const now = find(task);  // others may have been added or removed
  now->due = std::min(now->due, next);
  changed_.notify_all();
}

}  // namespace limber::engine
