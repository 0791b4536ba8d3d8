// A scene's run and callbacks, implemented with the Vm.
#include "script/scene/scene.h"

#include <filesystem>

#include "script/api/script_context.h"
#include "script/scene/earlier_runs.h"
#include "script/vm/vm.h"

namespace limber::script {

Scene::Scene(sim::World& world, ScriptHost& host, SceneOptions options, VmMode wanted)
    : earlier_(std::make_unique<EarlierRuns>()),
      context_(std::make_unique<ScriptContext>(world, host, std::move(options))),
      vm_(std::make_unique<Vm>(*context_, wanted)) {}

Scene::~Scene() = default;

Result<void> Scene::run(const std::string& file, const RunInputs* detached) {
  ScriptContext& c = *context_;
  if (detached != nullptr && detached->sources != nullptr) c.sources = std::make_shared<Sources>(detached->sources);
  if (c.options.sources != nullptr) c.sources = std::make_shared<Sources>(c.options.sources);
  c.files = ScriptFiles(file, c.options.data_dir);
  fault_ = {c.files.display_path(file), 0};
  const Result<std::string> text = c.sources->text(file);
  if (!text) return Error{text.error()};
  c.random.set_name(std::filesystem::path(file).filename().string());
  if (c.options.seed) {
    const auto seed = static_cast<double>(*c.options.seed);
    const Result<SetOutcome> set = c.world->store().set(c.world->id(), "seed", {&seed, 1});
    if (!set) return Error{set.error()};
  }
  if (detached != nullptr) {
    c.params.previous = detached->params;
    c.world->restart_time(detached->tick, detached->time);
    vm_->begin_detached(detached->state);
  }
  if (detached == nullptr) vm_->set_run_number(run_number_);
  c.answer.top_level = 1;
  Result<void> result = vm_->run(*text, c.files.display_path(file), c.sources->added_text(c.options.added), fault_);
  c.generator();  // seed the generator with the seed set by the top level
  c.answer.top_level = 0;
  c.params.previous = {};
  c.sources->close();
  if (result && detached == nullptr) c.host.configure_osc(c.osc.config);
  return result;
}

std::shared_ptr<const Sources> Scene::sources() const { return context_->sources; }

void Scene::set_call_log(CallLog& calls) { vm_->guard().set_call_log(calls); }

void Scene::set_limits(const ScriptLimits& limits) {
  vm_->guard().set_limits(limits);
  context_->options.limits = limits;
  context_->options.keep_timers = true;
  earlier_->set_limits(limits);
}

void Scene::start() { vm_->start(); }

void Scene::tick(double dt) {
  context_->timers.checked_at = context_->world->time();
  earlier_->apply_cancellations(*context_, context_->world->tick());
  earlier_->tick(*vm_, context_->world->tick());
  vm_->tick(dt);
}

const std::vector<SceneResult>& Scene::compute_results() {
  vm_->compute_results();
  return context_->output.results;
}

RunOutput& Scene::output() { return context_->output; }

bool Scene::has_handlers() const { return context_->osc.handlers > 0; }

std::size_t Scene::disabled_handlers() const { return static_cast<std::size_t>(context_->osc.disabled_handlers); }

bool Scene::handle_message(const Message& message, const CommandOrigin& origin) {
  if (!has_handlers()) return false;
  ScriptContext& c = *context_;
  c.osc.sender = origin;
  c.osc.handling_message = true;
  const bool handled = vm_->handle_message(message, origin);
  c.osc.handling_message = false;
  return handled;
}

void Scene::collect_garbage() {
  vm_->collect_garbage();
  earlier_->collect_garbage();
}

std::uint64_t Scene::state_hash(std::uint64_t start) const { return earlier_->hash(context_->hash(start)); }

void Scene::set_resimulating(bool on) {
  vm_->guard().set_resimulating(on);
  earlier_->set_resimulating(on);
  context_->output.rows.set_muted(on);
}

VmMode Scene::mode() const { return vm_->mode(); }

bool Scene::enable_jit() { return vm_->enable_jit(); }

void Scene::disable_jit() { vm_->disable_jit(); }

Evaluation Scene::evaluate(std::string_view text) { return vm_->query("evaluate", text); }

Evaluation Scene::complete(std::string_view text) { return vm_->query("complete", text); }

std::string Scene::names() { return vm_->names(); }

const std::string& Scene::show_folder() const { return context_->files.show_folder(); }

}  // namespace limber::script
