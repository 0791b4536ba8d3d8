// ThreadPool: runs the tasks of a parallel loop on several threads, including the caller. Each thread starts with its
// own range of tasks, which is the same in each run, so that its data is still in its cache; then it takes tasks of
// others.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace limber {

class ThreadPool {
 public:
  static constexpr int kMaxThreads = 64;

  /// Starts `threads` - 1 workers (1 <= `threads` <= kMaxThreads; the caller of run() is one of them), or fewer if the
  /// system can't start more. The results do not depend on the number.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int thread_count() const { return thread_count_; }

  /// Wakes sleeping workers ahead of run(). Optional: run() wakes them as well, but waking takes about 70 µs, which
  /// this call hides behind the serial work before run(). [same thread as run()]
  void wake();

  /// Calls function(task, thread) for each task in [0, tasks), distributed over the threads (0: the caller), and
  /// returns when all are done. Does not allocate. The function must not throw. [one thread at a time]
  template <class Work>
  void run(int tasks, Work&& function) {
    run_tasks(
        tasks,
        [](void* context, int task, int thread) {
          (*static_cast<std::remove_reference_t<Work>*>(context))(task, thread);
        },
        static_cast<void*>(std::addressof(function)));
  }

 private:
  using Call = void (*)(void* context, int task, int thread);
  static constexpr int kTaskBits = 32;

  void run_tasks(int tasks, Call call, void* context);
  void worker_main(int thread);
  void run_available_tasks(std::uint64_t round, int thread);
  template <class Done>
  void spin_until(Done&& done) const;

  int thread_count_;
  const bool spins_;  // every thread has a processor of its own, so that spinning is useful
  // The tasks of one thread in a round, in a cache line of its own.
  struct alignas(64) TaskRange {
    // Upper half: number of the round; lower half: remaining tasks. A late worker can't take tasks of another round.
    std::atomic<std::uint64_t> ticket{0};
    int end = 0;  // of the range; read only after taking a task, which prevents the round from ending
  };
  std::array<TaskRange, kMaxThreads> ranges_;
  alignas(64) std::atomic<std::uint32_t> round_{0};  // workers wait for it to change
  alignas(64) std::atomic<int> unfinished_{0};       // unfinished tasks of this round
  Call call_ = nullptr;
  void* context_ = nullptr;
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> workers_;
};

/// Like ThreadPool::run(). Without a pool, the caller runs all tasks in order as thread 0.
template <class Work>
void parallel_for(ThreadPool* pool, int tasks, Work&& function) {
  if (pool != nullptr && tasks > 1) {
    pool->run(tasks, function);
  } else {
    for (int task = 0; task < tasks; ++task) function(task, 0);
  }
}

constexpr int kDefaultGrain = 64;
/// Returns the number of ranges of parallel_for_ranges().
constexpr int range_count(int count, int grain = kDefaultGrain) { return (count + grain - 1) / grain; }
/// Splits the indices [0, count) into ranges of `grain` and calls function(range, first, end) for each, in parallel.
template <class Work>
void parallel_for_ranges(ThreadPool* pool, int count, Work&& function, int grain = kDefaultGrain) {
  parallel_for(pool, range_count(count, grain), [&](int range, int) {
    const int first = range * grain;
    function(range, first, std::min(first + grain, count));
  });
}

}  // namespace limber
