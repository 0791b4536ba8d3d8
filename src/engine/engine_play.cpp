// Engine: the beginning and the end of a replay: of the program's, and of a take that plays in the place of a show.
#include <utility>

#include "base/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {

// Limits of a replay. The take lists the calls that were stopped; another call exceeds these limits only when the
// replay differs from the recording. In a show that plays the take, it must end soon enough for the performer.
ScriptLimits wide_limits(bool in_show) {
  ScriptLimits limits;
  limits.call_ms *= in_show ? 10 : 100;
  limits.again_ms *= in_show ? 1 : 10;
  limits.run_ms *= 10;
  limits.memory *= 16;
  return limits;
}

}  // namespace

// a run of the scene that is made now, or a later one
SceneOptions Engine::scene_options() const {
  SceneOptions options = options_.scene_options;
  if (replays() && !player_->current_scripts()) options.limits = wide_limits(plays_);
  if (replays()) options.keep_timers = player_->keeps_timers();
  if (!has_rules()) options.limits.disable_failed_handlers = false;
  return options;
}

Result<void> Engine::start_replay() {
  auto player = TakePlayer::open(options_.replay, options_.current_scripts);
  if (!player) return Error{player.error()};
  (*player)->next();
  return begin_replay(std::move(*player), options_.replay);
}

// on an empty stage, by the take's first tick
Result<void> Engine::begin_replay(std::unique_ptr<TakePlayer> player, const std::string& file) {
  player_ = std::move(player);
  take_name_ = take_title(file);
  const TakeBegin& begin = player_->begin();
  options_.scene = begin.scene;
  options_.scene_options.seed = begin.seed;
  options_.scene_options.package_paths = begin.package_paths;
  options_.preset = begin.preset;
  options_.sets = begin.sets;
  recovered_ = begin.recovered.empty() ? nullptr : begin.recovered.front();
  calls_.begin_tick(player_->stopped());
  Result<void> begun = replay_beginning();
  if (!begun) return begun;
  take_tick(false);
  publish();
  if (begin.reset) end_pass(false);  // a rewind goes back to there, as it did when the take was recorded in a show
  return begun;
}

// false: the take has no more
bool Engine::next_of_take(bool& may_step) {
  if (!player_->next()) return false;
  may_step = player_->tick().running;
  calls_.begin_tick(player_->stopped());
  replay_runs();
  return true;
}

Result<void> Engine::play_take(const std::string& file, std::optional<std::uint64_t> stops) {
  const std::uint64_t asked = stops.value_or(stops_of_takes(link_));
  auto player = TakePlayer::open(file, false);
  if (!player) return Error{player.error()};
  (*player)->next();
  if (Result<void> runs = try_take(**player); !runs) return runs;
  Presets::Book book = read_presets((*player)->begin().scene);
  std::unique_ptr<Stage> before;  // it goes at the end of this, beside the show
  Result<void> begun;
  const Result<void> done = between_ticks([&] {
    if (recorder_ != nullptr || take_wanted_) {
      begun = Error{"a take is being recorded; /take/stop ends it"};
    } else if (stops_of_takes(link_) != asked) {
      link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
      begun = Error{"discarded: a panic or /take/stop came before it could begin"};
    } else {
      before = begin_play(std::move(*player), file, book);
    }
  });
  return done ? begun : done;
}

// what plays is not given up for a take whose scene does not run
Result<void> Engine::try_take(TakePlayer& player) {
  const std::vector<TakeRun>& runs = player.tick().runs;
  if (runs.empty() || !runs.front().good) return Error{"its scene did not run when it was recorded either"};
  SceneOptions options = options_.scene_options;
  options.package_paths = player.begin().package_paths;
  options.limits = wide_limits(true);
  options.sources = player.sources(runs.front());
  Stage stage(link_, presets_, edits_, {});  // never steps
  return stage.run_beside(player.begin().scene, *this, options);
}

// `book`: the presets of the take's scene, as they are on the disk; those that were open, where they are of another one
std::unique_ptr<Stage> Engine::begin_play(std::unique_ptr<TakePlayer> player, const std::string& file,
                                          Presets::Book& book) {
  refuse_commands();
  plays_ = true;
  hand_.clear();
  edits_.clear();
  after_play_ = presets_.exchange({});
  if (after_play_.file != book.file) std::swap(after_play_, book);
  if (stage_->scene != nullptr) stage_->scene->disarm();
  std::unique_ptr<Stage> before = swap_stage(new_stage());
  if (const Result<void> begun = begin_replay(std::move(player), file); !begun) {
    faults_++;
    log_error("{}: {}", printable(file), begun.error());
    end_play();
    return before;
  }
  log_info("the take {} plays; /take/stop brings the hands back", printable(take_name_));
  send_transport();
  return before;
}

void Engine::end_play() {
  const TakeVerdict verdict = player_->verdict();
  player_ = nullptr;
  plays_ = false;
  ordered_.reset();
  presets_.exchange(std::exchange(after_play_, {}));
  const ScriptLimits& limits = options_.scene_options.limits;
  if (stage_->scene != nullptr) stage_->scene->limit(limits);
  reload_.limit(limits);
  history_.begin_anew("a take was played until there");
  log_info("{}: {}; the show goes on in your hands", printable(take_name_), text_of(verdict));
  const double parted = verdict.parted ? static_cast<double>(*verdict.parted) : -1;
  push_out({Outgoing::To::event,
            {},
            {"/take/played", {Arg::of(take_name_), Arg::of(static_cast<double>(verdict.ticks)), Arg::of(parted)}}});
  send_transport();
}

}  // namespace limber
