// ShowState: the running show, shared by the parts of the engine: its session, and everything that outlives the session
// when a reset or another scene replaces it. [sim]
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/background_writer.h"
#include "engine/commands/handler_queue.h"
#include "engine/cues/cue_player.h"
#include "engine/edits/edit_scope.h"
#include "engine/edits/overrides.h"
#include "engine/engine_options.h"
#include "engine/history/history.h"
#include "engine/input/input_source.h"
#include "engine/output/show_output.h"
#include "engine/pacer.h"
#include "engine/presets/presets.h"
#include "engine/session.h"
#include "script/vm/call_log.h"

namespace limber::engine {

/// The engine's rules that apply: while a take is replayed those of the version that recorded it, else the newest.
struct ShowRules {
  bool before_first_revision = false;          ///< See kTakeRules.
  bool before_second_revision = false;         ///< See kTakeRules.
  bool frames_scenes = true;                   ///< The default view frames the bodies of a scene.
  bool keeps_timers = true;                    ///< Reloads keep timers, and console texts set overrides.
  std::optional<script::ScriptLimits> limits;  ///< Limits of scripts, instead of those in the options.
};

struct ShowState {
  /// Starts with an empty session.
  ShowState(EngineLink& link, EngineOptions options);

  /// Returns an empty session. [any]
  std::unique_ptr<Session> new_session();
  /// Sets the rules, also of the present session.
  void set_rules(const ShowRules& new_rules);
  /// Options for runs of the scene, by the rules that apply.
  script::SceneOptions scene_options() const;
  Output& output() { return outputs.current(); }
  /// Makes the writes during its lifetime edits of a controller.
  EditScope edit_scope() { return {session->world, presets, undo_stack, output().changes()}; }
  /// Ends a pass in the history.
  void end_history_pass(bool running);
  /// Restores the newest checkpoint before this tick and discards everything since, except presets. False, without a
  /// change, if there is none.
  bool restore_before(std::uint64_t tick);
  /// Sets the state of the cues and publishes it, so that routes read it in this tick.
  void set_cue_state(CueState state);
  /// Sends /transport/state.
  void send_transport();
  /// Hash of the world, the scene and the random number generators.
  std::uint64_t state_hash() const;

  EngineLink& link;
  EngineOptions options;
  BackgroundWriter writer;                        ///< Of presets, takes and recovered values.
  const std::shared_ptr<ThreadPool> thread_pool;  ///< Null: the simulation thread alone.
  std::shared_ptr<const Preset> recovered;        ///< Values to restore at the start; null: none.
  ShowRules rules;
  InputSource* input = nullptr;  ///< The source of inputs: live controllers, or the take that is replayed.
  Outputs outputs{link};
  Pacer pacer;
  Overrides overrides;
  Presets presets{overrides};
  UndoStack undo_stack{overrides};
  HandlerQueue handler_queue;            ///< Messages that wait for the scene's handlers.
  std::vector<Message> preset_requests;  ///< Preset commands of scripts in this tick.
  CuePlayer cues;
  History history{overrides, undo_stack, presets, cues, handler_queue};
  script::CallLog call_log;
  std::unique_ptr<Session> session;
  std::string added;             ///< SceneOptions::added of this scene.
  std::uint64_t scene_seed = 0;  ///< The random seed after the scene's run.
};

}  // namespace limber::engine
