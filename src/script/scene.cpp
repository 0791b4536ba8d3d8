// A scene's run and its callbacks, on top of the Vm.
#include "script/scene.h"

#include <filesystem>

#include "script/context.h"
#include "script/earlier_runs.h"
#include "script/vm.h"

namespace limber {

Scene::Scene(World& world, ScriptHost& host, SceneOptions options, VmMode wanted)
    : earlier_(std::make_unique<EarlierRuns>()),
      context_(std::make_unique<ScriptContext>(world, host, std::move(options))),
      vm_(std::make_unique<Vm>(*context_, wanted)) {}

Scene::~Scene() = default;

Result<void> Scene::run(const std::string& file, const RunInputs* beside) {
  ScriptContext& c = *context_;
  if (beside != nullptr && beside->sources != nullptr) c.sources = std::make_shared<Sources>(beside->sources);
  if (c.options.sources != nullptr) c.sources = std::make_shared<Sources>(c.options.sources);
  c.files = ScriptFiles(file, c.options.data_dir);
  fault_ = {c.files.shown(file), 0};
  const Result<std::string> text = c.sources->text(file);
  if (!text) return Error{text.error()};
  c.random_name = std::filesystem::path(file).filename().string();
  if (c.options.seed) {
    const auto seed = static_cast<double>(*c.options.seed);
    const Result<SetOutcome> set = c.world->store().set(c.world->id(), "seed", {&seed, 1});
    if (!set) return Error{set.error()};
  }
  if (beside != nullptr) {
    c.beside = beside;
    c.world->restart_time(beside->tick, beside->time);
    vm_->begin_beside(beside->state);
  }
  if (beside == nullptr) vm_->number_run(run_number_);
  c.answer.top_level = 1;
  Result<void> ran = vm_->run(*text, c.files.shown(file), fault_);
  c.generator();  // the seed as the top level leaves it
  c.answer.top_level = 0;
  c.beside = nullptr;
  c.sources->close();
  if (ran && beside == nullptr) c.host.plan_osc(c.plan);
  return ran;
}

std::shared_ptr<const Sources> Scene::sources() const { return context_->sources; }

void Scene::count_calls(CallLedger& calls) { context_->calls = &calls; }

void Scene::limit(const ScriptLimits& limits) {
  vm_->guard().limit(limits);
  context_->options.limits = limits;
  context_->options.keep_timers = true;
  earlier_->limit(limits);
}

void Scene::start() { vm_->start(); }

void Scene::tick(double dt) {
  context_->timers_at = context_->world->time();
  earlier_->cancel(*context_, context_->world->tick());
  earlier_->tick(*vm_, context_->world->tick());
  vm_->tick(dt);
}

bool Scene::listens() const { return context_->handlers > 0; }

std::size_t Scene::disabled_handlers() const { return static_cast<std::size_t>(context_->disabled_handlers); }

bool Scene::message(const Message& message, const Origin& origin) {
  if (!listens()) return false;
  ScriptContext& c = *context_;
  c.sender = origin;
  c.handling_message = true;
  const bool heard = vm_->message(message, origin);
  c.handling_message = false;
  return heard;
}

void Scene::collect_garbage() {
  vm_->collect_garbage();
  earlier_->collect_garbage();
}

std::uint64_t Scene::state_hash(std::uint64_t start) const { return earlier_->hash(context_->hash(start)); }

void Scene::do_again(bool on) {
  vm_->guard().do_again(on);
  earlier_->do_again(on);
}

VmMode Scene::mode() const { return vm_->mode(); }

bool Scene::arm() { return vm_->arm(); }

void Scene::disarm() { vm_->disarm(); }

Evaluation Scene::evaluate(std::string_view text) { return vm_->ask("evaluate", text); }

Evaluation Scene::complete(std::string_view text) { return vm_->ask("complete", text); }

std::string Scene::names() { return vm_->names(); }

const std::string& Scene::show_folder() const { return context_->files.show_folder(); }

}  // namespace limber
