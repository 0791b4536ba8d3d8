// Workers spin briefly for the next round, then sleep. Threads take tasks by decrementing an atomic counter.
#include "base/threads/thread_pool.h"

#include "base/check.h"
#include "base/math/fixed_math.h"
#include "base/system/clock.h"
#include "base/system/signals.h"
#include "base/system/thread.h"

namespace limber {

namespace {

// Time that a thread spins before it sleeps, in seconds. The serial work between two rounds of a tick, and between
// ticks without a pause, is mostly shorter. Waking a thread takes about 70 µs, 45 µs of them in the thread that wakes
// it. If ticks are paced, the workers sleep between them.
constexpr double kSpinSeconds = 400e-6;

void cpu_pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

// With more threads than processors, spinning would only delay other threads.
ThreadPool::ThreadPool(int threads)
    : thread_count_(threads), spins_(static_cast<unsigned>(threads) <= std::thread::hardware_concurrency()) {
  LIMBER_CHECK(threads >= 1 && threads <= kMaxThreads);
  for (int thread = 1; thread < threads; thread++) {
    std::thread worker;
    if (!system::start_thread(worker, [this, thread] { worker_main(thread); })) {
      thread_count_ = thread;
      break;
    }
    workers_.push_back(std::move(worker));
  }
}

ThreadPool::~ThreadPool() {
  stopping_ = true;
  round_++;
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::wake() {
  round_++;
  round_.notify_all();
}

void ThreadPool::run_tasks(int tasks, Call call, void* context) {
  if (tasks <= 0) return;
  call_ = call;
  context_ = context;
  unfinished_.store(tasks, std::memory_order_relaxed);
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  int first = 0;
  for (int thread = 0; thread < thread_count_; thread++) {
    TaskRange& range = ranges_[static_cast<std::size_t>(thread)];
    range.end = static_cast<int>(std::int64_t{tasks} * (thread + 1) / thread_count_);
    range.ticket.store(static_cast<std::uint64_t>(round) << kTaskBits | static_cast<std::uint32_t>(range.end - first));
    first = range.end;
  }
  round_.store(round);
  if (tasks > 1) round_.notify_all();
  run_available_tasks(round, 0);
  spin_until([&] { return unfinished_.load() == 0; });
  for (int assigned = unfinished_.load(); assigned != 0; assigned = unfinished_.load()) unfinished_.wait(assigned);
}

void ThreadPool::worker_main(int thread) {
  system::block_process_signals();
  fixed::reset_arithmetic();
  system::name_this_thread("limber-worker");
  std::uint32_t last_round = 0;
  while (!stopping_) {
    spin_until([&] { return round_.load() != last_round; });
    round_.wait(last_round);
    last_round = round_.load();
    run_available_tasks(last_round, thread);
  }
}

// Spins until done() or for at most kSpinSeconds.
template <class Done>
void ThreadPool::spin_until(Done&& done) const {
  if (!spins_ || done()) return;
  const double end = system::clock_seconds() + kSpinSeconds;
  do {
    for (int i = 0; i < 16; i++) {
      if (done()) return;
      cpu_pause();
    }
  } while (system::clock_seconds() < end);
}

// Runs the tasks of the thread's own range, then those left in the ranges of others.
void ThreadPool::run_available_tasks(std::uint64_t round, int thread) {
  for (int i = 0; i < thread_count_; i++) {
    TaskRange& range = ranges_[static_cast<std::size_t>((thread + i) % thread_count_)];
    std::uint64_t ticket = range.ticket.load();
    while (ticket >> kTaskBits == round && static_cast<std::uint32_t>(ticket) != 0) {
      if (!range.ticket.compare_exchange_weak(ticket, ticket - 1)) continue;
      call_(context_, range.end - static_cast<int>(static_cast<std::uint32_t>(ticket)), thread);
      if (unfinished_.fetch_sub(1) == 1) unfinished_.notify_one();
      ticket = range.ticket.load();
    }
  }
}

}  // namespace limber
