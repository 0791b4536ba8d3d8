// Runs the simulation's thread.
#include "app/show/engine_thread.h"

#include <new>
#include <string>
#include <system_error>

#include "base/system/signals.h"
#include "base/system/thread.h"
#include "engine/engine.h"

namespace limber::app {

EngineThread::EngineThread(engine::Engine& engine)
    : engine_(engine), main_thread_(system::this_thread()), thread_([this] { play(); }) {}

void EngineThread::allow_ticks(bool even_if_failed) {
  even_if_failed_.store(even_if_failed);
  start_semaphore_.release();
}

void EngineThread::end() {
  if (!thread_.joinable()) return;
  engine_.stop();
  start_semaphore_.release();
  thread_.join();
}

void EngineThread::play() {
  system::name_this_thread("limber-sim");
  result_ = start();
  change(State::started);
  start_semaphore_.acquire();
  if (result_ || even_if_failed_.load()) engine_.run();
  change(State::over);
}

Result<void> EngineThread::start() {
  std::string reason;
  try {
    return engine_.start();
  } catch (const std::bad_alloc&) {
    reason = "not enough memory for the scene";
  } catch (const std::system_error& error) {  // a thread could not be started
    reason = error.code().message();
  }
  exit_code_ = kMachineError;
  return Error{reason + "; end other programs, or raise ulimit -u and ulimit -v"};
}

void EngineThread::change(State state) {
  state_.store(state);
  system::wake_thread(main_thread_);
}

}  // namespace limber::app
