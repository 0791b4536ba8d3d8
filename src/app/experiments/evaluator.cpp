// A run of the scene for each evaluation.
#include "app/experiments/evaluator.h"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/text.h"
#include "engine/engine.h"
#include "script/scene/scene.h"

namespace limber::app {

namespace {

using experiments::ParameterInfo;

// parameters that can be varied: numbers, booleans and choices
std::vector<ParameterInfo> parameters_of(engine::Engine& engine) {
  std::vector<ParameterInfo> parameters;
  const NodeId node = engine.scene()->params();
  if (!engine.store().alive(node)) return parameters;
  for (const Property& property : engine.store().table(node).properties()) {
    if (property.width != 1) continue;
    ParameterInfo info{property.name, property.low(0), property.high(0), property.initial[0], property.choices, false};
    info.whole = property.type == PropertyType::boolean || property.type == PropertyType::choice;
    parameters.push_back(std::move(info));
  }
  return parameters;
}

}  // namespace

std::string script_error(engine::EngineLink& link) {
  std::vector<engine::Outgoing> sent;
  link.output_queue.drain(sent);
  for (const engine::Outgoing& out : sent) {
    if (out.message.address == "/script/error" && out.message.args.size() == 3)
      return out.message.args[2].text.substr(0, out.message.args[2].text.find('\n'));
  }
  return {};
}

engine::EngineOptions Evaluator::options_of(const experiments::Evaluation& evaluation) const {
  engine::EngineOptions options;
  options.scene = setup_.scene;
  options.scene_options.data_dir = data_dir();
  options.scene_options.seed = evaluation.seed;
  options.fast = true;
  options.print = false;
  options.files.saves_presets = false;
  options.duration = setup_.duration;
  for (std::size_t i = 0; i < std::min(parameters_.size(), evaluation.values.size()); i++) {
    const ParameterInfo& parameter = *parameters_[i];
    const double value = evaluation.values[i];
    const bool is_choice = !parameter.choices.empty();
    const auto choice = static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(parameter.choices.size())));
    options.params.push_back(
        {"/scene/" + parameter.name,
         {is_choice && choice < parameter.choices.size() ? Arg::of(parameter.choices[choice]) : Arg::of(value)}});
  }
  return options;
}

engine::EngineOptions Evaluator::options_to_play(const experiments::Evaluation& evaluation) const {
  engine::EngineOptions options = options_of(evaluation);
  options.fast = false;
  options.duration.reset();
  return options;
}

Result<experiments::SceneInfo> Evaluator::set_up(experiments::WorkerSetup setup) {
  setup_ = std::move(setup);
  parameters_.clear();
  const auto link = std::make_unique<engine::EngineLink>();
  engine::Engine engine(*link, options_of({0, 1, {}}));
  if (const Result<void> started = engine.start(); !started) return Error{started.error()};
  scene_ = {};
  scene_.parameters = parameters_of(engine);
  for (const script::SceneResult& result : engine.scene()->output().results)
    scene_.results.push_back({result.name, result.min, result.max, result.cells});
  scene_.hash = engine.state_hash();
  for (const std::string& name : setup_.parameters) {
    const auto found = std::ranges::find(scene_.parameters, name, &ParameterInfo::name);
    if (found == scene_.parameters.end())
      return Error{fmt::format("the scene no longer has the parameter '{}'", printable(name))};
    parameters_.push_back(&*found);
  }
  return scene_;
}

experiments::Outcome Evaluator::evaluate(const experiments::Evaluation& evaluation) {
  experiments::Outcome outcome;
  outcome.number = evaluation.number;
  const auto link = std::make_unique<engine::EngineLink>();
  engine::Engine engine(*link, options_of(evaluation));
  if (const Result<void> started = engine.start(); !started) {
    outcome.error = started.error().substr(0, started.error().find('\n'));
    return outcome;
  }
  const double no_history = 0;  // rewinding needs one; the state hash doesn't contain it
  (void)engine.store().set(engine.world().id(), "history", {&no_history, 1});
  engine.run();
  outcome.hash = engine.state_hash();
  outcome.error = script_error(*link);
  if (outcome.error.empty() && engine.world().stability().events() > 0)
    outcome.error = "a body became unstable";
  else if (outcome.error.empty() && engine.faults() > 0)
    outcome.error = "the scene reported an error";
  for (const script::SceneResult& result : engine.scene()->compute_results()) {
    outcome.results.push_back(result.value);
    if (outcome.error.empty()) outcome.error = result.error;
  }
  return outcome;
}

}  // namespace limber::app
