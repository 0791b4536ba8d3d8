// Finding, declaring and calling behavior files.
#include "script/behaviors/behavior_scripts.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/memory/archive.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "script/behaviors/lua_behavior.h"
#include "script/vm/vm.h"
#include "sim/behavior/behavior_list.h"

namespace limber::script {

namespace {

// all folders that may contain the file of a type
std::string searched_folders(const ScriptFiles& files) {
  std::string text;
  for (const std::string& folder : files.behavior_folders()) text += fmt::format("\n  {}", folder);
  return text;
}

}  // namespace

void BehaviorScripts::detach() {
  vm_ = nullptr;
  context_ = nullptr;
}

bool BehaviorScripts::is_loaded(std::string_view type) const {
  const std::string plain_name = sim::normalized_type_name(type);
  return std::ranges::any_of(files_,
                             [&](const BehaviorFile& f) { return sim::normalized_type_name(f.type) == plain_name; });
}

Result<std::int32_t> BehaviorScripts::read(std::string_view type) {
  const ScriptFiles& files = context_->files;
  const sim::BehaviorTypes& types = context_->world->behaviors().types();
  const std::string path = context_->sources->find_behavior(files, type);
  if (path.empty()) {
    std::vector<std::string> names = files.behavior_names();
    for (const auto& known : types.all()) names.push_back(known->name);
    return Error{fmt::format("there is no behavior type '{}'{}\nlooked for its file in{}", printable(type),
                             name_hint(type, names), searched_folders(files))};
  }
  Result<std::string> text = context_->sources->text(path);
  if (!text) return Error{text.error()};
  const std::string name = std::filesystem::path(path).stem().string();
  files_.push_back({name, path, files.display_path(path), std::move(*text)});
  generators_.emplace_back();
  return static_cast<std::int32_t>(files_.size()) - 1;
}

void BehaviorScripts::remove_last(std::int32_t file) {
  files_.resize(static_cast<std::size_t>(file));
  generators_.resize(files_.size());
}

Result<std::shared_ptr<const sim::BehaviorType>> BehaviorScripts::declare(std::int32_t number, std::string doc,
                                                                          bool is_group,
                                                                          std::vector<Property> parameters) {
  const std::string& name = file(number).type;
  const auto make = [scripts = shared_from_this(), number]() -> std::unique_ptr<sim::Behavior> {
    return std::make_unique<LuaBehavior>(scripts, number);
  };
  sim::BehaviorTypes& types = context_->world->behaviors().types();
  const Result<void> added = types.add(sim::BehaviorType::create(name, std::move(doc), sim::BehaviorTargets::any,
                                                                 is_group, std::move(parameters), make));
  if (!added) return Error{added.error()};
  return types.find(name);
}

Random& BehaviorScripts::generator(std::int32_t file) {
  save_generator(file);
  Generator& generator = generators_[static_cast<std::size_t>(file)].current;
  const std::uint64_t seed = context_->world->seed();
  const bool seed_changed = context_->answer.top_level != 0 && generator.seed != seed;
  if (!generator.seeded || seed_changed) {
    generator = {Random(seed, files_[static_cast<std::size_t>(file)].type + ".lua"), seed, true};
  }
  return generator.random;
}

// saves the state before the first draw of a call, so that a failed call can be rolled back
void BehaviorScripts::save_generator(std::int32_t file) {
  FileGenerator& generator = generators_[static_cast<std::size_t>(file)];
  sim::WorldTransaction& undo = context_->world->transaction();
  if (!undo.active() || std::exchange(generator.saved_in_call, context_->answer.call) == context_->answer.call) return;
  generator.saved = generator.current;
  undo.record(
      [](void* scripts, std::size_t number) {
        FileGenerator& generator = static_cast<BehaviorScripts*>(scripts)->generators_[number];
        generator.current = generator.saved;
      },
      this, static_cast<std::size_t>(file));
}

void BehaviorScripts::serialize(Archive& archive) { archive.serialize_all(generators_, released_); }

std::uint64_t BehaviorScripts::hash(std::uint64_t start) const {
  NumberHash numbers(start);
  for (const FileGenerator& generator : generators_) {
    if (generator.current.random.used()) numbers.add(generator.current.random.state());
  }
  return numbers.value();
}

// wraps every call into a behavior's functions
template <class Call>
sim::BehaviorFault BehaviorScripts::call_vm(Call call) {
  if (vm_ == nullptr) return {"the scene no longer uses this type; use it once at the top level", "", 0};
  for (const std::int32_t number : released_) vm_->behaviors().drop(number);
  released_.clear();
  const std::int32_t outer = std::exchange(context_->answer.in_behavior, 1);
  sim::BehaviorFault fault = call();
  context_->answer.in_behavior = outer;
  return fault;
}

std::int32_t BehaviorScripts::create(const sim::Behavior& behavior, std::int32_t file) {
  return vm_ == nullptr ? 0 : vm_->behaviors().make(file, behavior.id());
}

sim::BehaviorFault BehaviorScripts::start(std::int32_t number) {
  return call_vm([&] { return vm_->behaviors().start(number); });
}

sim::BehaviorFault BehaviorScripts::step(std::int32_t number, double dt) {
  return call_vm([&] { return vm_->behaviors().step(number, dt); });
}

void BehaviorScripts::step_all(StepBatch& batch, double dt) {
  StepBatch* const outer = std::exchange(batch_, &batch);
  sim::BehaviorFault fault = call_vm([&] { return vm_->behaviors().step_all(dt, batch.current); });
  batch_ = outer;
  if (fault.text.empty()) return;
  // Nothing was stepped: there is no Vm any more, or a replay skips this call. The fault belongs to the first running
  // instance.
  if (batch.next == 0) {
    while (batch.changed && batch.next + 1 < batch.members.size() && !batch.members[batch.next]->runs()) batch.next++;
    batch.next++;
  }
  batch.changed = true;
  static_cast<LuaBehavior&>(*batch.members[batch.next - 1]).fail(std::move(fault));
}

std::int32_t BehaviorScripts::next_step() {
  StepBatch& batch = *batch_;
  if (batch.current != 0 && !vm_->guard().next_call(batch.changed)) return 0;
  batch.current = 0;
  if (batch.changed) {
    while (batch.next < batch.members.size() && !batch.members[batch.next]->runs()) batch.next++;
  }
  if (batch.next == batch.members.size()) return 0;
  batch.current = batch.numbers[batch.next++];
  return batch.current;
}

sim::BehaviorFault BehaviorScripts::restore(std::int32_t number, std::string_view state, bool migrate) {
  return call_vm([&] { return vm_->behaviors().restore(number, state, migrate); });
}

Result<std::string> BehaviorScripts::state(std::int32_t number) {
  if (vm_ == nullptr) return Error{"the script of this behavior no longer exists"};
  return vm_->behaviors().state(number);
}

void BehaviorScripts::release(std::int32_t number) {
  if (vm_ != nullptr) released_.push_back(number);
}

}  // namespace limber::script
