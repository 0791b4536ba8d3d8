// ScriptContext: what the functions behind the door work on; one for each scene. [sim]
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
#include "model/urdf_import.h"
#include "script/c_api.h"
#include "script/files.h"
#include "script/force_queue.h"
#include "script/host.h"
#include "script/match.h"
#include "script/params_node.h"
#include "script/run_inputs.h"
#include "script/scene_options.h"
#include "script/sources.h"
#include "sim/neighbors.h"
#include "sim/world.h"

namespace limber {

class BehaviorScripts;
class CallLedger;
class Guard;

struct ScriptContext {
  ScriptContext(World& w, ScriptHost& h, SceneOptions o);
  ~ScriptContext();
  ScriptContext(const ScriptContext&) = delete;
  ScriptContext& operator=(const ScriptContext&) = delete;

  World* world;    ///< Another one once a run beside the show becomes the show; null once it was replaced.
  StoreView view;  ///< Of that world's store: one address for the life of the context.
  PartSolids::View solids;
  /// The views become those of that world, or of none.
  void look_at(World* other);
  ScriptHost& host;
  SceneOptions options;
  ScriptFiles files;
  std::shared_ptr<Sources> sources = std::make_shared<Sources>();
  const RunInputs* beside = nullptr;  ///< During a run beside the show: what it may read of it.

  LimberAnswer answer{};
  std::string text;  ///< What `answer.text` points to.
  LimberRow row{};
  MatchSearch search;  ///< Ends early when the call is to be stopped.
  Match match;

  // generator of the scene's file: of the seed and the file's name, anew when the top level changes the seed
  std::string random_name;
  std::optional<std::uint64_t> seeded_with;
  Random random;
  Random& generator();
  /// The world's hash with the bits of the generators that were drawn from, and of the scene's parameters.
  std::uint64_t hash(std::uint64_t start) const;

  // gathered by several calls before the one that makes something of them
  std::vector<Vec3> mesh_points;
  ImportOptions import;
  BuildOptions build;
  Message message;
  std::vector<Row> param_rows;
  std::array<Selection, 5> selections;  ///< Of parts, joints, motors, bodies, neighbour parts.

  // walks over neighbours, several at a time where loops stand inside each other
  static constexpr std::size_t kWalks = 16;
  std::array<LimberWalk, kWalks> walks{};
  std::array<std::vector<Neighbor>, kWalks> found;
  LimberMeansOfAll means_of_all{};  ///< The means that were asked for last, of a whole group; until the call ends.

  // what the run loaded, by what it asked for: callbacks may have it again, since they must not wait for a disk
  std::map<std::string, std::shared_ptr<const BodyModel>> loaded_models;
  std::map<std::string, std::shared_ptr<const MeshModel>> loaded_meshes;
  OscPlan plan;
  Origin sender;  ///< Of the message that is handled now.
  bool handling_message = false;
  std::int32_t handlers = 0;           ///< Registered by osc:on.
  std::int32_t disabled_handlers = 0;  ///< Of these: failed or were stopped.
  std::unique_ptr<ParamsNode> params;
  NodeId params_of_show;            ///< Of an earlier run, which has none itself: those of the run that plays, or none.
  std::uint64_t rerun_rows = 0;     ///< Parameters with `rerun`, a bit a row.
  std::optional<double> timers_at;  ///< Time at which timers were looked at last.
  std::span<std::int32_t* const> things;       ///< Slot and generation of every handle, while these are given others.
  std::shared_ptr<BehaviorScripts> behaviors;  ///< Shared with the behaviours that live in the world.

  // guarded calls: what one asks of the outside waits until it has ended well
  Guard* guard = nullptr;       ///< Of the scene's Vm.
  CallLedger* calls = nullptr;  ///< Who counts them, where somebody does.
  enum class Way : std::uint8_t { all, sender, direct };
  struct Held {
    Way way;
    Origin to;
    Message message;
  };
  std::vector<Held> held;
  std::size_t held_text = 0;  ///< Bytes of text in them.
  std::vector<Message> preset_wishes;
  struct Cancel {
    std::int32_t run;
    std::int32_t number;
  };
  std::vector<Cancel> cancels;          ///< Timers of earlier runs, by this call and by those that ended well.
  std::size_t cancels_before_call = 0;  ///< Those of the latter.
  bool reset_wanted = false;
  bool panic_wanted = false;
  ForceQueue forces;
  /// From here on everything that a script does is kept for the undo.
  void begin_call();
  /// A good one's messages go out; a bad one is taken back, its random draws too.
  void end_call(bool good);
  /// Ends a good one and begins another; whether it did more than push parts. Where not, it costs next to nothing.
  bool next_call();

  // answers
  std::int32_t say(std::string what);
  std::int32_t refuse(std::string why) {
    say(std::move(why));
    return kRefused;
  }
  std::int32_t tell(NodeId id);
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
/// The thing of an id when it is alive and of that class, else null.
template <class T>
T* thing_of(const ScriptContext& c, NodeId id) {
  if (!c.alive(id) || &c.world->store().table(id) != &T::table()) return nullptr;
  return static_cast<T*>(c.world->store().thing(id));
}
/// The behaviour, or the group, of an id, when it is alive and one, else null.
Behavior* behavior_of(const ScriptContext& c, NodeId id);
BehaviorGroup* group_of(const ScriptContext& c, NodeId id);
/// How errors name a thing: "motor 'arm/joint_2'", "body 'arm'", "sim".
std::string label_of(const ScriptContext& c, NodeId id);

}  // namespace limber
