// Finding, declaring, calling.
#include "script/behavior_scripts.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/key_bytes.h"
#include "base/text.h"
#include "script/context.h"
#include "script/lua_behavior.h"
#include "script/vm.h"
#include "sim/behavior_list.h"

namespace limber {

namespace {

// every place where the file of a type could have been
std::string places(const ScriptFiles& files) {
  std::string text;
  for (const std::string& folder : files.behavior_folders()) text += fmt::format("\n  {}", folder);
  return text;
}

}  // namespace

void BehaviorScripts::close() {
  vm_ = nullptr;
  context_ = nullptr;
}

bool BehaviorScripts::knows(std::string_view type) const {
  const std::string wanted = plain_type_name(type);
  return std::ranges::any_of(files_, [&](const BehaviorFile& f) { return plain_type_name(f.type) == wanted; });
}

Result<std::int32_t> BehaviorScripts::read(std::string_view type) {
  const ScriptFiles& files = context_->files;
  const BehaviorTypes& types = context_->world->behaviors().types();
  const std::string path = context_->sources->find_behavior(files, type);
  if (path.empty()) {
    std::vector<std::string> names = files.behavior_names();
    for (const auto& known : types.all()) names.push_back(known->name);
    return Error{fmt::format("there is no behavior type '{}'{}\nlooked for its file in{}", printable(type),
                             name_hint(type, names), places(files))};
  }
  Result<std::string> text = context_->sources->text(path);
  if (!text) return Error{text.error()};
  const std::string name = std::filesystem::path(path).stem().string();
  files_.push_back({name, path, files.shown(path), std::move(*text)});
  generators_.emplace_back();
  return static_cast<std::int32_t>(files_.size()) - 1;
}

void BehaviorScripts::forget(std::int32_t file) {
  files_.resize(static_cast<std::size_t>(file));
  generators_.resize(files_.size());
}

Result<std::shared_ptr<const BehaviorType>> BehaviorScripts::declare(std::int32_t number, std::string doc,
                                                                     bool is_group, std::vector<Row> parameters) {
  const std::string& name = file(number).type;
  const auto make = [scripts = shared_from_this(), number]() -> std::unique_ptr<Behavior> {
    return std::make_unique<LuaBehavior>(scripts, number);
  };
  BehaviorTypes& types = context_->world->behaviors().types();
  const Result<void> added =
      types.add(BehaviorType::of(name, std::move(doc), BehaviorTargets::any, is_group, std::move(parameters), make));
  if (!added) return Error{added.error()};
  return types.find(name);
}

Random& BehaviorScripts::generator(std::int32_t file) {
  keep_generator(file);
  Generator& generator = generators_[static_cast<std::size_t>(file)].now;
  const std::uint64_t seed = context_->world->seed();
  const bool later_seed = context_->answer.top_level != 0 && generator.seed != seed;
  if (!generator.seeded || later_seed) {
    generator = {Random(seed, files_[static_cast<std::size_t>(file)].type + ".lua"), seed, true};
  }
  return generator.random;
}

// before it is drawn from: a failing call has not drawn
void BehaviorScripts::keep_generator(std::int32_t file) {
  FileGenerator& generator = generators_[static_cast<std::size_t>(file)];
  WorldUndo& undo = context_->world->undo();
  if (!undo.active() || std::exchange(generator.kept_in, context_->answer.call) == context_->answer.call) return;
  generator.before = generator.now;
  undo.note(
      [](void* scripts, std::size_t number) {
        FileGenerator& generator = static_cast<BehaviorScripts*>(scripts)->generators_[number];
        generator.now = generator.before;
      },
      this, static_cast<std::size_t>(file));
}

void BehaviorScripts::pass_memory(KeyBytes& key) { key.pass_all(generators_, dropped_); }

std::uint64_t BehaviorScripts::hash(std::uint64_t start) const {
  NumberHash numbers(start);
  for (const FileGenerator& generator : generators_) {
    if (generator.now.random.drawn()) numbers.add(generator.now.random.state());
  }
  return numbers.value();
}

// what every call into a behaviour's functions goes through
template <class Call>
BehaviorFault BehaviorScripts::inside(Call call) {
  if (vm_ == nullptr) return {"the scene no longer names this type; name it once at the top level", "", 0};
  for (const std::int32_t number : dropped_) vm_->drop_behavior(number);
  dropped_.clear();
  const std::int32_t outer = std::exchange(context_->answer.in_behavior, 1);
  BehaviorFault fault = call();
  context_->answer.in_behavior = outer;
  return fault;
}

std::int32_t BehaviorScripts::make(const Behavior& behavior, std::int32_t file) {
  return vm_ == nullptr ? 0 : vm_->make_behavior(file, behavior.id());
}

BehaviorFault BehaviorScripts::start(std::int32_t number) {
  return inside([&] { return vm_->start_behavior(number); });
}

BehaviorFault BehaviorScripts::step(std::int32_t number, double dt) {
  return inside([&] { return vm_->step_behavior(number, dt); });
}

void BehaviorScripts::step_all(StepRow& row, double dt) {
  StepRow* const outer = std::exchange(row_, &row);
  BehaviorFault fault = inside([&] { return vm_->step_behaviors(dt, row.stepping); });
  row_ = outer;
  if (fault.text.empty()) return;
  // without a Vm nobody came to step, nor in a call that a replay does not make
  if (row.next == 0) {
    while (row.changed && row.next + 1 < row.all.size() && !row.all[row.next]->runs()) row.next++;
    row.next++;
  }
  row.changed = true;
  static_cast<LuaBehavior&>(*row.all[row.next - 1]).fail(std::move(fault));
}

std::int32_t BehaviorScripts::next_step() {
  StepRow& row = *row_;
  if (row.stepping != 0 && !vm_->guard().next_call(row.changed)) return 0;
  row.stepping = 0;
  if (row.changed) {
    while (row.next < row.all.size() && !row.all[row.next]->runs()) row.next++;
  }
  if (row.next == row.all.size()) return 0;
  row.stepping = row.numbers[row.next++];
  return row.stepping;
}

BehaviorFault BehaviorScripts::restore(std::int32_t number, std::string_view state, bool migrate) {
  return inside([&] { return vm_->restore_behavior(number, state, migrate); });
}

Result<std::string> BehaviorScripts::state(std::int32_t number) {
  if (vm_ == nullptr) return Error{"the script of this behaviour is gone"};
  return vm_->behavior_state(number);
}

void BehaviorScripts::drop(std::int32_t number) {
  if (vm_ != nullptr) dropped_.push_back(number);
}

}  // namespace limber
