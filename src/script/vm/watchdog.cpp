// The watchdog's loop, and the signal that it sends to the thread that runs Lua.
#include "script/vm/watchdog.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>

#include "base/system/signals.h"
#include "base/system/thread.h"

namespace limber::script {

namespace {

// ignored by default and otherwise unused by the program, so a late signal does no harm
constexpr int kSignal = SIGURG;
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

struct ThisThread {
  std::uint64_t id = system::this_thread();
  std::int64_t clock = system::this_thread_clock();
};

}  // namespace

void Watch::begin(std::int64_t budget_ns) {
  thread_local const ThisThread here;
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
  const std::scoped_lock lock(mutex);
  std::shared_ptr<Watchdog> found = known.lock();
  if (found == nullptr) known = found = std::shared_ptr<Watchdog>(new Watchdog);
  return found;
}

Watchdog::Watchdog() {
  // installed without a sanitizer's wrapper, which defers handlers to the next call; compiled Lua makes no calls
  system::handle_signal_immediately(kSignal, on_signal);
  thread_ = std::thread([this] { run(); });
}

Watchdog::~Watchdog() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
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
std::int64_t Watchdog::check(Watch& watch, std::int64_t poll) {
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
  system::signal_thread(load(watch.thread), kSignal);
  return watch.second_half ? std::min(poll, kResendInterval) : kPingReplyTime;
}

}  // namespace limber::script
