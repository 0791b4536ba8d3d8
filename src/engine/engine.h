// Engine: the main loop of the simulation thread. Each tick executes commands, scene callbacks and physics, publishes a
// snapshot and waits for the next tick. It owns the world and the scene; other threads use its EngineLink only.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/log/log.h"
#include "base/log/output.h"
#include "base/system/clock.h"
#include "engine/clock.h"
#include "engine/commands/handler_queue.h"
#include "engine/edits/edit_scope.h"
#include "engine/edits/overrides.h"
#include "engine/history/history.h"
#include "engine/output/engine_link.h"
#include "engine/output/value_snapshotter.h"
#include "engine/presets/presets.h"
#include "engine/recovery/recovery_saver.h"
#include "engine/reload/scene_reloader.h"
#include "engine/session.h"
#include "engine/sim_thread_executor.h"
#include "engine/takes/player.h"
#include "engine/takes/recorder.h"
#include "script/vm/call_log.h"

namespace limber {

struct EngineOptions {
  std::string scene;                   ///< Scene file; empty: an empty world.
  SceneOptions scene_options;          ///< Seed, package paths, installed data.
  bool fast = false;                   ///< Computes ticks without waiting for real time. The result is the same.
  std::optional<std::uint64_t> ticks;  ///< Ends after this number of ticks; else runs until stop().
  std::optional<double> duration;      ///< Ends at this simulated time, s.
  bool strict = false;                 ///< Ends at the first fault.
  bool print = true;                   ///< Scripts print to stdout; false: to stderr, because stdout is the output.
  std::string preset;                  ///< `--preset`: recalled before the first tick.
  std::string record;                  ///< Records a take to this file, from the start on.
  std::string replay;                  ///< Replays this take, which contains the scene and all input.
  bool current_scripts = false;        ///< A replay reads the scene from the disk, in its current state.
  /// Folder of the lock files that make one program the owner of a scene's presets; empty: no locks.
  std::string lock_folder;
  std::string recovery_folder;  ///< Folder of the recovery file, written while the show plays; empty: no recovery.
  std::chrono::milliseconds recovery_interval = RecoverySaver::kInterval;
  bool recover = false;       ///< `--recover`: restores the values of a run that crashed.
  int threads = 1;            ///< Threads for each physics step. The result is the same for any number.
  std::vector<Message> sets;  ///< `--set`: overrides, applied before the first tick and after the preset.
  /// Called in each iteration of the loop of run(), at least 20 times a second, also while paused. Must not block.
  /// [sim]
  std::function<void()> on_iteration = [] {};
  /// Real time in seconds, for time budgets and for the first second of a panic. Tests replace it.
  std::function<double()> clock = system::clock_seconds;
};

class Engine : private ScriptHost {
 public:
  /// Work budget of the messages of one tick: 1 per message and per value, more if a text is formatted or the scene has
  /// handlers. The remaining messages wait in order for the next ticks, so a flood does not stop time. A datagram is
  /// never split.
  static constexpr int kTickWork = 8192;
  /// Seconds in which another panic request is ignored, so that pressing the button twice does not end the panic.
  static constexpr double kPanicGuardSeconds = 1;
  /// Time budget of handlers (osc:on), a token bucket: it refills by this share of real time, up to kHandlerSeconds.
  /// One call may overdraw it; the next calls then wait until it is positive again. Messages are handled in order, and
  /// the values that they set take effect at once. With --fast there is no limit.
  static constexpr double kHandlerShare = 0.5;
  static constexpr double kHandlerSeconds = 0.008;
  /// Maximum number of queries (/get) that wait for an earlier /transport/step of the same sender.
  static constexpr std::size_t kMaxQueries = 256;

  /// The link must outlive the engine. No thread may call its `wake_engine` during the destructor.
  Engine(EngineLink& link, EngineOptions options);
  ~Engine() override;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Runs the scene file and applies the `sets`. An error names file and line. After a failed scene the world stays
  /// empty, and the first successful reload becomes the start. [sim]
  Result<void> start();
  /// Runs ticks until the end that the options specify, or until stop(). [sim]
  void run();
  /// Runs one tick now, regardless of the clock; while paused only commands and handlers. [sim]
  void tick() { run_pass(true); }
  /// Executes commands, handlers and requests without a time step. [sim]
  void idle() { run_pass(false); }
  /// Makes run() return soon. [any]
  void stop();

  /// Runs the scene file detached from the show and applies its differences from the last successful run between two
  /// ticks. A script error is reported, and the show continues unchanged. Blocks until that is done. `reuse_files`:
  /// runs the sources of the last successful run instead of the files on disk, because a parameter has changed. Returns
  /// false if nothing was tried, because a take plays or the show has ended. [any but sim, during run()]
  bool reload(bool reuse_files = false);
  /// Reloads at once, on the simulation thread. [sim]
  SceneReloader::ApplyResult reload_now(bool reuse_files = false);
  /// Runs another scene file detached from the show, then replaces the show with it between two ticks and drops all
  /// overrides. If the scene fails, returns the error, and the show continues. [any but sim, during run()]
  /// `panics`: EngineLink::panics at the time of the request; the request is discarded if there was a panic since.
  Result<void> change_scene(const std::string& file, std::optional<std::uint64_t> panics = {});
  /// Replaces the show with a take, which plays to its end or until /take/stop; from there the show continues under
  /// live control. If the take is invalid, returns the error, and the show continues. [any but sim, during run()]
  /// `stops`: take_stop_count() at the time of the request; the request is discarded if it has changed since.
  Result<void> play_take(const std::string& file, std::optional<std::uint64_t> stops = {});
  /// Number of panics and ends of takes so far. [any]
  static std::uint64_t take_stop_count(const EngineLink& link) { return link.panics.load() + link.take_stops.load(); }
  /// The source files to watch: a change of one of them calls for a reload. [any]
  std::vector<SourceFile> files() const { return reloader_.files(); }

  World& world() { return session_->world; }
  Store& store() { return session_->store; }
  const PhaseTimes& times() const { return times_; }
  const History& history() const { return history_; }
  const Presets& presets() const { return presets_; }
  /// Blocks until presets and takes are written to disk. [any but sim]
  void finish_saving();
  /// Marks the show as properly ended, so that the next start does not offer a recovery. [any but sim, after run()]
  void end_recovery();
  /// Ends the recording of a take, if there is one. [sim]
  void end_take();
  /// True while a take is replayed.
  bool is_replaying() const { return player_ != nullptr; }
  /// The result of the replay so far. Requires is_replaying().
  ReplayResult replay_result() const { return player_->result(); }
  /// Restores the newest checkpoint before this tick and discards everything since, except presets. Call it between two
  /// passes or while messages are executed. It is not recorded in a take. Returns false, without a change, if there is
  /// no such checkpoint. [sim]
  bool restore_before(std::uint64_t tick);
  /// True when the replay has reached the end of the take. Requires is_replaying(). [sim]
  bool replay_finished() const { return player_->finished(); }
  /// Hash of the world, the scene and the random number generators. [sim]
  std::uint64_t state_hash() const;
  /// Number of script errors, rejected values and health events so far, for `--strict`. [sim]
  std::uint64_t faults() const { return faults_ + session_->world.health_events(); }

 private:
  void send(Message message) override;
  void reply(const CommandOrigin& to, Message message) override;
  void send_direct(const CommandOrigin& to, Message message) override;
  void configure_osc(const OscConfig& config) override;
  void request_reset() override;
  void request_panic() override;
  Result<void> check_preset(const Message& request, std::span<const Message> earlier) override;
  void request_preset(Message&& request) override;
  std::vector<std::string> preset_names() override;
  void script_error(std::string_view file, int line, std::string_view text) override;
  void print(std::string_view text) override;

  /// One iteration: commands, handlers, requests, publishing and, if `may_step` and not paused, a time step.
  void run_pass(bool may_step);
  void simulate(bool running);
  void end_pass(bool running);
  void update_transport();
  Outcome rewind(const Transport::RewindRequest& request, const CommandOrigin& origin);
  void resimulate_until(const RewindTarget& target);
  void set_resimulating(bool on);
  void resimulate(RecordedPass& pass);
  bool reset();
  void begin_panic();
  void end_panic();
  Result<void> start_show();
  void copy_session_value(Session& fresh, std::string_view name) const;
  /// Makes a session the show, with the session state that survives a reset. Returns the previous session.
  std::unique_ptr<Session> install_session(std::unique_ptr<Session> fresh);
  std::unique_ptr<Session> new_session();
  std::unique_ptr<Session> swap_session(std::unique_ptr<Session> fresh);
  void reapply_overrides();
  Presets::Bank read_presets(const std::string& scene);
  Result<void> apply_initial_overrides();
  void open_recovery();
  Result<void> apply_recovered();
  void update_recovery();
  void execute_preset_requests();
  SceneReloader::ApplyResult apply_candidate(ReloadCandidate& candidate);
  SceneReloader::ApplyResult run_scene_now(TakeSceneRun::Kind kind, bool reuse_files);
  void play_scene(const std::string& file, std::unique_ptr<Session>& fresh, Presets::Bank& bank);

  /// A run of the scene in a take that is recorded or replayed.
  struct RecordedRun {
    std::size_t index = 0;                   // its index in the recording
    const TakeSceneRun* recorded = nullptr;  // its entry in the take that is replayed
    std::shared_ptr<const Sources> sources;  // read instead of the files on disk
    bool fails = false;                      // it failed when it was recorded
  };
  RecordedRun begin_run(TakeSceneRun::Kind kind, bool reuse_files = false, const std::string& scene = "");
  void run_succeeded(const RecordedRun& run, const Session& session, std::optional<PresetList> presets = {},
                     const std::string& preset_file = "");
  Result<void> start_recording();
  Result<void> start_replay();
  Result<void> begin_replay(std::unique_ptr<TakePlayer> player, const std::string& file);
  Result<void> start_from_take();
  SceneOptions scene_options() const;
  Result<void> check_take(TakePlayer& player);
  std::unique_ptr<Session> begin_play(std::unique_ptr<TakePlayer> player, const std::string& file, Presets::Bank& bank);
  void end_play();
  bool next_replay_tick(bool& may_step);
  void reject_commands();
  void reject_urgent();
  void reject_message(const Message& message, const CommandOrigin& origin);
  TakeInitialState make_initial_state(bool reset) const;
  void replay_runs();
  void replay_run(const TakeSceneRun& run);
  void replay_messages(EditScope& edit_scope);
  Outcome request_take(const Message& message);
  void begin_recording();
  void abandon_recording();
  void update_take_node();
  void finish_take_tick(bool running, bool begins = false);
  std::function<void(const std::string&)> take_error_reporter();
  void begin_show();
  void rerun_if_requested();
  Result<void> run_between_ticks(const std::function<void()>& work);
  void execute_commands();
  void execute_urgent(EditScope& edit_scope);
  bool discard_if_overtaken(const Message& message, std::uint64_t arrival);
  bool postpone_query(const Message& message, const CommandOrigin& origin);
  void answer_pending_queries(EditScope& edit_scope);
  void update_panic_age(bool may_step);
  void record_event(const TakeEvent& event);
  bool execute_event(const Message& message);
  /// True if the rules of kTakeRules apply; false in replays of older takes.
  bool has_current_rules() const { return player_ == nullptr || player_->rules() > 0; }
  /// Returns the cost of the message in units of kTickWork, in addition to 1.
  int execute(Message& message, const CommandOrigin& origin);
  void evaluate(const EvaluationRequest& request, const CommandOrigin& origin);
  Evaluation evaluate_text(std::string_view text);
  void send_error(std::string_view address, const CommandOrigin& origin, std::string_view error);
  void call_handlers();
  void call_handler();
  void publish();
  void make_value_snapshot(std::uint64_t requests);
  void report_clamped(const Message& message, const Property& property);
  void report_warning(const std::string& text);
  void send_contacts();
  void send_transport();
  void update_health();
  bool wait_for_tick();
  void pace();
  void count_stall();
  bool finished() const;
  void push_out(Outgoing out);

  EngineLink& link_;
  EngineOptions options_;
  Overrides overrides_;
  Presets presets_{overrides_};
  UndoStack undo_stack_{overrides_};
  ChangeRecorder change_recorder_{link_.changes};
  ChangeLog muted_log_;
  ChangeRecorder muted_recorder_{muted_log_};
  HandlerQueue handler_queue_;  // messages that wait for the scene's handlers
  History history_{overrides_, undo_stack_, presets_, handler_queue_};
  bool rewound_ = false;       // the last message rewound time
  bool resimulating_ = false;  // while a rewind simulates recorded ticks again: no output, no logging
  std::optional<LogSilence> log_silence_;
  const std::shared_ptr<ThreadPool> thread_pool_;  // null: this thread alone
  std::unique_ptr<Session> session_;
  std::uint64_t scene_seed_ = 0;  // the random seed after the scene's run
  SceneReloader reloader_;
  SimThreadExecutor executor_;
  ValueSnapshotter value_snapshotter_{link_.value_snapshots};
  CallLog call_log_;
  std::unique_ptr<TakeRecorder> recorder_;
  std::unique_ptr<TakePlayer> player_;
  bool plays_in_show_ = false;                            // the replayed take plays in a live show (/take/play)
  Presets::Bank presets_after_play_;                      // the presets to restore after /take/play
  std::vector<std::unique_ptr<TakeWriter>> ended_takes_;  // ended takes that may still be written to disk
  std::string take_name_;                                 // of the take that is recorded or replayed
  std::optional<std::string> requested_take_;             // file of the recording that begins at the end of this tick
  bool take_end_requested_ = false;                       // the recording or replay ends at the end of this tick
  bool suppress_answers_ = false;                // answers go to messages of the replayed take, so they are not sent
  std::optional<ReloadRequest> reload_request_;  // of the replayed take
  std::unique_ptr<RecoverySaver> recovery_;      // null: no recovery file
  std::shared_ptr<const Preset> recovered_;      // recovered values to apply at the start
  std::string recovered_time_;                   // time of the crash; empty: the values come from a take
  std::uint64_t recovery_version_ = 0;           // store version that was last passed to `recovery_`
  std::string recovery_scene_;                   // scene that was last passed to `recovery_`
  Clock clock_;
  double lost_time_ = 0;         // s, lost in stalls
  bool stall_reported_ = false;  // the stall warning was logged
  bool stall_excused_ = true;    // the next delay is caused by a requested reset or rewind and is not counted
  PhaseTimes times_;

  struct PendingQuery {
    Message message;
    CommandOrigin origin;
  };
  std::vector<UrgentRequest> urgent_;                    // scratch
  UrgentPrecedence urgent_precedence_;                   // decides which messages urgent requests discard
  double panic_age_ = 0;                                 // s, since the start of a panic that is not settled
  bool ignored_panic_reported_ = false;                  // an ignored panic request was logged
  double last_pass_time_ = 0;                            // time of the last pass, s
  double handler_budget_ = 0;                            // time left for handlers, s; negative: debt
  double handlers_time_ = 0;                             // time of the last handler calls, s
  std::optional<std::uint64_t> replayed_handler_calls_;  // in a replay: number of handler calls in this tick
  std::vector<CommandOrigin> step_origins_;              // senders of an unfinished /transport/step
  std::vector<PendingQuery> pending_queries_;            // queries of these senders, answered after the steps
  std::vector<Command> commands_;
  std::size_t next_command_ = 0;                   // index of the first command that is not executed
  std::uint64_t snapshot_requests_of_batch_ = 0;   // value snapshot requests made before commands_ was drained
  std::uint64_t snapshot_requests_ = 0;            // value snapshot requests that can be served now
  std::vector<Message> preset_requests_;           // preset requests of scripts
  std::vector<const Property*> reported_clamped_;  // properties with a reported clamping
  std::vector<std::string> reported_warnings_;     // recently reported preset warnings
  std::uint64_t faults_ = 0;
  std::uint64_t health_events_ = 0;  // of this session, already counted in link_.health
  std::uint64_t passes_ = 0;
  // program-wide counters at the construction of this engine
  const std::uint64_t lines_lost_before_ = lost_output_lines();
  const std::uint64_t log_suppressed_before_ = log_suppressed();
  const std::uint64_t writes_failed_before_ = failed_writes();
  bool was_paused_ = false;

  std::atomic<bool> stop_{false};
  std::atomic<bool> commands_waiting_{false};
  std::mutex wake_mutex_;
  std::condition_variable wake_;
};

}  // namespace limber
