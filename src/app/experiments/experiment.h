// Experiment: what sweep and evolve have in common: the scene, its workers, the varied axes, and the command that plays
// an evaluation. [main]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/experiments/experiment_options.h"
#include "app/experiments/process_workers.h"
#include "experiments/axis.h"
#include "experiments/dispatcher.h"

namespace limber::app {

/// Why an experiment can't go on: its exit code and text.
struct ExperimentFault {
  int code;
  std::string text;
};

/// Returns the shell command that plays a scene with these values of its parameters.
std::string command_that_plays(const std::string& scene, const std::vector<experiments::Axis>& axes,
                               const std::vector<double>& values, std::uint64_t seed);

class Experiment {
 public:
  /// `ranks`: the workers of an MPI job; null: child processes of this one.
  Experiment(const ExperimentOptions& options, experiments::Workers* ranks) : options_(options), ranks_(ranks) {}

  /// Finds the scene, parses the options and reads the scene's declarations in a worker.
  std::optional<ExperimentFault> open();
  /// Sets the varied parameters of all following evaluations.
  void begin();

  /// The absolute path of the scene.
  const std::string& scene_path() const { return setup_.scene; }
  const experiments::SceneInfo& scene() const { return scene_; }
  const std::vector<experiments::Axis>& axes() const { return axes_; }
  const std::vector<std::uint64_t>& seeds() const { return seeds_; }
  experiments::Dispatcher& dispatcher() { return *dispatcher_; }
  /// Number of restarted workers.
  std::uint64_t restarts() const { return restarts_; }
  /// True once Ctrl+C was pressed.
  bool canceled();
  /// Returns the shell command that plays the evaluation.
  std::string play_command(const std::vector<double>& values, std::uint64_t seed) const {
    return command_that_plays(options_.scene, axes_, values, seed);
  }

 private:
  experiments::Workers& workers(const std::string& program);
  void create_dispatcher(const std::string& program);

  ExperimentOptions options_;
  experiments::Workers* ranks_;
  std::unique_ptr<ProcessWorkers> processes_;
  std::unique_ptr<experiments::Dispatcher> dispatcher_;
  experiments::WorkerSetup setup_;
  experiments::SceneInfo scene_;
  std::vector<experiments::Axis> axes_;
  std::vector<std::uint64_t> seeds_;
  std::uint64_t restarts_ = 0;
  bool canceled_ = false;
};

}  // namespace limber::app
