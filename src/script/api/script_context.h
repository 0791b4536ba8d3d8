// ScriptContext: the state that the functions of the C API work on; one per scene run. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "model/urdf/import.h"
#include "script/api/c_api.h"
#include "script/api/force_queue.h"
#include "script/api/params_node.h"
#include "script/scene/run_inputs.h"
#include "script/scene/scene_options.h"
#include "script/scene/script_files.h"
#include "script/scene/script_host.h"
#include "script/scene/sources.h"
#include "script/vm/pattern_match.h"
#include "sim/neighbors/neighbor_set.h"
#include "sim/world/world.h"

namespace limber {

class BehaviorScripts;
class CallLog;
class Guard;

struct ScriptContext {
  ScriptContext(World& w, ScriptHost& h, SceneOptions o);
  ~ScriptContext();
  ScriptContext(const ScriptContext&) = delete;
  ScriptContext& operator=(const ScriptContext&) = delete;

  World* world;                ///< Replaced when a detached run goes live; null after the run was replaced.
  StoreView view;              ///< View of that world's store; its address is constant for the life of the context.
  MassTable::View mass_table;  ///< View of that world's mass table.
  /// Attaches the views to that world, or detaches them (null).
  void set_world(World* new_world);
  ScriptHost& host;
  SceneOptions options;
  ScriptFiles files;
  std::shared_ptr<Sources> sources = std::make_shared<Sources>();
  const RunInputs* detached_inputs = nullptr;  ///< During a detached run: the data of the live scene that it may read.

  LimberAnswer answer{};
  std::string text;  ///< Storage of `answer.text`.
  LimberProperty property_info{};
  MatchSearch search;  ///< Ends early when the running call is to be stopped.
  Match match;

  // Generator of the scene's file, seeded with the world's seed and the file name; seeded again when the top level
  // changes the seed.
  std::string random_name;
  std::optional<std::uint64_t> seeded_with;
  Random random;
  Random& generator();
  /// Returns the hash continued with the states of used generators and the values of the scene's parameters.
  std::uint64_t hash(std::uint64_t start) const;

  // collected by several API calls before the one that uses them
  std::vector<Vec3> mesh_points;
  ImportOptions import;
  BuildOptions build;
  Message message;
  std::vector<Property> param_properties;
  std::array<Selection, 5> selections;  ///< Parts, joints, motors, bodies, neighbor parts.

  // iterations over neighbors; nested loops use several at a time
  static constexpr std::size_t kMaxIterations = 16;
  std::array<LimberIteration, kMaxIterations> iterations{};
  std::array<std::vector<Neighbor>, kMaxIterations> neighbor_lists;
  LimberGroupMeans group_means{};  ///< Neighbor means of a whole group, as last requested; valid until the call ends.

  // Models and meshes that the run has loaded, by request: callbacks can reuse them, but must not read from disk.
  std::map<std::string, std::shared_ptr<const BodyModel>> loaded_models;
  std::map<std::string, std::shared_ptr<const MeshModel>> loaded_meshes;
  OscConfig osc_config;
  CommandOrigin sender;  ///< Of the message being handled.
  bool handling_message = false;
  std::int32_t handlers = 0;           ///< Number registered by osc:on.
  std::int32_t disabled_handlers = 0;  ///< Number of these that are disabled because they failed or were stopped.
  std::unique_ptr<ParamsNode> params;
  NodeId live_params;                  ///< Of an earlier run, which has no parameters: the live run's node, or null.
  std::uint64_t rerun_properties = 0;  ///< Bit mask of the parameters with `rerun`, by property index.
  std::optional<double> timers_at;     ///< Time at which timers were last checked.
  std::span<std::int32_t* const> handle_ids;   ///< Slot and generation of every handle, while the handles are remapped.
  std::shared_ptr<BehaviorScripts> behaviors;  ///< Shared with the behaviors in the world.

  // Requests of a guarded call that are carried out only when it succeeds: messages, presets, reset, panic, forces.
  Guard* guard = nullptr;       ///< Of the scene's Vm.
  CallLog* call_log = nullptr;  ///< Counts the calls; may be null.
  enum class Route : std::uint8_t { all, sender, direct };
  struct PendingMessage {
    Route route;
    CommandOrigin to;
    Message message;
  };
  std::vector<PendingMessage> pending_messages;
  std::size_t pending_text_bytes = 0;  ///< Bytes of text in them.
  std::vector<Message> preset_requests;
  struct TimerCancellation {
    std::int32_t run;
    std::int32_t number;
  };
  std::vector<TimerCancellation>
      cancellations;  ///< Timers of earlier runs to cancel, by successful calls and the current one.
  std::size_t cancellations_before_call = 0;  ///< Number of those by successful calls.
  bool reset_requested = false;
  bool panic_requested = false;
  ForceQueue forces;
  /// Starts recording changes for a rollback.
  void begin_call();
  /// Success: sends the messages. Failure: rolls back all changes, including random draws.
  void end_call(bool success);
  /// Ends a successful call and begins another. Returns true if the ended call did more than apply forces; otherwise
  /// the switch costs almost nothing.
  bool next_call();

  // results for Lua
  std::int32_t set_text(std::string new_text);
  std::int32_t reject(std::string reason) {
    set_text(std::move(reason));
    return kRejected;
  }
  std::int32_t set_id(NodeId id);
  bool alive(NodeId id) const { return world->store().alive(id); }

 private:
  void count_call();
  Random random_before_;
  std::optional<std::uint64_t> seeded_before_;
};

inline ScriptContext& context_of(void* c) { return *static_cast<ScriptContext*>(c); }
inline NodeId id_of(std::int32_t slot, std::int32_t generation) {
  return {static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(generation)};
}
inline std::string_view text_of(const char* text, std::int32_t length) {
  return {text, static_cast<std::size_t>(length)};
}
/// Returns the object with this id if it exists and is of class T, else null.
template <class T>
T* object_of(const ScriptContext& c, NodeId id) {
  if (!c.alive(id) || &c.world->store().table(id) != &T::table()) return nullptr;
  return static_cast<T*>(c.world->store().object(id));
}
/// Returns the behavior or group with this id, or null.
Behavior* behavior_of(const ScriptContext& c, NodeId id);
BehaviorGroup* group_of(const ScriptContext& c, NodeId id);
/// Returns the name of an object for messages: "motor 'arm/joint_2'", "body 'arm'", "sim".
std::string label_of(const ScriptContext& c, NodeId id);

}  // namespace limber
