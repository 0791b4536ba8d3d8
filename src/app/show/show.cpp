// Runs the simulation's thread.
#include "app/show/show.h"

#include <new>
#include <string>
#include <system_error>

#include "base/system/signals.h"
#include "base/system/thread.h"
#include "engine/engine.h"

namespace limber {

Show::Show(Engine& engine) : engine_(engine), main_thread_(system::this_thread()), thread_([this] { play(); }) {}

void Show::allow_ticks(bool even_if_failed) {
  even_if_failed_.store(even_if_failed);
  start_semaphore_.release();
}

void Show::end() {
  if (!thread_.joinable()) return;
  engine_.stop();
  start_semaphore_.release();
  thread_.join();
}

void Show::play() {
  system::name_this_thread("limber-sim");
  result_ = start();
  change(State::started);
  start_semaphore_.acquire();
  if (result_ || even_if_failed_.load()) engine_.run();
  change(State::over);
}

Result<void> Show::start() {
  std::string why;
  try {
    return engine_.start();
  } catch (const std::bad_alloc&) {
    why = "not enough memory for the scene";
  } catch (const std::system_error& error) {  // a thread could not be started
    why = error.code().message();
  }
  exit_code_ = kMachineError;
  return Error{why + "; end other programs, or raise ulimit -u and ulimit -v"};
}

void Show::change(State state) {
  state_.store(state);
  system::wake_thread(main_thread_);
}

}  // namespace limber
