// Scene: a Lua file that says what exists, and its callbacks that act. Made anew for each run. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/message.h"
#include "base/result.h"
#include "script/host.h"
#include "script/scene_options.h"

namespace limber {

class World;
class Vm;
struct ScriptContext;

class Scene {
 public:
  /// World and host outlive the scene. What a scene made in the world stays when the scene goes, but its parameters.
  /// Live when that is wanted and no other scene of the process is: only one can run compiled.
  Scene(World& world, ScriptHost& host, SceneOptions options, VmMode wanted = VmMode::live);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Runs the file: the top level. The error has file:line: what, the source line and the traceback. Once only.
  Result<void> run(const std::string& file);
  /// The callbacks of on_start; the world is settled before.
  void start();
  /// Timers, contacts of the tick before, on_step with `dt` seconds, each in the order of registration.
  void tick(double dt);
  /// Whether any osc:on handler is registered.
  bool listens() const;
  /// Calls the osc:on handlers that fit, in order of registration; false when none does.
  bool message(const Message& message, const Origin& origin);
  /// After each tick: about 100 µs at most, nothing while there is little to collect.
  void collect_garbage();
  VmMode mode() const;
  /// Draft to live: once the other scene has gone, or was disarmed; false while it has not.
  bool arm();
  void disarm();
  /// A world's hash with the bits of the scene's generator and parameters.
  std::uint64_t state_hash(std::uint64_t start) const;
  /// Every name that a scene sees, one a line: globals, library.member, thing.member, thing:method.
  std::string names();
  /// The folder that the scene's show lives in.
  const std::string& show_folder() const;

 private:
  std::unique_ptr<ScriptContext> context_;
  std::unique_ptr<Vm> vm_;
};

}  // namespace limber
