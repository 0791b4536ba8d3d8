// ScriptContext: the state that the functions of the C API work on; one per scene run. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/import_options.h"
#include "model/policy/policy_network.h"
#include "script/api/c_api.h"
#include "script/api/call_effects.h"
#include "script/api/params_node.h"
#include "script/api/scene_random.h"
#include "script/scene/run_output.h"
#include "script/scene/scene_options.h"
#include "script/scene/script_files.h"
#include "script/scene/script_host.h"
#include "script/scene/sources.h"
#include "script/vm/guard.h"
#include "script/vm/pattern_match.h"
#include "sim/behavior/selection.h"
#include "sim/mocap/mocap_setup.h"
#include "sim/neighbors/neighbor_set.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {
class Behavior;
class BehaviorGroup;
class Sensor;
}  // namespace limber::sim

namespace limber::script {

class BehaviorScripts;

/// The result of the last API call and facts about the running script call (`top_level`, `call`, `in_behavior`), which
/// the prelude reads.
class Answer : public LimberAnswer {
 public:
  Answer() : LimberAnswer{} {}
  std::int32_t set_text(std::string new_text);
  std::int32_t set_id(NodeId id);
  LimberProperty property{};  ///< The property that was last asked for.

 private:
  std::string text_storage_;
};

/// Memory of a world that compiled Lua reads. The addresses of the views are constant.
struct WorldViews {
  StoreView store;
  sim::MassTable::View masses;
};

/// Options of a source of motion capture, as a script has given them.
struct MocapArguments {
  sim::MocapSetup setup;
  std::string file, dialect, dancer, up, handed, quaternion;
};

/// Arguments that several API calls collect before the call that uses them.
struct CollectedArguments {
  std::vector<Vec3> mesh_points;
  model::ImportOptions import;
  sim::BuildOptions build;
  Message message;
  std::vector<Property> parameters;
  MocapArguments mocap;
  std::array<sim::Selection, 5> selections;   ///< Parts, joints, motors, bodies, neighbor parts.
  std::span<std::int32_t* const> handle_ids;  ///< Slot and generation of every handle, while the handles are remapped.
};

/// Results of neighbor searches.
struct NeighborResults {
  static constexpr std::size_t kMaxIterations = 16;
  /// Iterations and the lists that they iterate over; nested loops use several at a time.
  std::array<LimberIteration, kMaxIterations> iterations{};
  std::array<std::vector<sim::Neighbor>, kMaxIterations> lists;
  std::vector<sim::NearPart> near_parts;  ///< Of the last search around a point.
  LimberGroupMeans group_means{};         ///< Means of a whole group, as last requested; valid until the call ends.
};

/// Policies that the run has loaded, in the order of the calls, and memory for their evaluation.
struct LoadedPolicies {
  static constexpr std::size_t kMax = 1000;
  std::vector<std::shared_ptr<const model::PolicyNetwork>> networks;
  std::vector<float> workspace;
};

/// Models and meshes that the run has loaded, by file name and import options: callbacks can reuse them, but must not
/// read from disk.
struct LoadedModels {
  std::map<std::string, std::shared_ptr<const model::BodyModel>> models;
  std::map<std::string, std::shared_ptr<const model::MeshModel>> meshes;
  LoadedPolicies policies;
};

/// OSC ports and handlers of the scene.
struct SceneOsc {
  OscConfig config;
  std::vector<StreamMessage> templates;  ///< For the next target.
  CommandOrigin sender;                  ///< Of the message being handled.
  bool handling_message = false;
  std::int32_t handlers = 0;           ///< Number registered by osc:on.
  std::int32_t disabled_handlers = 0;  ///< Number of these that are disabled because they failed or were stopped.
};

/// Time of the last check of timers, and requests to cancel timers of earlier runs.
struct SceneTimers {
  struct Cancellation {
    std::int32_t run;
    std::int32_t number;
  };
  std::optional<double> checked_at;         ///< Time at which timers were last checked.
  std::vector<Cancellation> cancellations;  ///< Committed ones first, then those of the running call.
  std::size_t committed_count = 0;

  void begin_call() { committed_count = cancellations.size(); }
  /// True if the running call has canceled a timer.
  bool canceled() const { return cancellations.size() > committed_count; }
  void rollback() { cancellations.resize(committed_count); }
};

struct ScriptContext final : CallHooks {
  ScriptContext(sim::World& w, ScriptHost& h, SceneOptions o);
  ~ScriptContext();
  ScriptContext(const ScriptContext&) = delete;
  ScriptContext& operator=(const ScriptContext&) = delete;

  sim::World*
      world;  ///< Replaced when a detached run goes live; null after the run was replaced, unless its timers continue.
  WorldViews views;
  /// Attaches the views to that world, or detaches them (null).
  void set_world(sim::World* new_world);
  ScriptHost& host;
  SceneOptions options;
  ScriptFiles files;
  std::shared_ptr<Sources> sources = std::make_shared<Sources>();

  Answer answer;
  CollectedArguments arguments;
  PatternMatcher pattern_matcher;  ///< Ends early when the running call is to be stopped.
  NeighborResults neighbors;
  LoadedModels loaded;
  SceneOsc osc;
  SceneParams params;
  SceneTimers timers;
  SceneRandom random;
  RunOutput output;
  std::shared_ptr<BehaviorScripts> behaviors;  ///< Shared with the behaviors in the world.

  Guard* guard = nullptr;  ///< Of the scene's Vm.
  CallEffects effects;
  /// Starts recording changes for a rollback.
  void begin_call() override;
  /// Success: sends the messages. Failure: rolls back all changes, including random draws.
  void end_call(bool success) override;
  /// Ends a successful call and begins another. Returns true if the ended call did more than apply forces; otherwise
  /// the switch costs almost nothing.
  bool next_call() override;

  /// The generator of the scene's file.
  Random& generator() { return random.generator(world->seed(), answer.top_level != 0); }
  /// Returns the hash continued with the states of used generators and the values of the scene's parameters.
  std::uint64_t hash(std::uint64_t start) const;
  bool alive(NodeId id) const { return world->store().alive(id); }

  // results for Lua
  std::int32_t set_text(std::string text) { return answer.set_text(std::move(text)); }
  std::int32_t set_id(NodeId id) { return answer.set_id(id); }
  std::int32_t reject(std::string reason) {
    set_text(std::move(reason));
    return kRejected;
  }

 private:
  void count_call();
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
sim::Behavior* behavior_of(const ScriptContext& c, NodeId id);
sim::BehaviorGroup* group_of(const ScriptContext& c, NodeId id);
/// Returns the sensor of any kind with this id, or null.
sim::Sensor* sensor_of(const ScriptContext& c, NodeId id);
/// True, with an error as the answer, if the scene can't have more objects: a loop that creates them could exhaust the
/// memory before it is stopped.
bool is_full(ScriptContext& c);
/// Returns the name of an object for messages: "motor 'arm/joint_2'", "body 'arm'", "sim".
std::string label_of(const ScriptContext& c, NodeId id);

}  // namespace limber::script
