// Stage: everything that one run of a scene lives in. A reset builds a new one and takes it only when it is good. [sim]
#pragma once

#include <memory>
#include <string>

#include "engine/dispatch.h"
#include "engine/edit_node.h"
#include "engine/link.h"
#include "engine/preset_node.h"
#include "engine/publish.h"
#include "engine/take_node.h"
#include "engine/transport.h"
#include "script/scene.h"

namespace limber {

struct Stage {
  Stage(EngineLink& link, Presets& presets, Edits& edits, const WorldSetup& setup)
      : world(store, setup),
        transport(world, link.health),
        counters(store, link.counters),
        preset_node(world, presets),
        edit_node(world, edits),
        take_node(world),
        dispatch(world, &presets),
        publisher(world, link.snapshots) {
    dispatch.use(link.health);
  }

  /// Runs the scene's file; without one the world stays empty.
  Result<void> run(const std::string& file, ScriptHost& host, const SceneOptions& options) {
    hear_faults(host);
    if (file.empty()) return {};
    scene = std::make_unique<Scene>(world, host, options);
    return scene->run(file);
  }

  /// The same beside another stage that plays; begin() has it heard and compiled once that one rests. [any]
  Result<void> run_beside(const std::string& file, ScriptHost& host, const SceneOptions& options) {
    scene = std::make_unique<Scene>(world, host, options);
    const RunInputs none;
    Result<void> ran = scene->run(file, &none);
    if (ran) scene->prepare();
    return ran;
  }
  void begin(ScriptHost& host) {
    hear_faults(host);
    scene->become_live(
        world, [](NodeId id) { return id; }, nullptr);
  }

  void hear_faults(ScriptHost& host) {
    world.behaviors().on_fault([&host](const Behavior& behavior) {
      const BehaviorFault& fault = behavior.fault();
      const std::string path = behavior.store().path(behavior.id());
      if (fault.file.empty()) return host.script_error(path, fault.line, path + ": " + fault.text);
      host.script_error(fault.file, fault.line, fault.text + "\nof " + path);
    });
  }

  /// The number of one of the world's rows.
  double world_value(std::string_view row) const { return store.values(world.id(), World::table().at(row))[0]; }

  Store store;
  World world;
  Transport transport;
  CounterNode counters;
  PresetNode preset_node;
  EditNode edit_node;
  TakeNode take_node;
  Dispatch dispatch;
  Publisher publisher;
  std::unique_ptr<Scene> scene;  // last: it goes first
};

}  // namespace limber
