// Sleeps until a file, a parameter or the end calls.
#include "app/scene_watch.h"

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"
#include "script/files.h"

namespace limber {

namespace {

constexpr std::size_t kMostScenes = 1000;        // that are listed
constexpr std::chrono::milliseconds kLate{250};  // how often a reload that a take holds up is tried again

std::string folder_of(const std::string& scene) {
  std::error_code fault;
  const std::filesystem::path whole = std::filesystem::absolute(scene, fault);
  return (fault ? std::filesystem::path(scene) : whole).parent_path();
}

}  // namespace

SceneWatch::SceneWatch(EngineLink& link, Engine& engine, const std::string& scene, FileWatch::Way way)
    : link_(link),
      engine_(engine),
      folder_(folder_of(scene)),
      takes_(ScriptFiles(scene, {}).show_folder() + "/takes"),
      way_(way) {
  link_.ask_scenes = [this](const Message& message, const Origin& origin) {
    const bool take = message.address.starts_with("/take/");
    const std::uint64_t stops = take ? Engine::stops_of_takes(link_) : link_.panics.load();
    if (!wishes_.push({{message}, origin, nullptr, stops}))
      return refuse(message, origin, "too many questions about scenes at once");
    wake_.notify();
  };
  link_.rerun_scene = [this] {
    rerun_.store(true);
    wake_.notify();
  };
}

void SceneWatch::start() {
  // from here on a save is seen, whenever the thread begins
  const auto files = std::make_shared<FileWatch>(way_);
  files->watch(engine_.files(), FileWatch::Time::clock::now());
  thread_ = std::thread([this, files] { run(*files); });
}

void SceneWatch::stop() {
  stop_.store(true);
  wake_.notify();
  if (thread_.joinable()) thread_.join();
  link_.rerun_scene = nullptr;
  link_.ask_scenes = nullptr;
}

// a saved file comes first: questions about scenes never hold it up
void SceneWatch::run(FileWatch& files) {
  system::name_this_thread("limber-watch");
  std::deque<Command> waiting;
  std::vector<Command> wishes;
  while (!stop_.load()) {
    if (waiting.empty()) sleep(files);
    const bool saved = !files.poll(FileWatch::Time::clock::now()).empty() || std::exchange(late_, false);
    const bool rerun = rerun_.exchange(false);
    if (saved || rerun) late_ = !engine_.reload(!saved) && saved;
    wishes_.drain(wishes);
    std::ranges::move(wishes, std::back_inserter(waiting));
    bool other = false;
    if (!waiting.empty() && !stop_.load()) {
      other = serve(waiting.front());
      waiting.pop_front();
    }
    if (saved || rerun || other) files.watch(engine_.files(), FileWatch::Time::clock::now());
  }
}

// names of the folder's scenes, without .lua, in the order of the alphabet
std::vector<std::string> SceneWatch::scenes() const {
  std::vector<std::string> names;
  std::error_code fault;  // a folder that goes meanwhile ends the list, not the show
  for (std::filesystem::directory_iterator at(folder_, fault), end; !fault && at != end; at.increment(fault)) {
    std::error_code ignored;
    const std::filesystem::path& file = at->path();
    if (file.extension() == ".lua" && at->is_regular_file(ignored) && names.size() < kMostScenes)
      names.push_back(file.stem());
  }
  std::ranges::sort(names);
  return names;
}

// the takes of the folder, the newest one first
std::vector<std::string> SceneWatch::takes() const {
  std::vector<std::pair<std::filesystem::file_time_type, std::string>> found;
  std::error_code fault;  // a folder that is not there holds none
  for (std::filesystem::directory_iterator at(takes_, fault), end; !fault && at != end; at.increment(fault)) {
    std::error_code gone;
    if (at->path().extension() != ".take") continue;  // all of them: the newest may be the last that is found
    const auto when = at->last_write_time(gone);
    if (!gone) found.emplace_back(when, at->path().stem());
  }
  std::ranges::sort(found, std::greater());
  std::vector<std::string> names(found.size());
  std::ranges::transform(found, names.begin(), [](const auto& take) { return take.second; });
  return names;
}

bool SceneWatch::play_take(const Command& command) {
  const Message& wish = command.messages.front();
  const Origin& origin = command.origin;
  const std::vector<std::string> names = takes();
  std::string name = wish.args.empty() ? "" : wish.args[0].text;
  if (name.ends_with(".take")) name.resize(name.size() - 5);
  if (name.empty() && !names.empty()) name = names.front();
  if (std::ranges::find(names, name) == names.end()) {
    refuse(wish, origin,
           names.empty() ? "there is no take in takes/ of the show's folder; /take/record makes one"
                         : fmt::format("there is no take '{}' in takes/{}", printable(name), name_hint(name, names)));
    return false;
  }
  const Result<void> played = engine_.play_take(takes_ + "/" + name + ".take", command.arrival);
  if (!played) {
    refuse(wish, origin, played.error());
    return false;
  }
  link_.push_out({Outgoing::To::sender, origin, {"/take/playing", {Arg::of(name)}}});
  return true;
}

// whether another scene plays now
bool SceneWatch::serve(const Command& command) {
  const Message& wish = command.messages.front();
  const Origin& origin = command.origin;
  if (wish.address.starts_with("/take/")) return play_take(command);
  const std::vector<std::string> names = scenes();
  if (wish.args.empty()) {
    Message answer{"/list/scenes", {}};
    for (const std::string& name : names) answer.args.push_back(Arg::of(name));
    if (names.empty()) answer.args.push_back(Arg::of(""));
    link_.push_out({Outgoing::To::sender, origin, std::move(answer)});
    return false;
  }
  std::string name = wish.args[0].text;
  if (name.ends_with(".lua")) name.resize(name.size() - 4);
  if (std::ranges::find(names, name) == names.end()) {
    refuse(wish, origin,
           fmt::format("there is no scene '{}' in {}/{}", printable(name),
                       std::filesystem::path(folder_).filename().string(), name_hint(name, names)));
    return false;
  }
  const Result<void> changed =
      engine_.change_scene((std::filesystem::path(folder_) / (name + ".lua")).string(), command.arrival);
  if (changed.ok()) {
    log_info("{} plays from its start", name);
    link_.push_out({Outgoing::To::sender, origin, {"/transport/playing", {Arg::of(name)}}});
  } else {
    refuse(wish, origin, changed.error());
  }
  return changed.ok();
}

void SceneWatch::refuse(const Message& wish, const Origin& origin, const std::string& why) {
  link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  link_.push_out({Outgoing::To::error, origin, error_message(wish.address, why)});
}

void SceneWatch::sleep(const FileWatch& files) {
  std::optional<std::chrono::nanoseconds> limit;
  if (late_) limit = kLate;
  if (const auto due = files.due()) {
    const auto now = FileWatch::Time::clock::now();
    limit = std::min<std::chrono::nanoseconds>(std::max(*due, now) - now, late_ ? kLate : std::chrono::minutes(1));
  }
  std::array<system::Waiting, 2> calls{{{.fd = wake_.fd()}, {.fd = files.fd()}}};
  (void)system::wait_ready(calls, limit);
  wake_.clear();
}

}  // namespace limber
