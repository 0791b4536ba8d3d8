// Dispatcher: distributes evaluations to workers and commits their outcomes in the order of their numbers, so that the
// result of an experiment doesn't depend on the number of workers, their speed, or their failures. A worker that dies
// or takes too long is restarted, and its evaluation is done again. [one thread]
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "experiments/evaluation.h"

namespace limber::experiments {

/// The transport: starts workers, which are numbered from 0, and exchanges lines of text with them. app/experiments
/// implements it with child processes, RankWorkers (ranks.h) with the ranks of an MPI job.
class Workers {
 public:
  Workers() = default;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  virtual ~Workers() = default;

  struct Event {
    std::size_t worker = 0;
    std::optional<std::string> line;  ///< Nothing: the worker has ended.
  };

  virtual std::size_t count() const = 0;
  /// Starts the worker; ends the running one first.
  virtual Result<void> start(std::size_t worker) = 0;
  /// Sends a line. A failure is followed by the event that the worker has ended.
  virtual void send(std::size_t worker, std::string_view line) = 0;
  /// Waits for events, at most for `limit`; returns earlier if a signal arrived.
  virtual std::vector<Event> wait(std::chrono::microseconds limit) = 0;
  /// Returns where the worker runs, for error messages; empty: here.
  virtual std::string place(std::size_t /*worker*/) const { return {}; }
};

class Dispatcher {
 public:
  /// Number of times that an evaluation is tried if its worker dies or takes too long.
  static constexpr int kTries = 3;
  /// Number of evaluations that may be ahead of the oldest one without an outcome, per worker.
  static constexpr std::uint64_t kAhead = 256;

  struct Options {
    double time_limit = 300;                                ///< Real time of an evaluation, s.
    std::function<bool()> canceled = [] { return false; };  ///< Polled at least ten times a second.
    std::function<double()> clock = system::clock_seconds;  ///< Real time, s.
    std::function<void()> on_restart = [] {};               ///< Called when a worker has to be restarted.
  };
  enum class End : std::uint8_t { done, canceled };

  Dispatcher(Workers& workers, Options options) : workers_(workers), options_(std::move(options)) {
    states_.resize(workers.count());
  }

  /// Sets up the first worker. Returns the scene's parameters and results, or the scene's error if its script fails.
  Result<SceneInfo> describe(const WorkerSetup& setup);
  /// Uses this setup for all following evaluations.
  void set_setup(const WorkerSetup& setup);
  /// Evaluates each value of `next` until it returns nothing. `commit` is called for each outcome, in the order of
  /// `next`; an error from it ends the run.
  Result<End> run(const std::function<std::optional<Evaluation>()>& next,
                  const std::function<Result<void>(const Evaluation&, const Outcome&)>& commit);

 private:
  enum class Phase : std::uint8_t { down, setting_up, idle, busy };
  struct Task {
    Evaluation evaluation;
    int tries = 0;
    std::optional<Outcome> outcome;
  };
  struct WorkerState {
    Phase phase = Phase::down;
    std::uint64_t task = 0;  ///< Index of its task while busy.
    double since = 0;        ///< Time at which the phase began.
    int failed_starts = 0;   ///< Consecutive starts without an answer.
  };
  Result<void> start(std::size_t worker);
  void enter(std::size_t worker, Phase phase);
  void give_work(const std::function<std::optional<Evaluation>()>& next);
  std::optional<std::uint64_t> next_task(const std::function<std::optional<Evaluation>()>& next);
  Result<void> handle(const Workers::Event& event);
  Result<void> handle_scene(std::size_t worker, SceneInfo scene);
  Error error_of(std::size_t worker, const std::string& text) const;
  Result<void> lose(std::size_t worker, const std::string& reason);
  Result<void> stop_slow_workers();
  Result<void> commit_finished(const std::function<Result<void>(const Evaluation&, const Outcome&)>& commit);

  Workers& workers_;
  Options options_;
  WorkerSetup setup_;
  std::vector<WorkerState> states_;
  std::optional<SceneInfo> scene_;       ///< Of the last setup.
  std::map<std::uint64_t, Task> tasks_;  ///< Tasks that are not committed, by index.
  std::vector<std::uint64_t> again_;     ///< Indices of tasks that are evaluated again.
  std::uint64_t created_ = 0;            ///< Number of tasks so far.
  bool exhausted_ = false;               ///< `next` has returned nothing.
};

}  // namespace limber::experiments
