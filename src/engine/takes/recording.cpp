// TakeRecording: requests, begin and end of a recording.
#include "engine/takes/recording.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "script/scene/script_files.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxName = 100;

// Returns the name of a new take from the message, or one made of scene and time. A name from a message must not lead
// into another folder.
Result<std::string> requested_take_name(const Message& message, const std::string& scene) {
  if (!message.args.empty() && !message.args[0].text.empty()) {
    std::string name = message.args[0].text;
    if (name.ends_with(".take")) name.resize(name.size() - 5);
    const bool plain = !name.empty() && name.size() <= kMaxName && name.front() != '.' &&
                       name.find_first_of("/\\") == name.npos &&
                       std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (!plain)
      return Error{fmt::format(
          "'{}' is not a valid name of a take; use a name without / that does not begin with a dot", printable(name))};
    return name;
  }
  // the time is only used for the file name: the simulation never reads it
  const std::time_t now = std::time(nullptr);
  std::tm local_time{};
  localtime_r(&now, &local_time);
  char text[32] = {};
  (void)std::strftime(text, sizeof text, "%Y-%m-%d-%H%M%S", &local_time);
  return fmt::format("{}-{}", std::filesystem::path(scene).stem().string(), text);
}

TakeOverride take_override_of(const Override& override_entry) {
  TakeOverride entry;
  if (override_entry.message != nullptr) entry.message = *override_entry.message;
  if (override_entry.address != nullptr) {
    entry.kind = TakeOverride::Kind::released;
    entry.message.address = *override_entry.address;
  }
  if (override_entry.blend == nullptr) return entry;
  entry.kind = TakeOverride::Kind::blend;
  entry.presets = {override_entry.blend->a};
  if (override_entry.blend->amount > 0) entry.presets.push_back(override_entry.blend->b);
  entry.amount = override_entry.blend->amount;
  return entry;
}

}  // namespace

TakeInitialState capture_initial_state(const ShowState& show, bool reset) {
  TakeInitialState state;
  state.reset = reset;
  state.scene = show.options.scene;
  state.seed = show.options.scene_options.seed;
  state.package_paths = show.options.scene_options.package_paths;
  state.preset = show.options.preset;
  state.sets = show.options.sets;
  if (show.recovered != nullptr && !reset) state.recovered = {show.recovered};
  if (!reset) return state;
  state.world_seed = show.session->world.seed();
  state.scene_seed = show.scene_seed;
  state.paused = show.session->world_value("paused") != 0;
  state.speed = show.session->world_value("speed");
  state.preset_file = show.presets.file();
  state.presets = show.presets.list();
  for (const Override& entry : show.overrides.in_order()) state.overrides.push_back(take_override_of(entry));
  return state;
}

void apply_initial_state(ShowState& show, const TakeInitialState& state) {
  show.presets.open({state.presets, nullptr, state.preset_file});
  for (const TakeOverride& entry : state.overrides) {
    if (entry.kind == TakeOverride::Kind::message) show.overrides.add(entry.message);
    if (entry.kind == TakeOverride::Kind::released) show.overrides.release(entry.message.address);
    if (entry.kind != TakeOverride::Kind::blend) continue;
    Blend blend = entry.presets.size() == 1 ? Blend::of(entry.presets[0]) : align(entry.presets[0], entry.presets[1]);
    if (entry.presets.size() > 1) blend.amount = entry.amount;
    show.overrides.add_recall(blend);
  }
  const auto set = [&](const char* property, double value) {
    (void)show.session->store.set(show.session->world.id(), sim::World::table().at(property), {&value, 1});
  };
  set("seed", static_cast<double>(state.world_seed));
  set("paused", state.paused ? 1 : 0);
  set("speed", state.speed);
  show.scene_seed = state.scene_seed;
}

std::function<void(const std::string&)> TakeRecording::failure_reporter() {
  return [&link = show_.link](const std::string& why) {
    log_error("{}", why);
    link.push_out({Outgoing::Destination::error, {}, error_message("/take/record", why)});
  };
}

Outcome TakeRecording::request(const Message& message) {
  Outcome outcome = Outcome::answered();
  const std::string address = normalized_name(message.address);
  if (show_.options.embedded)
    return Outcome::rejected("takes can't be recorded or played in a program that uses liblimber; use limber play");
  if (address == "/take/stop") {
    if (recorder_ == nullptr) return Outcome::rejected("no take is being recorded; /take/record starts one");
    end_requested_ = true;
    outcome.answers.push_back({"/take/stopped", {}});
    return outcome;
  }
  if (active()) return Outcome::rejected("a take is being recorded already; /take/stop ends it");
  if (address == "/take/play") {
    if (!show_.link.on_scene_request)
      return Outcome::rejected("takes can be played only in limber play, without --fast");
    outcome.kind = Outcome::Kind::scene_request;
    return outcome;
  }
  if (show_.session->scene == nullptr) return Outcome::rejected("there is no scene to record");
  const Result<std::string> name = requested_take_name(message, show_.options.scene);
  if (!name) return Outcome::rejected(name.error());
  const std::string& show_folder = show_.session->scene->show_folder();
  const std::string folder = (std::filesystem::path(show_folder) / "takes").string();
  if (!script::is_inside(folder, show_folder))
    return Outcome::rejected("takes/ is a link that leads out of the show's folder; put a folder in its place");
  requested_file_ = folder + "/" + *name + ".take";
  outcome.answers.push_back({"/take/recording", {Arg::of(*name)}});
  return outcome;
}

Result<void> TakeRecording::start() {
  show_.call_log.begin_pass();
  const std::string& file = show_.options.record;
  recorder_ = std::make_unique<TakeRecorder>(show_.writer, TakeWriter::Target{file, false},
                                             capture_initial_state(show_, false), failure_reporter());
  Result<void> opened = recorder_->wait_until_open();
  if (!opened) recorder_ = nullptr;
  name_ = title_of_take(file);
  return opened;
}

std::string TakeRecording::begin_requested() {
  std::string file = *std::exchange(requested_file_, std::nullopt);
  name_ = title_of_take(file);
  recorder_ = std::make_unique<TakeRecorder>(show_.writer, TakeWriter::Target{file, true},
                                             capture_initial_state(show_, true), failure_reporter());
  return file;
}

void TakeRecording::end() {
  if (recorder_ == nullptr) return;
  ended_.push_back(recorder_->finish({show_.session->world.tick(), show_.state_hash()}));
  recorder_ = nullptr;
}

void TakeRecording::abandon() {
  if (recorder_ == nullptr) return;
  ended_.push_back(recorder_->abandon());
  recorder_ = nullptr;
}

void TakeRecording::record(const Message& message, const CommandOrigin& origin, bool evaluate) {
  if (recorder_ != nullptr) recorder_->record_message(message, origin, evaluate);
}

void TakeRecording::run_succeeded(std::size_t run, const Session& session, std::optional<PresetList> presets,
                                  const std::string& preset_file) {
  if (recorder_ == nullptr) return;
  recorder_->run_succeeded(
      run, {session.scene == nullptr ? nullptr : session.scene->sources(), std::move(presets), preset_file});
}

void TakeRecording::end_pass(bool running, bool begins) {
  if (recorder_ != nullptr && recorder_->failed()) end();
  if (recorder_ != nullptr)
    recorder_->end_tick(
        running, show_.session->world, show_.call_log, [this] { return show_.state_hash(); }, begins);
  if (!ended_.empty()) std::erase_if(ended_, [](const auto& writer) { return writer->done(); });
}

void TakeRecording::end_if_requested() {
  if (std::exchange(end_requested_, false)) end();
}

std::optional<TakeNode::Status> TakeRecording::status() const {
  if (recorder_ == nullptr) return std::nullopt;
  return TakeNode::Status{name_, false, recorder_->ticks(), 0, false};
}

}  // namespace limber::engine
