// BehaviorScripts: the files of behaviors_lua/ that a scene's run has loaded, and the calls from behaviors in the world
// to their functions in the Vm. Shared by those behaviors, which may outlive the Vm. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/id.h"
#include "base/random.h"
#include "base/result.h"
#include "sim/behavior/behavior.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::script {

struct ScriptContext;
class Vm;

/// A file of behaviors_lua/ as the run loaded it.
struct BehaviorFile {
  std::string type;          ///< File name without the extension.
  std::string path;          ///< Full path.
  std::string display_path;  ///< Path as shown in messages.
  std::string text;          ///< Contents.
};

class BehaviorScripts : public std::enable_shared_from_this<BehaviorScripts> {
 public:
  /// Context and Vm must exist until detach().
  explicit BehaviorScripts(ScriptContext& context) : context_(&context) {}

  void attach(Vm& vm) { vm_ = &vm; }
  /// Detaches from the Vm, which is about to be destroyed: further calls of behaviors return an error.
  void detach();

  /// The files of this run in the order in which they were loaded.
  std::span<const BehaviorFile> files() const { return files_; }
  /// True if the run has loaded a type of that name (compared by the naming rule).
  bool is_loaded(std::string_view type) const;
  /// Reads the file of a type and returns its index in files(). The error lists all folders that were searched.
  Result<std::int32_t> read(std::string_view type);
  /// Removes the last file, which failed to load.
  void remove_last(std::int32_t file);
  BehaviorFile& file(std::int32_t number) { return files_[static_cast<std::size_t>(number)]; }
  /// Registers the file's type, with these parameters, in the world.
  Result<std::shared_ptr<const sim::BehaviorType>> declare(std::int32_t file, std::string doc, bool is_group,
                                                           std::vector<Property> parameters);
  /// Returns the generator for `rng` and math.random in a file's functions.
  Random& generator(std::int32_t file);
  /// Serializes the generators, and the numbers of instances to be released, for a checkpoint.
  void serialize(Archive& archive);
  /// Returns the hash continued with the state of the generators that have been used.
  std::uint64_t hash(std::uint64_t start) const;

  // Calls of one instance, identified by its number in the Vm. A fault without text means success.
  /// Registers a behavior in the Vm. Returns its number, or 0 if there is no Vm any more.
  std::int32_t create(const sim::Behavior& behavior, std::int32_t file);
  sim::BehaviorFault start(std::int32_t number);
  sim::BehaviorFault step(std::int32_t number, double dt);
  /// Instances of one file that are stepped in one call of the Vm.
  struct StepBatch {
    std::span<sim::Behavior* const> members;
    std::span<const std::int32_t> numbers;  ///< Their numbers in the Vm.
    bool changed = false;                   ///< Some may no longer run, so runs() must be checked.
    std::size_t next = 0;                   ///< Index of the next instance.
    std::int32_t current = 0;               ///< Number of the instance that is being stepped; 0: none.
  };
  /// Steps the instances in one call of the Vm, each as a guarded call of its own (Guard::next_call). Stops after an
  /// instance that fails, which is suspended. `batch.next` advances by at least one.
  void step_all(StepBatch& batch, double dt);
  /// Called between two instances: the previous one succeeded. Returns the number of the next instance; 0 ends the
  /// call.
  std::int32_t next_step();
  /// Gives the instance an older state; `migrate`: through its `migrate` function, if the file has one.
  sim::BehaviorFault restore(std::int32_t number, std::string_view state, bool migrate);
  /// Returns its `state` serialized as text. The error names the key of a value that can't be serialized.
  Result<std::string> state(std::int32_t number);
  /// Releases the instance's data in the Vm, at the next call.
  void release(std::int32_t number);

 private:
  struct Generator {
    Random random;
    std::uint64_t seed = 0;
    bool seeded = false;
  };
  /// A generator, and its state at the start of the last guarded call that used it (for rollback).
  struct FileGenerator {
    Generator current, saved;
    std::int32_t saved_in_call = 0;
  };
  void save_generator(std::int32_t file);
  template <class Call>
  sim::BehaviorFault call_vm(Call call);

  ScriptContext* context_;
  Vm* vm_ = nullptr;
  std::vector<BehaviorFile> files_;
  std::vector<FileGenerator> generators_;  // one per file
  std::vector<std::int32_t> released_;     // not yet released in the Vm
  StepBatch* batch_ = nullptr;             // of the step_all() call in progress
};

}  // namespace limber::script
