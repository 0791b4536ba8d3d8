// BehaviorScripts: the files of behaviors_lua/ that a scene's run has loaded, and the way from a behaviour in the world
// to its functions in the Vm. Behaviours share it, and may outlive the Vm. [sim]
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
#include "sim/behavior.h"

namespace limber {

class KeyBytes;
struct ScriptContext;
class Vm;

/// A file of behaviors_lua/, as it was when the run loaded it.
struct BehaviorFile {
  std::string type;   ///< Its name without the ending.
  std::string path;   ///< Where it lies.
  std::string shown;  ///< As messages call it.
  std::string text;   ///< Its whole text.
};

class BehaviorScripts : public std::enable_shared_from_this<BehaviorScripts> {
 public:
  /// Context and Vm are there until close().
  explicit BehaviorScripts(ScriptContext& context) : context_(&context) {}

  void open(Vm& vm) { vm_ = &vm; }
  /// The Vm goes: behaviours that still hang on it do nothing from now on.
  void close();

  /// The files of this run, in the order in which they were loaded.
  std::span<const BehaviorFile> files() const { return files_; }
  /// Whether the run has loaded a type of that name, by the naming rule.
  bool knows(std::string_view type) const;
  /// Reads the file of a type; its number among the files. Errors list every place that was looked at.
  Result<std::int32_t> read(std::string_view type);
  /// A file that did not load is none of the run's.
  void forget(std::int32_t file);
  BehaviorFile& file(std::int32_t number) { return files_[static_cast<std::size_t>(number)]; }
  /// Adds the type of a file to the world's, with these parameters.
  Result<std::shared_ptr<const BehaviorType>> declare(std::int32_t file, std::string doc, bool is_group,
                                                      std::vector<Row> parameters);
  /// The generator that `rng` and math.random draw from in a file's functions.
  Random& generator(std::int32_t file);
  /// A key state takes generators and what waits, and brings them back.
  void pass_memory(KeyBytes& key);
  /// With the bits of the files' generators.
  std::uint64_t hash(std::uint64_t start) const;

  // Calls of one instance, by its number in the Vm; a fault without text: it went well.
  /// Introduces a behaviour to the Vm: its number there, 0 when the Vm is gone.
  std::int32_t make(const Behavior& behavior, std::int32_t file);
  BehaviorFault start(std::int32_t number);
  BehaviorFault step(std::int32_t number, double dt);
  /// Instances of a file that are stepped one after the other.
  struct StepRow {
    std::span<Behavior* const> all;
    std::span<const std::int32_t> numbers;  ///< In the Vm.
    bool changed = false;                   ///< Some may have been switched off since it was known that all run.
    std::size_t next = 0;                   ///< Which comes next.
    std::int32_t stepping = 0;              ///< Which steps now, by its number; 0: none.
  };
  /// Steps them in one call of the Vm, each guarded by itself: one that fails is suspended, and is the last. It comes
  /// to one at least.
  void step_all(StepRow& row, double dt);
  /// In the middle of step_all: the step before went well; the number of the next instance, 0: there is none.
  std::int32_t next_step();
  /// Gives the instance the state of an older one; `migrate`: through the function of that name, if the file has it.
  BehaviorFault restore(std::int32_t number, std::string_view state, bool migrate);
  /// Its `state` as text, for another Vm. The error names the key that holds what can't be kept.
  Result<std::string> state(std::int32_t number);
  /// The instance is no longer needed.
  void drop(std::int32_t number);

 private:
  struct Generator {
    Random random;
    std::uint64_t seed = 0;
    bool seeded = false;
  };
  /// One, and what it was when the guarded call began that drew from it last.
  struct FileGenerator {
    Generator now, before;
    std::int32_t kept_in = 0;
  };
  void keep_generator(std::int32_t file);
  template <class Call>
  BehaviorFault inside(Call call);

  ScriptContext* context_;
  Vm* vm_ = nullptr;
  std::vector<BehaviorFile> files_;
  std::vector<FileGenerator> generators_;  // one a file
  std::vector<std::int32_t> dropped_;      // not told to the Vm yet
  StepRow* row_ = nullptr;                 // of the call that runs
};

}  // namespace limber
