// The scene of an experiment, its workers and axes.
#include "app/experiments/experiment.h"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/experiments/worker.h"
#include "app/paths.h"
#include "base/log/output.h"
#include "base/system/executable_path.h"
#include "base/system/signals.h"
#include "base/text.h"

namespace limber::app {

bool Experiment::canceled() {
  canceled_ = canceled_ || system::signal_arrived();
  return canceled_;
}

std::optional<ExperimentFault> Experiment::open() {
  std::vector<experiments::AxisText> texts;
  for (const std::string& text : options_.params) {
    Result<experiments::AxisText> axis = experiments::parse_axis(text);
    if (!axis) return ExperimentFault{kUsageError, axis.error()};
    texts.push_back(std::move(*axis));
  }
  Result<std::vector<std::uint64_t>> seeds = experiments::parse_seeds(options_.seeds);
  if (!seeds) return ExperimentFault{kUsageError, seeds.error()};
  seeds_ = std::move(*seeds);
  std::vector<std::string> searched;
  const std::string scene = find_file_or_folder(options_.scene, searched);
  if (scene.empty() || !scene.ends_with(".lua"))
    return ExperimentFault{
        kInputError, scene.empty() ? scene_not_found(options_.scene, searched)
                                   : fmt::format("{} is not a scene; name a .lua file", printable(options_.scene))};
  const std::string program = system::executable_path();
  if (program.empty()) return ExperimentFault{kMachineError, "the path of this program is unknown"};
  if (ranks_ != nullptr && options_.jobs > 0)
    return ExperimentFault{kUsageError, "--jobs: MPI determines the number of processes; use mpirun -n, or --mpi off"};
  create_dispatcher(program);
  setup_ = {absolute_path(scene), options_.duration, {}};
  Result<experiments::SceneInfo> info = dispatcher_->describe(setup_);
  if (!info) return ExperimentFault{kInputError, info.error()};
  scene_ = std::move(*info);
  Result<std::vector<experiments::Axis>> axes = experiments::make_axes(texts, scene_.parameters);
  if (!axes) return ExperimentFault{kUsageError, axes.error()};
  axes_ = std::move(*axes);
  return {};
}

experiments::Workers& Experiment::workers(const std::string& program) {
  if (ranks_ != nullptr) return *ranks_;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int jobs = options_.jobs > 0 ? options_.jobs : cores;
  processes_ = std::make_unique<ProcessWorkers>(static_cast<std::size_t>(jobs),
                                                std::vector<std::string>{program, std::string(kWorkerArgument)});
  return *processes_;
}

void Experiment::create_dispatcher(const std::string& program) {
  experiments::Dispatcher::Options options;
  options.time_limit = options_.time_limit;
  options.canceled = [this] { return canceled(); };
  options.on_restart = [this] {
    if (++restarts_ == 1) print_notice("a simulation ended unexpectedly; it is restarted (reported once)");
  };
  dispatcher_ = std::make_unique<experiments::Dispatcher>(workers(program), std::move(options));
}

void Experiment::begin() {
  setup_.parameters.clear();
  for (const experiments::Axis& axis : axes_) setup_.parameters.push_back(axis.name);
  dispatcher_->set_setup(setup_);
}

std::string command_that_plays(const std::string& scene, const std::vector<experiments::Axis>& axes,
                               const std::vector<double>& values, std::uint64_t seed) {
  std::string command = fmt::format("limber {}", shell_word(scene));
  for (std::size_t i = 0; i < axes.size(); i++)
    command += fmt::format(" --param {}={}", axes[i].name, shell_word(axes[i].text(values[i])));
  return command + fmt::format(" --seed {}", seed);
}

}  // namespace limber::app
