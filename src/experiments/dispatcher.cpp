// Distribution of evaluations, restarts, and commits in order.
#include "experiments/dispatcher.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::experiments {

namespace {

constexpr std::chrono::milliseconds kWait{100};
constexpr int kMaxFailedStarts = 3;     // before any worker has answered
constexpr int kMaxFailedRestarts = 20;  // of one worker in sequence

}  // namespace

void Dispatcher::enter(std::size_t worker, Phase phase) {
  states_[worker].phase = phase;
  states_[worker].since = options_.clock();
}

Result<void> Dispatcher::start(std::size_t worker) {
  if (Result<void> started = workers_.start(worker); !started) return started;
  workers_.send(worker, encode(Request(setup_)));
  enter(worker, Phase::setting_up);
  return {};
}

void Dispatcher::set_setup(const WorkerSetup& setup) {
  setup_ = setup;
  for (std::size_t i = 0; i < states_.size(); i++) {
    if (states_[i].phase == Phase::down) continue;
    workers_.send(i, encode(Request(setup_)));
    enter(i, Phase::setting_up);
  }
}

Result<SceneInfo> Dispatcher::describe(const WorkerSetup& setup) {
  setup_ = setup;
  scene_.reset();
  if (Result<void> started = start(0); !started) return Error{started.error()};
  while (!scene_) {
    if (options_.canceled()) return Error{"stopped before the scene was read"};
    for (const Workers::Event& event : workers_.wait(kWait)) {
      if (Result<void> handled = handle(event); !handled) return Error{handled.error()};
    }
    if (Result<void> stopped = stop_slow_workers(); !stopped) return Error{stopped.error()};
    if (states_[0].phase == Phase::down) {
      if (Result<void> started = start(0); !started) return Error{started.error()};
    }
  }
  return *scene_;
}

Result<Dispatcher::End> Dispatcher::run(const std::function<std::optional<Evaluation>()>& next,
                                        const std::function<Result<void>(const Evaluation&, const Outcome&)>& commit) {
  tasks_.clear();
  again_.clear();
  created_ = 0;
  exhausted_ = false;
  while (true) {
    if (options_.canceled()) return End::canceled;
    give_work(next);
    if (exhausted_ && tasks_.empty()) return End::done;
    for (std::size_t i = 0; i < states_.size(); i++) {
      if (states_[i].phase != Phase::down || (exhausted_ && again_.empty())) continue;
      if (Result<void> started = start(i); !started) return Error{started.error()};
    }
    for (const Workers::Event& event : workers_.wait(kWait)) {
      if (Result<void> handled = handle(event); !handled) return Error{handled.error()};
    }
    if (Result<void> stopped = stop_slow_workers(); !stopped) return Error{stopped.error()};
    if (Result<void> committed = commit_finished(commit); !committed) return Error{committed.error()};
  }
}

// Returns the index of the next task: one that has to be tried again, else a new one, unless too many outcomes wait for
// a slow evaluation.
std::optional<std::uint64_t> Dispatcher::next_task(const std::function<std::optional<Evaluation>()>& next) {
  if (!again_.empty()) {
    const auto oldest = std::ranges::min_element(again_);
    const std::uint64_t index = *oldest;
    again_.erase(oldest);
    return index;
  }
  const std::uint64_t oldest = tasks_.empty() ? created_ : tasks_.begin()->first;
  if (exhausted_ || created_ - oldest >= kAhead * states_.size()) return {};
  std::optional<Evaluation> evaluation = next();
  if (!evaluation) {
    exhausted_ = true;
    return {};
  }
  tasks_[created_].evaluation = std::move(*evaluation);
  return created_++;
}

void Dispatcher::give_work(const std::function<std::optional<Evaluation>()>& next) {
  for (std::size_t i = 0; i < states_.size(); i++) {
    if (states_[i].phase != Phase::idle) continue;
    const std::optional<std::uint64_t> index = next_task(next);
    if (!index) return;
    Task& task = tasks_[*index];
    task.tries++;
    states_[i].task = *index;
    workers_.send(i, encode(Request(task.evaluation)));
    enter(i, Phase::busy);
  }
}

Result<void> Dispatcher::handle(const Workers::Event& event) {
  WorkerState& state = states_[event.worker];
  if (!event.line) return lose(event.worker, "the simulation crashed");
  std::optional<Answer> answer = decode_answer(*event.line);
  if (!answer) return lose(event.worker, "the simulation returned an invalid line");
  if (const auto* fault = std::get_if<WorkerFault>(&*answer)) return error_of(event.worker, fault->text);
  if (auto* scene = std::get_if<SceneInfo>(&*answer)) return handle_scene(event.worker, std::move(*scene));
  auto& outcome = std::get<Outcome>(*answer);
  if (state.phase != Phase::busy) return {};  // of an abandoned evaluation
  Task& task = tasks_[state.task];
  if (outcome.number == task.evaluation.number) task.outcome = std::move(outcome);
  if (!task.outcome) return lose(event.worker, "the simulation returned another evaluation");
  enter(event.worker, Phase::idle);
  return {};
}

// Evaluations of different scenes would be one result.
Result<void> Dispatcher::handle_scene(std::size_t worker, SceneInfo scene) {
  if (scene_ && *scene_ != scene)
    return error_of(worker,
                    "the scene is not the one that was read at the beginning, so it was changed, or other "
                    "nodes have another one; copy it to all nodes, and start again");
  scene_ = std::move(scene);
  states_[worker].failed_starts = 0;
  if (states_[worker].phase == Phase::setting_up) enter(worker, Phase::idle);
  return {};
}

Error Dispatcher::error_of(std::size_t worker, const std::string& text) const {
  const std::string place = workers_.place(worker);
  return Error{place.empty() ? text : fmt::format("{}: {}", place, text)};
}

// Marks a worker as down. Its evaluation is tried again, and fails after kTries.
Result<void> Dispatcher::lose(std::size_t worker, const std::string& reason) {
  WorkerState& state = states_[worker];
  const Phase before = std::exchange(state.phase, Phase::down);
  if (before == Phase::down) return {};
  options_.on_restart();
  if (before != Phase::busy) {
    if (++state.failed_starts < (scene_ ? kMaxFailedRestarts : kMaxFailedStarts)) return {};
    return error_of(worker, fmt::format("{} {} times before it could begin; check the scene with limber play", reason,
                                        state.failed_starts));
  }
  Task& task = tasks_[state.task];
  if (task.tries < kTries) {
    again_.push_back(state.task);
  } else {
    task.outcome = Outcome{task.evaluation.number, {}, 0, fmt::format("{}, {} times", reason, kTries)};
  }
  return {};
}

Result<void> Dispatcher::stop_slow_workers() {
  const double now = options_.clock();
  for (std::size_t i = 0; i < states_.size(); i++) {
    const Phase phase = states_[i].phase;
    if (phase == Phase::down || phase == Phase::idle || now - states_[i].since <= options_.time_limit) continue;
    if (Result<void> lost =
            lose(i, fmt::format("the simulation took longer than {} s", number_text(options_.time_limit)));
        !lost)
      return lost;
    // starting it ends the process that hangs
    if (Result<void> started = start(i); !started) return started;
  }
  return {};
}

Result<void> Dispatcher::commit_finished(const std::function<Result<void>(const Evaluation&, const Outcome&)>& commit) {
  while (!tasks_.empty() && tasks_.begin()->second.outcome) {
    const Task& task = tasks_.begin()->second;
    if (Result<void> committed = commit(task.evaluation, *task.outcome); !committed) return committed;
    tasks_.erase(tasks_.begin());
  }
  return {};
}

}  // namespace limber::experiments
