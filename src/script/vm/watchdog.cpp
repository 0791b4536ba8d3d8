// The watchdog's loop, and the signal that it sends to the thread that runs Lua.
#include "script/vm/watchdog.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "base/system/process.h"
#include "base/system/signals.h"
#include "base/system/thread.h"

namespace limber::script {

namespace {

// The signal of the watchdog; 0: none yet.
std::atomic<int> watch_signal{0};
constexpr std::int64_t kResendInterval = 5'000'000;  // interval after which an ineffective signal is sent again, ns
constexpr std::int64_t kPingReplyTime = 200'000;     // time in which a computing thread answers a ping, ns

thread_local Watch* current_watch = nullptr;

template <class T>
T load(T& word, std::memory_order order = std::memory_order_relaxed) {
  return std::atomic_ref(word).load(order);
}

template <class T>
void store(T& word, T value, std::memory_order order = std::memory_order_relaxed) {
  std::atomic_ref(word).store(value, order);
}

// Runs anywhere inside the call: in Lua, in compiled code, in C++. A late signal is ignored, because the call has
// another number.
#if defined(__GNUC__)
__attribute__((no_sanitize("thread")))
#endif
void on_signal(int) {
  Watch* const watch = current_watch;
  if (watch == nullptr) return;
  const std::uint64_t call = __atomic_load_n(&watch->call, __ATOMIC_RELAXED);
  if ((call & 1u) == 0) return;
  if (__atomic_load_n(&watch->pinged_call, __ATOMIC_RELAXED) == call)
    __atomic_store_n(&watch->answered_call, call, __ATOMIC_RELAXED);
  if (__atomic_load_n(&watch->stop_call, __ATOMIC_RELAXED) == call) watch->stop(*watch);
}

// Of the calling thread. A fork changes its id and its clock; its creator may have blocked the signal.
struct ThisThread {
  unsigned forks = 0;
  int signal = 0;
  std::uint64_t id = 0;
  std::int64_t clock = 0;

  void update() {
    forks = system::fork_count();
    signal = watch_signal.load(std::memory_order_relaxed);
    id = system::this_thread();
    clock = system::this_thread_clock();
    if (signal != 0) system::unblock_signal(signal);
  }
};

}  // namespace

void Watch::begin(std::int64_t budget_ns) {
  thread_local ThisThread here;
  if (here.id == 0 || here.forks != system::fork_count() || here.signal != watch_signal.load(std::memory_order_relaxed))
    here.update();
  store(clock, here.clock);
  store(thread, here.id);
  store(budget, budget_ns);
  current_watch = this;
  store(call, call + 1, std::memory_order_release);  // the only writer
}

void Watch::end() {
  store(call, call + 1, std::memory_order_release);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  current_watch = nullptr;
}

// still odd; a pending request to stop the previous call no longer matches
void Watch::next_call() {
  store(call, call + 2, std::memory_order_release);
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

bool Watch::stop_requested() { return (call & 1u) != 0 && load(stop_call) == call; }

std::shared_ptr<Watchdog> Watchdog::instance() {
  static std::mutex mutex;
  static std::weak_ptr<Watchdog> known;
  static unsigned forks = system::fork_count();
  const std::scoped_lock lock(mutex);
  if (forks != system::fork_count()) {
    // its thread exists in the parent process only; it is not destroyed, because that would wait for the thread
    if (std::shared_ptr<Watchdog> parents = known.lock()) (void)new std::shared_ptr<Watchdog>(std::move(parents));
    known.reset();
    forks = system::fork_count();
  }
  std::shared_ptr<Watchdog> found = known.lock();
  if (found == nullptr) known = found = std::shared_ptr<Watchdog>(new Watchdog);
  return found;
}

Watchdog::Watchdog() {
  // installed without a sanitizer's wrapper, which defers handlers to the next call; compiled Lua makes no calls
  signal_ = system::claim_thread_signal(on_signal);
  watch_signal.store(signal_, std::memory_order_relaxed);
  thread_ = std::thread([this] { run(); });
}

Watchdog::~Watchdog() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
  system::release_thread_signal(signal_, on_signal);
}

void Watchdog::add(Watch& watch, std::int64_t poll_ns) {
  {
    const std::scoped_lock lock(mutex_);
    watches_.push_back({&watch, poll_ns});
  }
  changed_.notify_all();
}

void Watchdog::remove(Watch& watch) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(watches_, [&](const Entry& w) { return w.watch == &watch; });
}

void Watchdog::run() {
  system::block_process_signals();
  std::unique_lock lock(mutex_);
  while (!end_) {
    if (watches_.empty()) {
      changed_.wait(lock);
      continue;
    }
    std::int64_t wait = kResendInterval;
    for (const Entry& w : watches_) wait = std::min(wait, check(*w.watch, w.poll));
    changed_.wait_for(lock, std::chrono::nanoseconds(wait));
  }
}

// Returns the time until the next check, ns: CPU time never runs faster than wall time.
std::int64_t Watchdog::check(Watch& watch, std::int64_t poll) const {
  const std::uint64_t call = load(watch.call, std::memory_order_acquire);
  if ((call & 1u) == 0) return poll;
  const std::int64_t now = system::cpu_nanoseconds(load(watch.clock));
  if (now < 0) return poll;  // the thread has ended
  if (watch.observed_call != call) {
    watch.observed_call = call;
    watch.observed_at = now;
    watch.second_half = false;
  }
  if (!watch.second_half && load(watch.answered_call) == call) {
    watch.observed_at = now;
    watch.second_half = true;
  }
  const std::int64_t budget = load(watch.budget);
  const std::int64_t part = watch.second_half ? budget - budget / 2 : budget / 2;
  const std::int64_t left = part - (now - watch.observed_at);
  if (left > 0) return std::min(left, poll);
  store(watch.second_half ? watch.stop_call : watch.pinged_call, call);
  if (signal_ != 0) system::signal_thread(load(watch.thread), signal_);
  return watch.second_half ? std::min(poll, kResendInterval) : kPingReplyTime;
}

}  // namespace limber::script
