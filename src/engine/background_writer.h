// BackgroundWriter: one thread that writes all files of a show, so that a tick never waits for a disk. A file is a
// task, which the thread runs when it has been requested. The task whose time came first runs first, and each call of
// Task::run() is short (a take writes at most 1 MiB), so a slow file delays the others by at most one call.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace limber::engine {

class BackgroundWriter {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point kNever = Clock::time_point::max();

  class Task {
   public:
    Task() = default;
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;
    virtual ~Task() = default;
    /// Does a part of the work; returns the time of the next run, kNever: when it is requested. A run satisfies all
    /// requests from before it began, so it must return a time if it left some of their work. [the writer's thread]
    virtual Clock::time_point run() = 0;
  };

  BackgroundWriter() = default;
  /// All tasks must have been removed.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Adds a task, which must be removed before its destructor ends.
  void add(Task& task);
  /// Runs the task at `time` at the latest. False if the thread can't be created, which the next request tries again.
  /// Never waits for a disk.
  bool request(Task& task, Clock::time_point time = Clock::now());
  /// Waits until the task has no run that is due. Without a thread, runs it here.
  void finish(Task& task);
  /// Removes the task; waits until its current run ends. Does nothing if it was removed.
  void remove(Task& task);

 private:
  struct Entry {
    Task* task = nullptr;
    Clock::time_point due = kNever;
  };
  Entry* find(const Task& task);
  void run();
  void run_task(Entry& entry, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;  // never locked while a task runs
  std::condition_variable changed_;
  std::vector<Entry> entries_;
  const Task* running_ = nullptr;
  bool stopping_ = false;
  std::thread thread_;  // created by the first request
};

}  // namespace limber::engine
