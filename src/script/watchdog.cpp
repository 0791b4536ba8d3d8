// The watchdog's loop, and the signal by which it reaches the thread that runs Lua.
#include "script/watchdog.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>

#include "base/system/signals.h"
#include "base/system/thread.h"

namespace limber {

namespace {

// ignored by default and used by nobody here: a late one does no harm
constexpr int kSignal = SIGURG;
constexpr std::int64_t kAgain = 5'000'000;  // a signal that met an unlucky moment is sent again after that, ns
constexpr std::int64_t kAnswer = 200'000;   // so soon one who computes has answered, ns

thread_local Watch* watched_here = nullptr;

template <class T>
T load(T& word, std::memory_order order = std::memory_order_relaxed) {
  return std::atomic_ref(word).load(order);
}

template <class T>
void store(T& word, T value, std::memory_order order = std::memory_order_relaxed) {
  std::atomic_ref(word).store(value, order);
}

// runs anywhere inside the call: in Lua, in compiled code, in C++. A signal that comes late finds another number
#if defined(__GNUC__)
__attribute__((no_sanitize("thread")))
#endif
void on_signal(int) {
  Watch* const watch = watched_here;
  if (watch == nullptr) return;
  const std::uint64_t call = __atomic_load_n(&watch->call, __ATOMIC_RELAXED);
  if ((call & 1u) == 0) return;
  if (__atomic_load_n(&watch->hailed, __ATOMIC_RELAXED) == call)
    __atomic_store_n(&watch->answered, call, __ATOMIC_RELAXED);
  if (__atomic_load_n(&watch->asked, __ATOMIC_RELAXED) == call) watch->stop(*watch);
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
  watched_here = this;
  store(call, call + 1, std::memory_order_release);  // nobody else writes it
}

void Watch::end() {
  store(call, call + 1, std::memory_order_release);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  watched_here = nullptr;
}

// still odd; who asked for the call before is not heard any more
void Watch::next() {
  store(call, call + 2, std::memory_order_release);
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

bool Watch::stop_asked() { return (call & 1u) != 0 && load(asked) == call; }

std::shared_ptr<Watchdog> Watchdog::instance() {
  static std::mutex mutex;
  static std::weak_ptr<Watchdog> known;
  const std::scoped_lock lock(mutex);
  std::shared_ptr<Watchdog> found = known.lock();
  if (found == nullptr) known = found = std::shared_ptr<Watchdog>(new Watchdog);
  return found;
}

Watchdog::Watchdog() {
  // compiled Lua makes no calls, to which a sanitizer could put the handler off
  system::handle_signal_at_once(kSignal, on_signal);
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
  std::erase_if(watches_, [&](const Watched& w) { return w.watch == &watch; });
}

void Watchdog::run() {
  std::unique_lock lock(mutex_);
  while (!end_) {
    if (watches_.empty()) {
      changed_.wait(lock);
      continue;
    }
    std::int64_t wait = kAgain;
    for (const Watched& w : watches_) wait = std::min(wait, look(*w.watch, w.poll));
    changed_.wait_for(lock, std::chrono::nanoseconds(wait));
  }
}

// how long this watch may be left alone, ns: CPU time never runs faster than the clock on the wall
std::int64_t Watchdog::look(Watch& watch, std::int64_t poll) {
  const std::uint64_t call = load(watch.call, std::memory_order_acquire);
  if ((call & 1u) == 0) return poll;
  const std::int64_t now = system::cpu_nanoseconds(load(watch.clock));
  if (now < 0) return poll;  // its thread has ended
  if (watch.seen != call) {
    watch.seen = call;
    watch.since = now;
    watch.second_half = false;
  }
  if (!watch.second_half && load(watch.answered) == call) {
    watch.since = now;
    watch.second_half = true;
  }
  const std::int64_t budget = load(watch.budget);
  const std::int64_t part = watch.second_half ? budget - budget / 2 : budget / 2;
  const std::int64_t left = part - (now - watch.since);
  if (left > 0) return std::min(left, poll);
  store(watch.second_half ? watch.asked : watch.hailed, call);
  system::signal_thread(load(watch.thread), kSignal);
  return watch.second_half ? std::min(poll, kAgain) : kAnswer;
}

}  // namespace limber
