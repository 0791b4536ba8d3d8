// Simulation: options, steps, messages, events and contacts.
#include "lib/simulation.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/system/process.h"
#include "base/threads/thread_pool.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::lib {

namespace {

namespace fs = std::filesystem;

constexpr CommandOrigin kOrigin{CommandSource::command_line};

// From lib/ of a Python package in dist-packages up to /usr.
constexpr int kMaxLevels = 6;

std::string search_data() {
  std::error_code error;
  std::vector<fs::path> candidates;
  fs::path folder = system::library_path(reinterpret_cast<const void*>(&search_data));
  for (int level = 0; level < kMaxLevels && folder.has_relative_path(); level++) {
    folder = folder.parent_path();
    candidates.push_back(folder);
    candidates.push_back(folder / "share/limber");
  }
  candidates.emplace_back(install_data_dir());
  for (const fs::path& candidate : candidates) {
    if (fs::is_directory(candidate / "scripts", error) && fs::is_directory(candidate / "urdf", error))
      return candidate.string();
  }
  return {};
}

engine::EngineOptions engine_options(const limber_options& options) {
  engine::EngineOptions engine;
  engine.embedded = true;
  engine.fast = true;
  const char* const name = options.file == nullptr ? "scene.lua" : options.file;
  std::error_code error;
  engine.scene = fs::absolute(name, error).lexically_normal().string();
  if (options.text != nullptr) engine.scene_text = options.text;
  engine.scene_options.data_dir = options.data == nullptr ? data_folder() : options.data;
  if (options.seed != nullptr) engine.scene_options.seed = *options.seed;
  engine.threads = std::max(options.threads, 1);
  return engine;
}

limber_value_kind kind_of(const Arg& arg) {
  switch (arg.kind) {
    case Arg::Kind::number:
      return LIMBER_NUMBER;
    case Arg::Kind::boolean:
      return LIMBER_BOOLEAN;
    case Arg::Kind::text:
      return LIMBER_TEXT;
    case Arg::Kind::nil:
      break;
  }
  return LIMBER_NIL;
}

void copy_vector(const Vec3& from, double* to) {
  for (int i = 0; i < 3; i++) to[i] = from[i];
}

}  // namespace

const std::string& data_folder() {
  static const std::string folder = search_data();
  return folder;
}

Result<void> check_options(const limber_options& options) {
  if (options.file == nullptr && options.text == nullptr) return Error{"options: set `file` or `text`"};
  if (options.seed != nullptr && *options.seed > kMaxInteger)
    return Error{fmt::format("options: seed must be 0 to 2^53, got {}", *options.seed)};
  if (options.threads < 0 || options.threads > ThreadPool::kMaxThreads)
    return Error{fmt::format("options: threads must be 0 to {}, got {}", ThreadPool::kMaxThreads, options.threads)};
  return {};
}

void ProgramLog::add(LogLevel level, std::string_view text) {
  if (function_ == nullptr) return;
  const std::string line(text);
  switch (level) {
    case LogLevel::info:
      return function_(context_, LIMBER_LOG_INFO, line.c_str());
    case LogLevel::warning:
      return function_(context_, LIMBER_LOG_WARNING, line.c_str());
    case LogLevel::error:
      return function_(context_, LIMBER_LOG_ERROR, line.c_str());
    case LogLevel::print:
      return function_(context_, LIMBER_LOG_PRINT, line.c_str());
  }
}

Simulation::Simulation(const limber_options& options)
    : log_(options.log, options.log_context), engine_(link_, engine_options(options)), forks_(system::fork_count()) {}

bool Simulation::in_its_process() const { return forks_ == system::fork_count(); }

void Simulation::step(std::uint64_t ticks) {
  for (std::uint64_t i = 0; i < ticks; i++) {
    engine_.tick();
    collect_events();
  }
}

bool Simulation::restart(std::optional<std::uint64_t> seed) {
  const bool done = engine_.restart(seed);
  collect_events();
  return done;
}

Result<void> Simulation::send(Message message) {
  error_.clear();
  engine::Command command;
  command.messages.push_back(std::move(message));
  command.origin = kOrigin;
  const engine::Counters& counters = link_.counters;
  const std::uint64_t rejected = counters.refused.load() + counters.unknown.load();
  if (!link_.command_queue.push(std::move(command))) return Error{"the message is too large"};
  engine_.idle();
  collect_events();
  // if the message was not rejected, the text is a warning, which is also in the log
  if (counters.refused.load() + counters.unknown.load() != rejected) return Error{std::exchange(error_, {})};
  return {};
}

// Keeps the newest events. Errors of messages are returned by send(); others are in the log.
void Simulation::collect_events() {
  link_.output_queue.drain(outgoing_);
  for (engine::Outgoing& out : outgoing_) {
    if (out.destination == engine::Outgoing::Destination::error) {
      if (out.origin == kOrigin && error_.empty() && out.message.args.size() >= 2)
        error_ = fmt::format("{}: {}", out.message.args[0].text, out.message.args[1].text);
      continue;
    }
    if (events_.size() >= kMaxEvents) events_.pop_front();
    events_.push_back(std::move(out.message));
  }
  outgoing_.clear();
}

bool Simulation::next_event(limber_event& event) {
  if (events_.empty()) return false;
  event_message_ = std::move(events_.front());
  events_.pop_front();
  event_values_.clear();
  for (const Arg& arg : event_message_.args) event_values_.push_back({kind_of(arg), arg.number, arg.text.c_str()});
  event = {event_message_.address.c_str(), event_values_.data(), event_values_.size()};
  return true;
}

std::size_t Simulation::contacts(limber_contact* contacts, std::size_t capacity) {
  const Store& store = engine_.store();
  std::size_t count = 0;
  for (const sim::ContactPoint& point : engine_.world().sensing().contacts().points().list()) {
    if (!store.alive(point.a) || !store.alive(point.b)) continue;
    if (count < capacity) {
      const auto& a = *static_cast<const sim::Part*>(store.object(point.a));
      const auto& b = *static_cast<const sim::Part*>(store.object(point.b));
      limber_contact& contact = contacts[count];
      contact = {a.body().name().c_str(),
                 a.name().c_str(),
                 b.body().name().c_str(),
                 b.name().c_str(),
                 {},
                 {},
                 point.impulse,
                 {},
                 point.distance};
      copy_vector(point.position, contact.position);
      copy_vector(point.normal, contact.normal);
      copy_vector(point.friction, contact.friction);
    }
    count++;
  }
  return count;
}

}  // namespace limber::lib
