// Engine: the simulation thread's loop. One tick: commands, scene callbacks, physics, snapshot; and pacing. It owns the
// world and the scene; the outside sees only its EngineLink.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/output.h"
#include "base/system/clock.h"
#include "engine/clock.h"
#include "engine/hand.h"
#include "engine/handler_queue.h"
#include "engine/hands.h"
#include "engine/history.h"
#include "engine/image_maker.h"
#include "engine/link.h"
#include "engine/presets.h"
#include "engine/recovery_keeper.h"
#include "engine/reload.h"
#include "engine/requests.h"
#include "engine/stage.h"
#include "engine/take_player.h"
#include "engine/take_recorder.h"
#include "script/call_ledger.h"

namespace limber {

struct EngineOptions {
  std::string scene;                   ///< File of the scene; empty: an empty world.
  SceneOptions scene_options;          ///< Seed, package paths, installed data.
  bool fast = false;                   ///< Ticks as fast as they can be computed, with the same result.
  std::optional<std::uint64_t> ticks;  ///< Ends after so many; else runs until stop().
  std::optional<double> duration;      ///< Ends at that simulated time, s.
  bool strict = false;                 ///< Ends at the first fault.
  bool print = true;                   ///< Scripts' print goes to stdout; false: to stderr, where stdout is an answer.
  std::string preset;                  ///< `--preset`: recalled before the first tick.
  std::string record;                  ///< A take goes there, from the start on.
  std::string replay;                  ///< This take is played; it has the scene and all that came in.
  bool current_scripts = false;        ///< A replay reads the scene from the disk, as it is now.
  std::string locks;     ///< Folder of the locks with which one program owns a scene's presets; empty: none.
  std::string recovery;  ///< The show's values are kept in that folder as long as it plays; empty: not.
  std::chrono::milliseconds recovery_every = RecoveryKeeper::kEvery;
  bool recover = false;       ///< `--recover`: what a run that did not end well has left is brought back.
  int threads = 1;            ///< That share out a step, 1 to Team::kMost, with the same result.
  std::vector<Message> sets;  ///< `--set`: the performer's hand before the first tick, after the preset.
  /// Called by run() in each turn of its loop, at least 20 times a second, also while paused. It never waits. [sim]
  std::function<void()> on_turn = [] {};
  /// Real time in seconds, for budgets and for the first second of a panic; for tests.
  std::function<double()> clock = system::clock_seconds;
};

class Engine : private ScriptHost {
 public:
  /// Work that messages may make in one tick: 1 each and 1 a value, more where a text is made or the scene listens. The
  /// rest waits for the next ticks, in its order, so that a flood does not hold up time. A datagram is never split.
  static constexpr int kTickWork = 8192;
  /// Another request for a panic within its first second is ignored, so that a second press by mistake doesn't end it,
  /// s.
  static constexpr double kPanicFirst = 1;
  /// Time that handlers (osc:on) get: this part of real time, saved up to this many seconds. One call may exceed it;
  /// then the next ones wait until that is made up. Messages wait in order, and what they set acts at once. With --fast
  /// there is no limit.
  static constexpr double kHandlerShare = 0.5;
  static constexpr double kHandlerSeconds = 0.008;
  /// Questions (/get) that wait for the ticks of a step before them.
  static constexpr std::size_t kMostQuestions = 256;

  /// The link outlives the engine, and nobody calls its `wake_engine` while the engine goes.
  Engine(EngineLink& link, EngineOptions options);
  ~Engine() override;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Runs the scene's file and the `sets`: what is wrong with either, with file and line. After a scene's fault the
  /// world is empty and waits: the first good reload is then the start. [sim]
  Result<void> start();
  /// Ticks until the end that the options name, or stop(). [sim]
  void run();
  /// One tick now, whatever the clock says; while paused only commands and handlers. [sim]
  void tick() { pass(true); }
  /// What happens while time stands still: commands, handlers, what was asked for; no time passes. [sim]
  void idle() { pass(false); }
  /// Ends run() soon. [any]
  void stop();

  /// Runs the scene beside the show and has what it says otherwise than the last good run applied between two ticks; a
  /// fault is told, and the show plays on as it is. Waits until that is done. `again`: a run of what the last good one
  /// has read, because a parameter has changed, not the disk. False: nothing was tried, since a take plays, or the show
  /// has ended. [any but sim, while run() goes]
  bool reload(bool again = false);
  /// The same at once, on the simulation's own thread. [sim]
  Reload::End reload_now(bool again = false);
  /// Runs another scene's file beside the show; it plays from its start instead, between two ticks, without what the
  /// performer has set. An error: what is wrong with it, and the show plays on. [any but sim, while run() goes]
  /// `panics`: EngineLink::panics when it was asked for; another panic since then discards it.
  Result<void> change_scene(const std::string& file, std::optional<std::uint64_t> panics = {});
  /// A take plays in the place of the show, from its begin to its end or /take/stop; from there the show goes on in the
  /// performer's hands. An error: what is wrong with the take, and the show plays on. [any but sim, while run() goes]
  /// `stops`: stops_of_takes() when it was asked for; another one since then discards it.
  Result<void> play_take(const std::string& file, std::optional<std::uint64_t> stops = {});
  /// Panics and ends of takes so far. [any]
  static std::uint64_t stops_of_takes(const EngineLink& link) { return link.panics.load() + link.take_stops.load(); }
  /// Files that are worth a reload when they change. [any]
  std::vector<SourceFile> files() const { return reload_.files(); }

  World& world() { return stage_->world; }
  Store& store() { return stage_->store; }
  const PhaseTimes& times() const { return times_; }
  const History& history() const { return history_; }
  const Presets& presets() const { return presets_; }
  /// Waits until what presets have to write is on the disk. [any but sim]
  void finish_saving();
  /// The show has ended well: nothing needs to be brought back. [any but sim, after run()]
  void end_recovery();
  /// Ends the take that is recorded, if one is. [sim]
  void end_take();
  /// Whether a take is replayed, and what came of it so far.
  bool replays() const { return player_ != nullptr; }
  TakeVerdict verdict() const { return player_->verdict(); }
  /// Everything is as it was at the newest key state before that tick, and what came since never was; presets stay.
  /// Between two passes, or where messages are carried out. A take is not told. False: there is no such state, nothing
  /// is changed. [sim]
  bool return_before(std::uint64_t tick);
  /// Nothing more comes of it. [sim]
  bool replay_over() const { return player_->over(); }
  /// World, scene and generators. [sim]
  std::uint64_t state_hash() const;
  /// Script errors and refused values so far, health events: what `--strict` asks for. [sim]
  std::uint64_t faults() const { return faults_ + stage_->world.health_events(); }

 private:
  void send(Message message) override;
  void reply(const Origin& to, Message message) override;
  void send_direct(const Origin& to, Message message) override;
  void plan_osc(const OscPlan& plan) override;
  void ask_reset() override;
  void ask_panic() override;
  Result<void> check_preset(const Message& wish, std::span<const Message> before) override;
  void ask_preset(Message&& wish) override;
  std::vector<std::string> preset_names() override;
  void script_error(std::string_view file, int line, std::string_view text) override;
  void print(std::string_view text) override;

  /// A tick; or, when `may_step` is false, only what happens while time stands still.
  void pass(bool may_step);
  void play(bool running);
  void end_pass(bool running);
  void tell_transport();
  Outcome go_back(const Transport::Back& back, const Origin& origin);
  void do_again_until(const PastGoal& goal);
  void begin_again(bool on);
  void do_again(PastPass& pass);
  bool reset();
  void begin_panic();
  void end_panic();
  Result<void> start_show();
  void keep_state(Stage& fresh, std::string_view name) const;
  /// The stage becomes the show; the answer is the one before.
  std::unique_ptr<Stage> take_stage(std::unique_ptr<Stage> fresh);
  std::unique_ptr<Stage> new_stage();
  std::unique_ptr<Stage> swap_stage(std::unique_ptr<Stage> fresh);
  void replay_hand();
  Presets::Book read_presets(const std::string& scene);
  Result<void> first_hand();
  void open_recovery();
  Result<void> bring_back();
  void give_recovery();
  void carry_out_wishes();
  Reload::End take(Draft& draft);
  Reload::End run_now(TakeRun::Kind kind, bool again);
  void play_scene(const std::string& file, std::unique_ptr<Stage>& fresh, Presets::Book& book);

  /// A run of the scene, in a take.
  struct TakenRun {
    std::size_t place = 0;                   // where it is recorded
    const TakeRun* told = nullptr;           // as the take that is replayed has it
    std::shared_ptr<const Sources> sources;  // what it is to read instead of the disk
    bool fails = false;                      // it failed then
  };
  TakenRun begin_run(TakeRun::Kind kind, bool again = false, const std::string& scene = "");
  void run_was_good(const TakenRun& run, const Stage& stage, std::optional<PresetList> presets = {},
                    const std::string& preset_file = "");
  Result<void> start_record();
  Result<void> start_replay();
  Result<void> begin_replay(std::unique_ptr<TakePlayer> player, const std::string& file);
  Result<void> replay_beginning();
  SceneOptions scene_options() const;
  Result<void> try_take(TakePlayer& player);
  std::unique_ptr<Stage> begin_play(std::unique_ptr<TakePlayer> player, const std::string& file, Presets::Book& book);
  void end_play();
  bool next_of_take(bool& may_step);
  void refuse_commands();
  void refuse_urgent();
  void refuse_hand(const Message& message, const Origin& origin);
  TakeBegin take_begin(bool reset) const;
  void replay_runs();
  void replay_run(const TakeRun& run);
  void replay_messages(Hands& hands);
  Outcome ask_take(const Message& message);
  void begin_take();
  void drop_take();
  void tell_take();
  void take_tick(bool running, bool begins = false);
  std::function<void(const std::string&)> say_take_failed();
  void begin_show();
  void rerun();
  Result<void> between_ticks(const std::function<void()>& work);
  void drain();
  void execute_urgent(Hands& hands);
  bool overtaken(const Message& message, std::uint64_t arrival);
  bool waits_for_steps(const Message& message, const Origin& origin);
  void answer_questions(Hands& hands);
  void age_panic(bool may_step);
  void note_event(const TakeEvent& event);
  bool carry_out_event(const Message& message);
  /// Whether the rules of kTakeRules hold: not in takes of before.
  bool has_rules() const { return player_ == nullptr || player_->rules() > 0; }
  /// What the message cost of kTickWork, beside 1.
  int execute(Message& message, const Origin& origin);
  void evaluate(const Evaluate& wish, const Origin& origin);
  Evaluation evaluate_text(std::string_view text);
  void refuse(std::string_view address, const Origin& origin, std::string_view error);
  void call_handlers();
  void call_handler();
  void publish();
  void make_image(std::uint64_t asks);
  void say_clamped(const Message& message, const Row& row);
  void say_left_out(const std::string& text);
  void send_contacts();
  void send_transport();
  void tell_health();
  bool wait_for_tick();
  void pace();
  void count_stall();
  bool finished() const;
  void push_out(Outgoing out);

  EngineLink& link_;
  EngineOptions options_;
  PerformerHand hand_;
  Presets presets_{hand_};
  Edits edits_{hand_};
  ChangeNotes notes_{link_.changes};
  ChangeLog unread_;
  ChangeNotes quiet_notes_{unread_};
  HandlerQueue heard_;  // messages for the scene's handlers
  History history_{hand_, edits_, presets_, heard_};
  bool went_back_ = false;  // with the last message
  bool again_ = false;      // what was done once is done again
  std::optional<LogSilence> silence_;
  const std::shared_ptr<Team> team_;  // null: this thread alone
  std::unique_ptr<Stage> stage_;
  std::uint64_t scene_seed_ = 0;  // as the scene's run left it
  Reload reload_;
  Requests requests_;
  ImageMaker images_{link_.images};
  CallLedger calls_;
  std::unique_ptr<TakeRecorder> recorder_;
  std::unique_ptr<TakePlayer> player_;
  bool plays_ = false;                                // what is replayed plays in the place of a show
  Presets::Book after_play_;                          // the presets, once that is over
  std::vector<std::unique_ptr<TakeWriter>> written_;  // takes that have ended, and may still be written
  std::string take_name_;                             // of the one that is recorded or replayed
  std::optional<std::string> take_wanted_;            // the file of a take that begins at the tick's end
  bool take_ends_ = false;
  bool answers_taken_ = false;                // what is sent now answers a message of the take that is replayed
  std::optional<DraftOrder> ordered_;         // of the take that is replayed
  std::unique_ptr<RecoveryKeeper> recovery_;  // null: values are not kept
  std::shared_ptr<const Preset> recovered_;   // what the show begins with
  std::string recovered_when_;                // empty: of a take
  std::uint64_t given_version_ = 0;           // of the store, when values were given last
  std::string given_scene_;                   // the scene then
  Clock clock_;
  double lost_time_ = 0;  // s, by stalls
  bool stall_said_ = false;
  bool stall_excused_ = true;  // the loop was away for a reset or a rewind, which somebody has asked for
  PhaseTimes times_;

  struct Question {
    Message message;
    Origin origin;
  };
  std::vector<UrgentRequest> urgent_;   // scratch
  Overtaken overtaken_;                 // what urgent requests discard
  double panic_age_ = 0;                // s, of one that is not settled
  bool ignored_said_ = false;           // that a request was ignored
  double pass_at_ = 0;                  // the clock in the last pass
  double handler_seconds_ = 0;          // left for handlers; negative: to be made up
  double handlers_at_ = 0;              // the clock when they were called last
  std::optional<std::uint64_t> hears_;  // of a replay: messages that handlers hear in this tick
  std::vector<Origin> step_origins_;    // whose steps are being made
  std::vector<Question> questions_;     // of theirs, until the steps are made
  std::vector<Command> commands_;
  std::size_t next_command_ = 0;            // the first that is yet to be done
  std::uint64_t asks_of_batch_ = 0;         // images asked for before commands_ was taken
  std::uint64_t asks_ = 0;                  // images that may be made: all that came before was done
  std::vector<Message> wishes_;             // of scripts, about presets
  std::vector<const Row*> said_clamped_;    // rows whose clamping was said
  std::vector<std::string> said_left_out_;  // lately, of presets
  std::uint64_t faults_ = 0;
  std::uint64_t health_events_ = 0;  // of the stage, that are in link_.health
  std::uint64_t passes_ = 0;
  // of the whole program, before this engine was
  const std::uint64_t lines_lost_before_ = lost_output_lines();
  const std::uint64_t left_out_before_ = log_left_out();
  const std::uint64_t writes_failed_before_ = failed_writes();
  bool was_paused_ = false;

  std::atomic<bool> stop_{false};
  std::atomic<bool> commands_wait_{false};
  std::mutex wake_mutex_;
  std::condition_variable wake_;
};

}  // namespace limber
