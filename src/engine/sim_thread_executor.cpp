// SimThreadExecutor: one piece of work at a time. The mutex is not held while it runs.
#include "engine/sim_thread_executor.h"

namespace limber::engine {

bool SimThreadExecutor::run_and_wait(const std::function<void()>& work, const std::function<void()>& wake) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return work_ == nullptr || closed_; });
  if (closed_) return false;
  work_ = &work;
  waiting_.store(true, std::memory_order_release);
  lock.unlock();
  wake();
  lock.lock();
  changed_.wait(lock, [&] { return work_ != &work || closed_; });
  if (work_ != &work) return true;
  work_ = nullptr;
  waiting_.store(false, std::memory_order_release);
  return false;
}

void SimThreadExecutor::serve() {
  if (!waiting()) return;
  const std::function<void()>* work = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    work = work_;
  }
  if (work == nullptr) return;
  (*work)();
  {
    const std::scoped_lock lock(mutex_);
    work_ = nullptr;
    waiting_.store(false, std::memory_order_release);
  }
  changed_.notify_all();
}

void SimThreadExecutor::open() {
  const std::scoped_lock lock(mutex_);
  closed_ = false;
}

void SimThreadExecutor::close() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace limber::engine
