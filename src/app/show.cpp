// The simulation's thread.
#include "app/show.h"

#include <new>
#include <string>
#include <system_error>

#include "base/system/signals.h"
#include "base/system/thread.h"
#include "engine/engine.h"

namespace limber {

Show::Show(Engine& engine) : engine_(engine), main_(system::this_thread()), thread_([this] { play(); }) {}

void Show::go(bool anyway) {
  anyway_.store(anyway);
  go_.release();
}

void Show::end() {
  if (!thread_.joinable()) return;
  engine_.stop();
  go_.release();
  thread_.join();
}

void Show::play() {
  system::name_this_thread("limber-sim");
  result_ = start();
  change(State::started);
  go_.acquire();
  if (result_ || anyway_.load()) engine_.run();
  change(State::over);
}

Result<void> Show::start() {
  std::string why;
  try {
    return engine_.start();
  } catch (const std::bad_alloc&) {
    why = "there is not enough memory for the scene";
  } catch (const std::system_error& error) {  // of a thread that could not be started
    why = error.code().message();
  }
  fault_ = kMachine;
  return Error{why + "; end other programs, or raise ulimit -u and ulimit -v"};
}

void Show::change(State state) {
  state_.store(state);
  system::call_thread(main_);
}

}  // namespace limber
