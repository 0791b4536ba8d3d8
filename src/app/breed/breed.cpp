// Reads the scene's parameters, finds the variations to begin with, and runs the window.
#include "app/breed/breed.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/breed/breed_session.h"
#include "app/breed/breed_window.h"
#include "app/breed/variation_worker.h"
#include "app/exit_code.h"
#include "app/experiments/experiment.h"
#include "app/paths.h"
#include "app/view/display_watchdog.h"
#include "base/log/output.h"
#include "base/system/executable_path.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "engine/presets/file.h"

namespace limber::app {

namespace {

using experiments::Axis;
using experiments::Breeding;

constexpr double kFirstAmount = 0.1;  // how much the first generation differs from the scene

// The scene's own values of the varied parameters.
std::vector<double> initial_values(const Experiment& experiment) {
  std::vector<double> values;
  for (const Axis& axis : experiment.axes()) {
    const auto parameter =
        std::ranges::find(experiment.scene().parameters, axis.name, &experiments::ParameterInfo::name);
    values.push_back(parameter->initial);
  }
  return values;
}

Breeding::Vector positions_of(const std::vector<Axis>& axes, const std::vector<double>& values) {
  Breeding::Vector positions;
  for (std::size_t i = 0; i < axes.size(); i++) positions.push_back(axes[i].position_of(values[i]));
  return positions;
}

// The presets of --from, or the scene's own values.
Result<std::vector<Breeding::Vector>> first_parents(const BreedCommand& command, const Experiment& experiment,
                                                    const PresetStore& store) {
  const std::vector<Axis>& axes = experiment.axes();
  const std::vector<double> initial = initial_values(experiment);
  if (command.from.empty()) return std::vector<Breeding::Vector>{positions_of(axes, initial)};
  if (command.from.size() > Breeding::kCount) return Error{fmt::format("--from: at most {} presets", Breeding::kCount)};
  const Result<engine::PresetList> presets = store.read();
  if (!presets) return Error{presets.error()};
  std::vector<std::string> names;
  for (const auto& preset : *presets) names.push_back(preset->name);
  std::vector<Breeding::Vector> parents;
  for (const std::string& name : command.from) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      return Error{fmt::format("--from {}: there is no such preset in {}{}", printable(name), printable(store.file),
                               name_hint(name, names))};
    const engine::Preset& preset = *(*presets)[static_cast<std::size_t>(found - names.begin())];
    parents.push_back(positions_of(axes, parameter_values(preset, axes, initial)));
  }
  return parents;
}

BreedSession::Options session_options(const BreedCommand& command, const Experiment& experiment, PresetStore store) {
  BreedSession::Options options;
  options.setup = {experiment.scene_path(), 0, {}};
  for (const Axis& axis : experiment.axes()) options.setup.parameters.push_back(axis.name);
  options.seed = experiment.seeds().front();
  const auto or_default = [](const std::string& text, const char* otherwise) {
    return text.empty() ? std::string(otherwise) : text;
  };
  options.command = {system::executable_path(), std::string(kVariationArgument), or_default(command.display.gl, "auto"),
                     or_default(command.display.quality, "auto")};
  options.presets = std::move(store);
  return options;
}

int run(const BreedCommand& command, BreedSession& session) {
  DisplayWatchdog watchdog;
  watchdog.start([] { end_program(kSuccess); });  // called only if the program is to end
  Result<std::unique_ptr<BreedWindow>> window =
      watchdog.call([&] { return BreedWindow::open(command.display, printable(command.common.scene)); });
  if (!window) return fail(kMachineError, fmt::format("breed needs a window: {}", window.error()));
  Window::on_display_lost([] { end_program(fail(kMachineError, "the display is lost")); });
  while (!system::signal_arrived()) {
    if (!watchdog.call([&] { return (*window)->frame(session); })) break;
  }
  watchdog.ending();
  watchdog.call([&] { window->reset(); });
  Window::on_display_lost({});
  return kSuccess;
}

}  // namespace

int breed_command(const BreedCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  std::optional<BreedSession> session;
  {
    Experiment experiment(command.common, nullptr);
    if (const std::optional<ExperimentFault> fault = experiment.open()) return fail(fault->code, fault->text);
    const std::string state = state_dir();
    PresetStore store{command.presets.empty() ? engine::PresetFile::path_for(experiment.scene_path())
                                              : absolute_path(command.presets),
                      state.empty() ? "" : state + "/locks"};
    Result<std::vector<Breeding::Vector>> parents = first_parents(command, experiment, store);
    if (!parents) return fail(kUsageError, parents.error());
    session.emplace(session_options(command, experiment, std::move(store)),
                    Breeding(experiment.axes(), *parents, kFirstAmount, command.search_seed));
  }
  return run(command, *session);
}

}  // namespace limber::app
