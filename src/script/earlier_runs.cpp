// Runs that were replaced: their timers, and where their handles point.
#include "script/earlier_runs.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/hash.h"
#include "params/values_hash.h"
#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/vm.h"

namespace limber {

namespace {

// names from the node up to the root, and the type of a behavior; no name has a 0 in it
std::string name_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  std::string name;
  if (const Behavior* behavior = behavior_of(c, id)) name = behavior->type().name;
  if (const BehaviorGroup* group = group_of(c, id)) name = group->type().name;
  for (NodeId at = id; !at.null(); at = store.parent(at)) {
    name += '\0';
    name += store.name(at);
  }
  return name;
}

}  // namespace

void HandleNames::note(const ScriptContext& context) {
  names_.clear();
  for (const std::int32_t* const handle : context.things) {
    const NodeId id = id_of(handle[0], handle[1]);
    names_.push_back(context.alive(id) ? name_of(context, id) : std::string());
  }
}

void HandleNames::follow(const ScriptContext& context) const {
  const Store& store = context.world->store();
  std::unordered_map<std::string, NodeId> found;  // filled when the first is looked for
  for (std::size_t i = 0; i < names_.size(); i++) {
    std::int32_t* const handle = context.things[i];
    if (context.alive(id_of(handle[0], handle[1]))) continue;
    if (found.empty() && !names_[i].empty())
      store.walk(store.root(), [&](NodeId id) { found.emplace(name_of(context, id), id); });
    const auto at = names_[i].empty() ? found.end() : found.find(names_[i]);
    handle[0] = at == found.end() ? -1 : static_cast<std::int32_t>(at->second.slot);
    if (at != found.end()) handle[1] = static_cast<std::int32_t>(at->second.generation);
  }
}

EarlierRuns::Run::Run(std::unique_ptr<ScriptContext> its_context, std::unique_ptr<Vm> its_vm)
    : context(std::move(its_context)), vm(std::move(its_vm)) {}
EarlierRuns::Run::~Run() = default;
EarlierRuns::Run::Run(Run&&) noexcept = default;
EarlierRuns::Run& EarlierRuns::Run::operator=(Run&& other) noexcept {
  vm = std::move(other.vm);  // first: it works on the context
  context = std::move(other.context);
  names = std::move(other.names);
  number = other.number;
  timers = other.timers;
  ended_at = other.ended_at;
  state = std::move(other.state);
  return *this;
}

EarlierRuns::EarlierRuns() = default;
EarlierRuns::~EarlierRuns() = default;

void EarlierRuns::note_things() {
  for (Run& run : runs_) {
    run.vm->gather_handles();
    run.names.note(*run.context);
  }
}

void EarlierRuns::follow_things(NodeId params) {
  for (Run& run : runs_) {
    run.names.follow(*run.context);
    run.context->params_of_show = params;
    run.vm->handles_moved();
    run.context->things = {};
  }
}

// What it has made stays, and it may take a little more: all runs together stay within a known multiple of the limit.
ScriptLimits EarlierRuns::limits_of(const Run& run, const ScriptLimits& limits) {
  ScriptLimits own = limits;
  own.memory = run.vm->guard().memory().used() + limits.memory / kMax;
  return own;
}

std::uint64_t EarlierRuns::add(Run run) {
  // a run begins history again, so nothing goes back to where the ended ones had timers
  std::erase_if(runs_, [](const Run& old) { return old.timers == 0; });
  run.timers = run.vm->callback_timers().timers;
  run.state = run.vm->state_text();
  run.vm->guard().limit(limits_of(run, run.context->options.limits));
  runs_.push_back(std::move(run));
  if (runs_.size() <= kMax) return 0;
  const std::uint64_t ended = runs_.front().timers;
  runs_.erase(runs_.begin());
  return ended;
}

void EarlierRuns::cancel(ScriptContext& by, std::uint64_t tick) {
  for (const ScriptContext::Cancel& wish : by.cancels) {
    const auto run = std::ranges::find_if(
        runs_, [&](const Run& each) { return each.number == static_cast<std::uint64_t>(wish.run) && each.timers > 0; });
    if (run == runs_.end()) continue;
    run->vm->cancel_timer(wish.number);
    run->timers = run->vm->callback_timers().timers;
    if (run->timers == 0) run->ended_at = tick;
  }
  by.cancels.clear();
}

void EarlierRuns::tick(Vm& show, std::uint64_t tick) {
  for (Run& run : runs_) {
    if (run.timers == 0 || !run.vm->timers_due()) continue;
    const std::string before = show.state_text();
    if (before != run.state) run.vm->change_state(run.state, before);
    run.timers = run.vm->run_timers();
    run.state = run.vm->state_text();
    if (run.state != before) show.change_state(before, run.state);
    if (run.timers == 0) run.ended_at = tick;
    cancel(*run.context, tick);
  }
}

void EarlierRuns::collect_garbage() {
  for (Run& run : runs_) run.vm->collect_garbage();
}

void EarlierRuns::do_again(bool on) {
  for (Run& run : runs_) run.vm->guard().do_again(on);
}

void EarlierRuns::limit(const ScriptLimits& limits) {
  for (Run& run : runs_) run.vm->guard().limit(limits_of(run, limits));
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

}  // namespace limber
