// Session: the objects of one run of the scene: the world, the other nodes of the property tree (transport, counters,
// presets, undo, takes) and the Lua scene. A reset builds a new session and installs it only if the scene has run
// without an error. [sim]
#pragma once

#include <memory>
#include <string>

#include "engine/commands/message_dispatcher.h"
#include "engine/cues/cue_node.h"
#include "engine/edits/edit_node.h"
#include "engine/output/counter_node.h"
#include "engine/output/engine_link.h"
#include "engine/output/midi_node.h"
#include "engine/output/publisher.h"
#include "engine/presets/node.h"
#include "engine/takes/take_node.h"
#include "engine/transport.h"
#include "script/scene/scene.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine {

struct Session {
  Session(EngineLink& link, Presets& presets, const CuePlayer& cues, UndoStack& undo_stack,
          const sim::WorldSetup& setup, bool lockstep = false)
      : world(store, setup),
        transport(world, link.health, lockstep),
        counters(store, link.counters, link.osc),
        midi_node(store, link.midi),
        preset_node(world, presets),
        cue_node(world, cues),
        edit_node(world, undo_stack),
        take_node(world),
        dispatcher(world, &presets),
        publisher(world, link.snapshots) {
    dispatcher.set_health(link.health);
    dispatcher.set_cues(cues);
  }

  /// Runs the scene file. If `file` is empty, the world stays empty.
  Result<void> run(const std::string& file, script::ScriptHost& host, const script::SceneOptions& options) {
    report_faults_to(host);
    if (file.empty()) return {};
    scene = std::make_unique<script::Scene>(world, host, options);
    return scene->run(file);
  }

  /// Runs the scene file detached, while another session is live. Call make_live() to make it live. [any]
  Result<void> run_detached(const std::string& file, script::ScriptHost& host, const script::SceneOptions& options) {
    scene = std::make_unique<script::Scene>(world, host, options);
    const script::RunInputs no_inputs;
    Result<void> ran = scene->run(file, &no_inputs);
    if (ran) scene->prepare();
    return ran;
  }
  /// Makes a scene that has run detached the live one. [sim]
  void make_live(script::ScriptHost& host) {
    report_faults_to(host);
    scene->become_live(
        world, [](NodeId id) { return id; }, nullptr);
  }

  /// Reports faults of behaviors to `host` as script errors.
  void report_faults_to(script::ScriptHost& host) {
    world.behaviors().on_fault([&host](const sim::Behavior& behavior) {
      const sim::BehaviorFault& fault = behavior.fault();
      const std::string path = behavior.store().path(behavior.id());
      if (fault.file.empty()) return host.script_error(path, fault.line, path + ": " + fault.text);
      host.script_error(fault.file, fault.line, fault.text + "\nof " + path);
    });
  }

  /// Returns the first number of a property of the world.
  double world_value(std::string_view property) const {
    return store.values(world.id(), sim::World::table().at(property))[0];
  }

  Store store;
  sim::World world;
  Transport transport;
  CounterNode counters;
  MidiNode midi_node;
  PresetNode preset_node;
  CueNode cue_node;
  EditNode edit_node;
  TakeNode take_node;
  MessageDispatcher dispatcher;
  Publisher publisher;
  std::unique_ptr<script::Scene> scene;  // last member, because it must be destroyed first
};

}  // namespace limber::engine
