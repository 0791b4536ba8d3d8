// Sleeps until a file changes, a scene or take is requested, or the show ends.
#include "app/show/scene_loader.h"

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/paths.h"
#include "app/viewer/model_file.h"
#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"
#include "model/import.h"
#include "script/scene/script_files.h"

namespace limber::app {

namespace {

constexpr std::size_t kMaxScenes = 1000;                        // limit of the list
constexpr std::chrono::milliseconds kReloadRetryInterval{250};  // interval of retries while a take delays a reload
// address of requests to add a model; not a valid OSC address, so that only this program makes them
constexpr std::string_view kAddModel = "add model";

std::string folder_of(const std::string& scene) { return std::filesystem::path(absolute_path(scene)).parent_path(); }

}  // namespace

SceneLoader::SceneLoader(engine::EngineLink& link, engine::Engine& engine, const std::string& scene,
                         ShownModels* models, FileWatch::Mode mode)
    : link_(link),
      engine_(engine),
      models_(models),
      folder_(folder_of(scene)),
      takes_folder_(script::ScriptFiles(scene, {}).show_folder() + "/takes"),
      mode_(mode) {
  link_.on_scene_request = [this](const Message& message, const CommandOrigin& origin) {
    const bool take = message.address.starts_with("/take/");
    const std::uint64_t stops = take ? link_.take_stop_count() : link_.panics.load();
    const SceneRequest request{message, origin, stops};
    if (!requests_.push(request)) return reject(request, "too many requests for scenes at once");
    wake_.notify();
  };
  if (models_ != nullptr) models_->set_receiver([this](const std::string& path) { add_model(path); });
  link_.on_rerun = [this] {
    rerun_.store(true);
    wake_.notify();
  };
}

void SceneLoader::start() {
  // watch before the thread starts, so that no save is missed
  const auto files = std::make_shared<FileWatch>(mode_);
  files->watch(engine_.files(), FileWatch::Time::clock::now());
  thread_ = std::thread([this, files] { run(*files); });
}

void SceneLoader::stop() {
  stop_.store(true);
  wake_.notify();
  if (thread_.joinable()) thread_.join();
  if (models_ != nullptr) models_->set_receiver({});
  link_.on_rerun = nullptr;
  link_.on_scene_request = nullptr;
}

void SceneLoader::add_model(const std::string& path) {
  const SceneRequest request{
      {std::string(kAddModel), {Arg::of(std::string_view(path))}}, {CommandSource::panel, 0, 0, false}, 0};
  if (!requests_.push(request)) return log_error("{}: too many models at once", printable(path));
  wake_.notify();
}

// Returns true if the model is in the scene now.
bool SceneLoader::handle_model(const SceneRequest& request) {
  const std::string& path = request.message.args[0].text;
  const std::string file_name = printable(std::filesystem::path(path).filename().string());
  const auto fail = [&](const std::string& reason) {
    log_error("{} was not added: {}", file_name, reason);
    link_.push_out({engine::Outgoing::Destination::error, request.origin, engine::error_message(file_name, reason)});
    return false;
  };
  Result<std::string> file = find_model(path);
  if (!file) return fail(file.error());
  *file = absolute_path(*file);
  model::ImportOptions options;
  if (models_ != nullptr) options.package_paths = models_->package_paths();
  const auto model = model::import_model(*file, options);
  if (!model) return fail(model.error());
  const Result<engine::AddedModel> added = engine_.add_model(*file, **model);
  if (!added) return fail(added.error());
  if (models_ != nullptr) models_->note_added(*added);
  log_info("{} was added to the scene as the body {}", file_name, printable(added->name));
  link_.push_out({engine::Outgoing::Destination::reply,
                  request.origin,
                  {"/transport/added", {Arg::of(std::string_view(added->name))}}});
  return true;
}

// saved files have priority: requests never delay a reload
void SceneLoader::run(FileWatch& files) {
  system::name_this_thread("limber-watch");
  std::deque<SceneRequest> waiting;
  std::vector<SceneRequest> requests;
  while (!stop_.load()) {
    if (waiting.empty()) wait(files);
    std::vector<std::string> saved_files = files.poll(FileWatch::Time::clock::now());
    const bool cues_saved = reload_cues(saved_files);
    const bool saved = !saved_files.empty() || std::exchange(reload_pending_, false);
    const bool rerun = rerun_.exchange(false);
    if (saved || rerun) {
      const bool reuse_files = !saved;
      const bool reloaded = engine_.reload(reuse_files);
      reload_pending_ = saved && !reloaded;
    }
    requests_.drain(requests);
    std::ranges::move(requests, std::back_inserter(waiting));
    bool scene_changed = false;
    if (!waiting.empty() && !stop_.load()) {
      scene_changed = handle(waiting.front());
      waiting.pop_front();
    }
    if (saved || cues_saved || rerun || scene_changed) files.watch(engine_.files(), FileWatch::Time::clock::now());
  }
}

// Reads the cue file again if it was saved, and removes it from the list. Returns true if it did.
bool SceneLoader::reload_cues(std::vector<std::string>& saved) {
  if (std::erase(saved, engine_.cue_file()) == 0 && !cues_pending_) return false;
  cues_pending_ = !engine_.reload_cues();
  return true;
}

// returns the names of the folder's scenes without .lua, sorted
std::vector<std::string> SceneLoader::scenes() const {
  std::vector<std::string> names;
  std::error_code error;  // a folder that is removed meanwhile ends the list, not the show
  for (std::filesystem::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    const std::filesystem::path& file = at->path();
    if (file.extension() == ".lua" && at->is_regular_file(ignored) && names.size() < kMaxScenes)
      names.push_back(file.stem());
  }
  std::ranges::sort(names);
  return names;
}

// returns the takes of the folder, the latest first
std::vector<std::string> SceneLoader::takes() const {
  std::vector<std::pair<std::filesystem::file_time_type, std::string>> found;
  std::error_code error;  // a missing folder has none
  for (std::filesystem::directory_iterator at(takes_folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code unreadable;
    if (at->path().extension() != ".take") continue;  // no limit: the latest may be found last
    const auto when = at->last_write_time(unreadable);
    if (!unreadable) found.emplace_back(when, at->path().stem());
  }
  std::ranges::sort(found, std::greater());
  std::vector<std::string> names(found.size());
  std::ranges::transform(found, names.begin(), [](const auto& take) { return take.second; });
  return names;
}

bool SceneLoader::play_take(const SceneRequest& request) {
  const std::vector<std::string> names = takes();
  std::string name = request.message.args.empty() ? "" : request.message.args[0].text;
  if (name.ends_with(".take")) name.resize(name.size() - 5);
  if (name.empty() && !names.empty()) name = names.front();
  if (std::ranges::find(names, name) == names.end()) {
    reject(request, names.empty()
                        ? "no take in takes/ of the show's folder; record one with /take/record"
                        : fmt::format("take '{}' not found in takes/{}", printable(name), name_hint(name, names)));
    return false;
  }
  const Result<void> played = engine_.play_take(takes_folder_ + "/" + name + ".take", request.stops_before);
  if (!played) {
    reject(request, played.error());
    return false;
  }
  link_.push_out({engine::Outgoing::Destination::reply, request.origin, {"/take/playing", {Arg::of(name)}}});
  return true;
}

// returns true if the files of the scene are others now
bool SceneLoader::handle(const SceneRequest& request) {
  const std::vector<Arg>& args = request.message.args;
  if (request.message.address == kAddModel) return handle_model(request);
  if (request.message.address.starts_with("/take/")) return play_take(request);
  if (normalized_name(request.message.address).starts_with("/cue/")) {
    if (const Result<void> edited = engine_.edit_cues(request.message); !edited) reject(request, edited.error());
    return true;
  }
  const std::vector<std::string> names = scenes();
  if (args.empty()) {
    Message reply{"/list/scenes", {}};
    for (const std::string& name : names) reply.args.push_back(Arg::of(name));
    if (names.empty()) reply.args.push_back(Arg::of(""));
    link_.push_out({engine::Outgoing::Destination::reply, request.origin, std::move(reply)});
    return false;
  }
  std::string name = args[0].text;
  if (name.ends_with(".lua")) name.resize(name.size() - 4);
  if (std::ranges::find(names, name) == names.end()) {
    reject(request, fmt::format("scene '{}' not found in {}/{}", printable(name),
                                std::filesystem::path(folder_).filename().string(), name_hint(name, names)));
    return false;
  }
  const std::string file = (std::filesystem::path(folder_) / (name + ".lua")).string();
  const Result<void> changed = engine_.change_scene(file, request.stops_before);
  if (changed.ok()) {
    on_scene_(file);
    log_info("{} plays from its start", name);
    link_.push_out({engine::Outgoing::Destination::reply, request.origin, {"/transport/playing", {Arg::of(name)}}});
  } else {
    reject(request, changed.error());
  }
  return changed.ok();
}

void SceneLoader::reject(const SceneRequest& request, const std::string& reason) {
  link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  link_.push_out(
      {engine::Outgoing::Destination::error, request.origin, engine::error_message(request.message.address, reason)});
}

void SceneLoader::wait(const FileWatch& files) {
  std::optional<std::chrono::nanoseconds> limit;
  const bool pending = reload_pending_ || cues_pending_;
  if (pending) limit = kReloadRetryInterval;
  if (const auto due = files.next_poll()) {
    const auto now = FileWatch::Time::clock::now();
    limit = std::min<std::chrono::nanoseconds>(std::max(*due, now) - now,
                                               pending ? kReloadRetryInterval : std::chrono::minutes(1));
  }
  std::array<system::PollEntry, 2> poll_entries{{{.fd = wake_.fd()}, {.fd = files.fd()}}};
  (void)system::wait_ready(poll_entries, limit);
  wake_.clear();
}

}  // namespace limber::app
