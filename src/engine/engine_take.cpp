// Engine: recording takes and playing them again.
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "engine/draft.h"
#include "engine/engine.h"

namespace limber {

namespace {

constexpr std::size_t kMostName = 100;
constexpr int kRefusalWork = 8;  // as a refused message costs
constexpr const char* kReplays = "a take is replayed; it takes no messages";
constexpr const char* kPlays = "a take plays in the place of the show; /take/stop brings the hands back";

// a name that came by a message leads into no other folder
Result<std::string> take_name(const Message& message, const std::string& scene) {
  if (!message.args.empty() && !message.args[0].text.empty()) {
    std::string name = message.args[0].text;
    if (name.ends_with(".take")) name.resize(name.size() - 5);
    const bool plain = !name.empty() && name.size() <= kMostName && name.front() != '.' &&
                       name.find_first_of("/\\") == name.npos &&
                       std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (!plain) return Error{fmt::format("'{}' is no name of a take: a word without / is", printable(name))};
    return name;
  }
  // the hour names the file; no tick sees it
  const std::time_t now = std::time(nullptr);
  std::tm here{};
  localtime_r(&now, &here);
  char text[32] = {};
  (void)std::strftime(text, sizeof text, "%Y-%m-%d-%H%M%S", &here);
  return fmt::format("{}-{}", std::filesystem::path(scene).stem().string(), text);
}

}  // namespace

std::function<void(const std::string&)> Engine::say_take_failed() {
  return [this](const std::string& why) {
    log_error("{}", why);
    link_.push_out({Outgoing::To::error, {}, error_message("/take/record", why)});
  };
}

TakeBegin Engine::take_begin(bool reset) const {
  TakeBegin begin;
  begin.reset = reset;
  begin.scene = options_.scene;
  begin.seed = options_.scene_options.seed;
  begin.package_paths = options_.scene_options.package_paths;
  begin.preset = options_.preset;
  begin.sets = options_.sets;
  if (recovered_ != nullptr && !reset) begin.recovered = {recovered_};
  if (!reset) return begin;
  begin.world_seed = stage_->world.seed();
  begin.scene_seed = scene_seed_;
  begin.paused = stage_->world_value("paused") != 0;
  begin.speed = stage_->world_value("speed");
  begin.preset_file = presets_.file();
  begin.presets = presets_.list();
  for (const HandStep& step : hand_.in_order()) {
    TakeHand& kept = begin.hand.emplace_back();
    if (step.message != nullptr) kept.message = *step.message;
    if (step.address != nullptr) {
      kept.kind = TakeHand::Kind::given_back;
      kept.message.address = *step.address;
    }
    if (step.blend == nullptr) continue;
    kept.kind = TakeHand::Kind::blend;
    kept.presets = {step.blend->a};
    if (step.blend->amount > 0) kept.presets.push_back(step.blend->b);
    kept.amount = step.blend->amount;
  }
  return begin;
}

Result<void> Engine::start_record() {
  calls_.begin_tick();
  recorder_ =
      std::make_unique<TakeRecorder>(TakeWriter::Place{options_.record, false}, take_begin(false), say_take_failed());
  Result<void> opened = recorder_->opened();
  if (!opened) recorder_ = nullptr;
  take_name_ = take_title(options_.record);
  return opened;
}

Engine::TakenRun Engine::begin_run(TakeRun::Kind kind, bool again, const std::string& scene) {
  TakenRun run;
  if (recorder_ != nullptr) run.place = recorder_->begin_run({kind, false, again, 0, scene});
  if (player_ == nullptr) return run;
  run.told = player_->take_run(kind);
  if (player_->current_scripts()) return run;
  run.fails = run.told == nullptr || !run.told->good;
  if (!run.fails) run.sources = player_->sources(*run.told);
  return run;
}

void Engine::run_was_good(const TakenRun& run, const Stage& stage, std::optional<PresetList> presets,
                          const std::string& preset_file) {
  if (recorder_ == nullptr) return;
  recorder_->run_was_good(run.place,
                          {stage.scene == nullptr ? nullptr : stage.scene->sources(), std::move(presets), preset_file});
}

Outcome Engine::ask_take(const Message& message) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  if (replays()) return outcome;
  const std::string what = plain_name(message.address);
  if (what == "/take/stop") {
    if (recorder_ == nullptr) return Outcome::refused("no take is being recorded; /take/record begins one");
    take_ends_ = true;
    outcome.answers.push_back({"/take/stopped", {}});
    return outcome;
  }
  if (recorder_ != nullptr || take_wanted_)
    return Outcome::refused("a take is being recorded already; /take/stop ends it");
  if (what == "/take/play") {
    if (!link_.ask_scenes) return Outcome::refused("a take is played in a show (limber play, without --fast)");
    outcome.kind = Outcome::Kind::scenes;
    return outcome;
  }
  if (stage_->scene == nullptr) return Outcome::refused("there is no scene that could be recorded");
  const Result<std::string> name = take_name(message, options_.scene);
  if (!name) return Outcome::refused(name.error());
  const std::string& show = stage_->scene->show_folder();
  const std::string folder = (std::filesystem::path(show) / "takes").string();
  if (!is_inside(folder, show))
    return Outcome::refused("takes/ is a link that leads out of the show's folder; put a folder in its place");
  take_wanted_ = folder + "/" + *name + ".take";
  outcome.answers.push_back({"/take/recording", {Arg::of(*name)}});
  return outcome;
}

// all that a take holds comes after the scene's start
void Engine::begin_take() {
  const std::string file = *std::exchange(take_wanted_, std::nullopt);
  (void)stage_->world.take_reset_request();
  take_name_ = take_title(file);
  edits_.clear();  // a replay does not know of them
  calls_.begin_tick();
  recorder_ = std::make_unique<TakeRecorder>(TakeWriter::Place{file, true}, take_begin(true), say_take_failed());
  if (reset()) {
    log_info("a take is recorded: {}", printable(file));
    take_tick(false, true);
  } else {
    drop_take();
    say_take_failed()("a take begins with the scene's start, and its file has an error");
  }
}

void Engine::drop_take() {
  if (recorder_ == nullptr) return;
  written_.push_back(recorder_->abandon());
  recorder_ = nullptr;
}

void Engine::end_take() {
  if (recorder_ == nullptr) return;
  written_.push_back(recorder_->finish({stage_->world.tick(), state_hash()}));
  recorder_ = nullptr;
}

void Engine::finish_saving() {
  presets_.finish_saving();
  written_.clear();
}

void Engine::tell_take() {
  TakeNode::Told told;
  if (player_ != nullptr) told = {take_name_, true, player_->ticks(), player_->whole(), plays_};
  if (recorder_ != nullptr) told = {take_name_, false, recorder_->ticks(), 0, false};
  stage_->take_node.tell(told);
}

void Engine::take_tick(bool running, bool begins) {
  const auto hash = [this] { return state_hash(); };
  if (player_ != nullptr) player_->compare(stage_->world, calls_, hash);
  if (recorder_ != nullptr && recorder_->failed()) end_take();
  if (recorder_ != nullptr) recorder_->end_tick(running, stage_->world, calls_, hash, begins);
  if (!written_.empty()) std::erase_if(written_, [](const auto& writer) { return writer->done(); });
}

Result<void> Engine::replay_beginning() {
  const TakeBegin& begin = player_->begin();
  if (!begin.reset) {
    const std::vector<TakeRun>& runs = player_->tick().runs;
    auto book = runs.empty() ? std::nullopt : player_->presets(runs.front());
    if (book) presets_.open({std::move(book->list), nullptr, book->file});
    return start_show();
  }
  presets_.open({begin.presets, nullptr, begin.preset_file});
  for (const TakeHand& step : begin.hand) {
    if (step.kind == TakeHand::Kind::message) hand_.remember(step.message);
    if (step.kind == TakeHand::Kind::given_back) hand_.give_back(step.message.address);
    if (step.kind != TakeHand::Kind::blend) continue;
    Blend blend = step.presets.size() == 1 ? Blend::of(step.presets[0]) : aligned(step.presets[0], step.presets[1]);
    if (step.presets.size() > 1) blend.amount = step.amount;
    hand_.recall(blend);
  }
  const auto set = [&](const char* row, double value) {
    (void)stage_->store.set(stage_->world.id(), World::table().at(row), {&value, 1});
  };
  set("seed", static_cast<double>(begin.world_seed));
  set("paused", begin.paused ? 1 : 0);
  set("speed", begin.speed);
  scene_seed_ = begin.scene_seed;
  return reset() ? Result<void>() : Result<void>(Error{"the scene's file has an error"});
}

void Engine::replay_runs() {
  while (const TakeRun* run = player_->run_from_outside()) replay_run(*run);
}

void Engine::replay_run(const TakeRun& run) {
  if (run.kind == TakeRun::Kind::reload) {
    run_now(run.kind, run.again);
    return;
  }
  const TakenRun taken = begin_run(run.kind, run.again, run.scene);
  if (run.kind == TakeRun::Kind::order) {
    ordered_ = reload_.order(*stage_, run.again);
  } else if (run.kind == TakeRun::Kind::take) {
    if (taken.fails || !ordered_) return;
    ordered_->options.sources = taken.sources;
    Draft draft(*std::exchange(ordered_, std::nullopt), *this);
    take(draft);
  } else {
    auto fresh = new_stage();
    SceneOptions run_options = scene_options();
    run_options.sources = taken.sources;
    if (!fresh->run_beside(run.scene, *this, run_options)) return;
    auto kept = player_->presets(run);
    Presets::Book book;
    if (kept) book = {std::move(kept->list), nullptr, kept->file};
    play_scene(run.scene, fresh, book);
  }
}

// what comes in while a take has the hands: questions are answered; as much as a tick takes
void Engine::refuse_commands() {
  for (int work = kTickWork; work > 0 && next_command_ < commands_.size(); next_command_++) {
    const Command& command = commands_[next_command_];
    for (const Message& message : command.messages) refuse_hand(message, command.origin);
    if (command.evaluate != nullptr)
      command.evaluate->answer({Evaluation::Kind::error, plays_ ? kPlays : kReplays, 0, 0, 0});
    work -= kRefusalWork * static_cast<int>(1 + command.messages.size());
  }
  asks_ = link_.image_asks.load();
}

void Engine::refuse_urgent() {
  link_.inbox.drain_urgent(urgent_);
  for (const UrgentRequest& request : urgent_) {
    overtaken_.note(request);
    // the next pass ends the take for it
    if (plays_ && request.kind == UrgentKind::panic) {
      link_.inbox.push_urgent(request);
      continue;
    }
    if (request.kind == UrgentKind::take_stop) link_.take_stops.fetch_add(1);
    refuse_hand(request.message, request.origin);
  }
}

void Engine::refuse_hand(const Message& message, const Origin& origin) {
  const std::string what = plain_name(message.address);
  Outcome outcome = Outcome::refused(plays_ ? kPlays : kReplays);
  if (plays_ && what == "/take/stop") {
    take_ends_ = true;
    outcome.kind = Outcome::Kind::answered;
    outcome.answers.push_back({"/take/stopped", {}});
  } else if (what == "/get" || what.starts_with("/list/")) {
    outcome = stage_->dispatch.execute(message);
  }
  for (Message& answer : outcome.answers) push_out({Outgoing::To::sender, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::scenes && link_.ask_scenes) return link_.ask_scenes(message, origin);
  if (outcome.kind != Outcome::Kind::answered) refuse(message.address, origin, outcome.error);
}

void Engine::replay_messages(Hands& hands) {
  refuse_urgent();
  if (next_command_ >= commands_.size()) {
    link_.inbox.drain(commands_);
    next_command_ = 0;
  }
  refuse_commands();
  answers_taken_ = true;
  hears_.reset();
  for (TakeMessage& taken : player_->messages()) {
    if (!taken.evaluate && carry_out_event(taken.message)) {
      history_.note(taken.message, taken.origin);
      continue;
    }
    hands.begin(taken.origin);
    if (taken.evaluate) {
      Evaluate wish;
      wish.text = std::move(taken.message.address);
      evaluate(wish, taken.origin);
    } else {
      execute(taken.message, taken.origin);
    }
  }
}

}  // namespace limber
