// ShowState: sessions, and the parts of the state that are saved and restored together.
#include "engine/show_state.h"

#include <utility>

namespace limber::engine {

ShowState::ShowState(EngineLink& engine_link, EngineOptions engine_options)
    : link(engine_link),
      options(std::move(engine_options)),
      thread_pool(options.threads > 1 ? std::make_shared<ThreadPool>(options.threads) : nullptr),
      session(new_session()) {}

std::unique_ptr<Session> ShowState::new_session() {
  sim::WorldSetup setup;
  setup.thread_pool = thread_pool;
  auto fresh = std::make_unique<Session>(link, presets, cues, undo_stack, setup, options.lockstep);
  fresh->world.kinematics().set_static_parts_move(!rules.before_second_revision);
  return fresh;
}

void ShowState::set_rules(const ShowRules& new_rules) {
  rules = new_rules;
  session->world.kinematics().set_static_parts_move(!rules.before_second_revision);
}

script::SceneOptions ShowState::scene_options() const {
  script::SceneOptions scene_options = options.scene_options;
  scene_options.added = added;
  if (rules.limits) scene_options.limits = *rules.limits;
  if (!rules.keeps_timers) scene_options.keep_timers = false;
  if (rules.before_first_revision) scene_options.limits.disable_failed_handlers = false;
  return scene_options;
}

void ShowState::end_history_pass(bool running) {
  history.end_pass(*session, call_log, running, options.embedded ? 0 : session->world_value("history"));
}

bool ShowState::restore_before(std::uint64_t tick) {
  const PresetList list = presets.list();
  if (!history.validate(*session) || !history.restore_before(*session, tick)) return false;
  presets.set_list(list);
  handler_queue.clear();
  preset_requests.clear();
  call_log.record_rewind();
  return true;
}

void ShowState::set_cue_state(CueState state) {
  cues.set_state(std::move(state));
  session->cue_node.publish();
}

void ShowState::send_transport() {
  const bool paused = session->transport.paused();
  outputs.set_sent_paused(paused);
  output().push({Outgoing::Destination::event,
                 {},
                 {"/transport/state",
                  {Arg::of(paused), Arg::of(static_cast<double>(session->world.tick())), Arg::of(session->world.time()),
                   Arg::of(pacer.speed_reached())}}});
}

std::uint64_t ShowState::state_hash() const {
  const std::uint64_t hash = session->world.state_hash();
  return session->scene == nullptr ? hash : session->scene->state_hash(hash);
}

}  // namespace limber::engine
