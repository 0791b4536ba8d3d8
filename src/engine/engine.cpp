// Engine: start, the loop and the phases of a pass.
#include "engine/engine.h"

#include <utility>

#include "base/log/log.h"
#include "base/math/fixed_math.h"
#include "base/system/clock.h"
#include "base/text.h"

namespace limber::engine {

Engine::Engine(EngineLink& link, EngineOptions options) : show_(link, std::move(options)) {
  show_.input = &live_input_;
  link.wake_engine = [this] {
    if (show_.options.lockstep) {
      show_.pacer.wake();
    } else {
      show_.pacer.notify_commands();
    }
  };
}

Engine::~Engine() {
  end_take();
  show_.link.wake_engine = [] {};
  show_.session = nullptr;  // before its host, which is in scenes_
}

Result<void> Engine::start() {
  if (!show_.options.replay.empty()) {
    Result<void> started = playback_.start();
    if (started) publish();
    return started;
  }
  recovery_.open();
  if (!show_.options.record.empty()) {
    if (Result<void> recorded = recording_.start(); !recorded) return recorded;
  }
  show_.presets.open(scenes_.read_presets(show_.options.scene));
  show_.presets.suspend_saving(!show_.options.files.saves_presets);
  if (Result<void> cues = cues_.start(); !cues) return cues;
  Result<void> started = scenes_.start();
  if (started) {
    publish();
    recording_.end_pass(false, true);
  } else {
    recording_.abandon();
  }
  recovery_.begin();
  return started;
}

void Engine::run() {
  SimThreadExecutor& requests = scenes_.requests();
  Pacer& pacer = show_.pacer;
  requests.open();
  pacer.start(show_.options.lockstep);
  while (!pacer.stopped() && !finished()) {
    show_.options.on_iteration();
    if (!show_.input->is_paced()) {
      pacer.begin_unpaced_tick(world().timestep());
      run_pass(true);
    } else if (pacer.wait_for_tick(requests)) {
      pacer.begin_tick(*show_.session);
      run_pass(true);
    } else if (pacer.consume_commands() || show_.link.panic_signal.load() || !show_.handler_queue.empty()) {
      run_pass(show_.options.lockstep);
    }
  }
  requests.close();
  end_take();
}

bool Engine::finished() const {
  const EngineOptions& options = show_.options;
  const sim::World& world = show_.session->world;
  if (show_.input->finished()) return true;
  if (options.strict && faults() > 0) return true;
  if (options.ticks && world.tick() >= *options.ticks) return true;
  return options.duration && world.time() >= *options.duration - 1e-9;
}

void Engine::run_pass(bool may_step) {
  fixed::reset_arithmetic();
  system::Stopwatch watch;
  show_.call_log.begin_pass();
  scenes_.requests().serve();
  if (!playback_.begin_pass()) return;
  scenes_.rerun_if_requested();
  show_.session->dispatcher.begin_pass();
  (void)
      show_.session->transport.consume_rewind();  // drops a request that `--set /transport/rewind …` left at the start
  (void)show_.session->cue_node.consume_request();  // the same for cues
  InputSource& input = *show_.input;
  input.execute_messages(may_step);
  times_.commands = watch.lap();

  const bool running = input.advances_time(may_step);
  simulator_.simulate(running, input, times_);
  watch.lap();

  execute_reset_and_take_requests(running);
  health_.update(recovery_.owned_elsewhere());
  publish();
  make_value_snapshot();
  if (show_.outputs.sent_paused() != show_.session->transport.paused()) show_.send_transport();
  times_.snapshot = watch.lap();
  show_.presets.prepare(world());
  recovery_.update(scenes_.reloader().script_preset());
  if (show_.session->scene != nullptr) show_.session->scene->collect_garbage();
  show_.end_history_pass(running);
  times_.gc = watch.lap();
}

// Executes the requests of this pass to reset the scene, and to begin or end a take, and adds the pass to the take.
void Engine::execute_reset_and_take_requests(bool running) {
  if (recording_.requested()) {
    begin_recording();
  } else {
    if (std::exchange(world().requests().reset, false)) scenes_.reset();
    show_.input->end_pass();
    recording_.end_pass(running);
  }
  recording_.end_if_requested();
  playback_.end_if_requested();
}

bool Engine::restart(std::optional<std::uint64_t> seed) {
  const auto set_seed = [this](std::uint64_t number) {
    const auto value = static_cast<double>(number);
    (void)store().set(world().id(), "seed", {&value, 1});  // can't fail: the caller has checked the range
  };
  const std::uint64_t previous = world().seed();
  std::optional<std::uint64_t>& option = show_.options.scene_options.seed;
  const std::optional<std::uint64_t> previous_option = std::exchange(option, seed ? seed : option);
  const Overrides previous_overrides = show_.overrides;
  show_.overrides.clear();
  // the reset copies the seed of the present world, and prefers one that was set since the start
  if (option) set_seed(*option);
  show_.scene_seed = world().seed();
  if (scenes_.reset()) {
    show_.undo_stack.clear();
    show_.cues.set_state({});
    return true;
  }
  show_.overrides.restore(previous_overrides);
  set_seed(previous);
  option = previous_option;
  show_.scene_seed = previous;
  return false;
}

// Resets the scene and records from there: a take begins with a run of the scene from its start.
void Engine::begin_recording() {
  world().requests().reset = false;
  show_.undo_stack.clear();  // undo steps from before the take can't be replayed
  show_.call_log.begin_pass();
  const std::string file = recording_.begin_requested();
  if (scenes_.reset()) {
    log_info("recording the take {}", printable(file));
    recording_.end_pass(false, true);
    if (show_.cues.state() != CueState{}) recording_.record(message_of(show_.cues.state()), {}, false);
  } else {
    recording_.abandon();
    recording_.report_failure("the take was not started: the scene's file has an error");
  }
}

void Engine::publish() {
  Session& session = *show_.session;
  const History& history = show_.history;
  session.counters.publish();
  session.preset_node.publish();
  session.cue_node.publish();
  const double rewindable = history.empty() ? 0 : session.world.time() - history.oldest_time();
  session.transport.publish(show_.pacer.speed_reached(), rewindable, static_cast<double>(history.bytes()) / (1u << 20u),
                            show_.pacer.lost_time());
  const std::optional<TakeNode::Status> replayed = playback_.status();
  session.take_node.publish(replayed ? *replayed : recording_.status().value_or(TakeNode::Status{}));
  session.publisher.publish(session.transport.paused(), show_.pacer.speed_reached(), times_, is_replaying());
}

void Engine::make_value_snapshot() {
  ValueSnapshotter& snapshotter = show_.outputs.live().value_snapshotter();
  if (!snapshotter.make(store(), show_.link.snapshots.read(), live_input_.snapshot_requests())) return;
  show_.link.wake_network();
  show_.link.wake_query();
}

Result<void> Engine::change_scene(const std::string& file, std::optional<std::uint64_t> panics) {
  Result<void> changed = scenes_.change_scene(file, panics);
  if (changed) cues_.change_scene(file);
  return changed;
}

std::vector<script::SourceFile> Engine::files() const {
  std::vector<script::SourceFile> files = scenes_.files();
  if (script::SourceFile cues = cues_.file(); !cues.path.empty()) files.push_back(std::move(cues));
  return files;
}

void Engine::finish_saving() {
  show_.presets.finish_saving();
  recording_.finish_saving();
}

}  // namespace limber::engine
