// Earlier runs: their timers, and remapping of their handles.
#include "script/scene/earlier_runs.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/hash.h"
#include "properties/values_hash.h"
#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/vm/vm.h"
#include "sim/behavior/behavior_group.h"
#include "sim/world/body.h"

namespace limber::script {

namespace {

// Unique key of an object: names from the node to the root, and the type of a behavior. Separated by zero bytes, which
// names can't contain.
std::string object_key(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  std::string name;
  if (const sim::Behavior* behavior = behavior_of(c, id)) name = behavior->type().name;
  if (const sim::BehaviorGroup* group = group_of(c, id)) name = group->type().name;
  for (NodeId at = id; !at.null(); at = store.parent(at)) {
    name += '\0';
    name += store.name(at);
  }
  return name;
}

}  // namespace

void HandleNames::capture(const ScriptContext& context) {
  names_.clear();
  for (const std::int32_t* const handle : context.arguments.handle_ids) {
    const NodeId id = id_of(handle[0], handle[1]);
    names_.push_back(context.alive(id) ? object_key(context, id) : std::string());
  }
}

void HandleNames::resolve(const ScriptContext& context) const {
  const Store& store = context.world->store();
  std::unordered_map<std::string, NodeId> found;  // filled on first use
  for (std::size_t i = 0; i < names_.size(); i++) {
    std::int32_t* const handle = context.arguments.handle_ids[i];
    if (context.alive(id_of(handle[0], handle[1]))) continue;
    if (found.empty() && !names_[i].empty())
      store.walk(store.root(), [&](NodeId id) { found.emplace(object_key(context, id), id); });
    const auto at = names_[i].empty() ? found.end() : found.find(names_[i]);
    handle[0] = at == found.end() ? -1 : static_cast<std::int32_t>(at->second.slot);
    if (at != found.end()) handle[1] = static_cast<std::int32_t>(at->second.generation);
  }
}

EarlierRuns::Run::Run(std::unique_ptr<ScriptContext> new_context, std::unique_ptr<Vm> new_vm)
    : context(std::move(new_context)), vm(std::move(new_vm)) {}
EarlierRuns::Run::~Run() = default;
EarlierRuns::Run::Run(Run&&) noexcept = default;
EarlierRuns::Run& EarlierRuns::Run::operator=(Run&& other) noexcept {
  vm = std::move(other.vm);  // first, because the Vm uses the context
  context = std::move(other.context);
  handle_names = std::move(other.handle_names);
  number = other.number;
  timers = other.timers;
  ended_at = other.ended_at;
  state = std::move(other.state);
  return *this;
}

EarlierRuns::EarlierRuns() = default;
EarlierRuns::~EarlierRuns() = default;

void EarlierRuns::capture_handles() {
  for (Run& run : runs_) {
    run.vm->gather_handles();
    run.handle_names.capture(*run.context);
  }
}

void EarlierRuns::resolve_handles(NodeId params) {
  for (Run& run : runs_) {
    run.handle_names.resolve(*run.context);
    run.context->params.live = params;
    run.vm->handles_moved();
    run.context->arguments.handle_ids = {};
  }
}

// Each run keeps its memory and may allocate a little more, so the total stays below 17 times the limit.
ScriptLimits EarlierRuns::limits_of(const Run& run, const ScriptLimits& limits) {
  ScriptLimits own = limits;
  own.memory = run.vm->guard().memory().used() + limits.memory / kMaxRuns;
  return own;
}

std::uint64_t EarlierRuns::add(Run run) {
  // a reload restarts the history, so no rewind can reach the time when ended runs had timers
  std::erase_if(runs_, [](const Run& old) { return old.timers == 0; });
  run.timers = run.vm->callback_timers().timers;
  run.state = run.vm->state_text();
  run.vm->guard().set_limits(limits_of(run, run.context->options.limits));
  runs_.push_back(std::move(run));
  if (runs_.size() <= kMaxRuns) return 0;
  const std::uint64_t ended = runs_.front().timers;
  runs_.erase(runs_.begin());
  return ended;
}

void EarlierRuns::apply_cancellations(ScriptContext& by, std::uint64_t tick) {
  for (const SceneTimers::Cancellation& request : by.timers.cancellations) {
    const auto run = std::ranges::find_if(runs_, [&](const Run& each) {
      return each.number == static_cast<std::uint64_t>(request.run) && each.timers > 0;
    });
    if (run == runs_.end()) continue;
    run->vm->cancel_timer(request.number);
    run->timers = run->vm->callback_timers().timers;
    if (run->timers == 0) run->ended_at = tick;
  }
  by.timers.cancellations.clear();
}

void EarlierRuns::tick(Vm& live, std::uint64_t tick) {
  for (Run& run : runs_) {
    if (run.timers == 0 || !run.vm->timers_due()) continue;
    const std::string before = live.state_text();
    if (before != run.state) run.vm->apply_state_changes(run.state, before);
    run.timers = run.vm->run_timers();
    run.state = run.vm->state_text();
    if (run.state != before) live.apply_state_changes(before, run.state);
    if (run.timers == 0) run.ended_at = tick;
    apply_cancellations(*run.context, tick);
  }
}

void EarlierRuns::collect_garbage() {
  for (Run& run : runs_) run.vm->collect_garbage();
}

void EarlierRuns::set_resimulating(bool on) {
  for (Run& run : runs_) run.vm->guard().set_resimulating(on);
}

void EarlierRuns::set_limits(const ScriptLimits& limits) {
  for (Run& run : runs_) run.vm->guard().set_limits(limits_of(run, limits));
}

std::uint64_t EarlierRuns::hash(std::uint64_t start) const {
  std::uint64_t all = start;
  for (const Run& run : runs_) {
    if (run.timers == 0) continue;
    NumberHash numbers(run.context->hash(all));
    numbers.add_word(run.timers);
    all = numbers.value();
  }
  return all;
}

void EarlierRuns::release_ended(std::uint64_t before) {
  std::erase_if(runs_, [&](const Run& run) { return run.timers == 0 && run.ended_at < before; });
}

EarlierRuns::Counts EarlierRuns::counts() {
  Counts all;
  for (Run& run : runs_) {
    const auto [timers, repeating] = run.vm->callback_timers();
    all.timers += timers;
    all.repeating += repeating;
  }
  return all;
}

}  // namespace limber::script
